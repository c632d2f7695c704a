#include "core/logs/camera_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>

#include "test/recordings.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

constexpr const char* kPinhole = R"({"model": "PINHOLE", "width_px": 640, "height_px": 480,
    "fx_px": 500.5, "fy_px": 501, "cx_px": 320, "cy_px": 240, "coefficients": []})";

// The text with one piece of it replaced.
std::string With(const std::string& old_piece, const std::string& new_piece) {
  std::string text = kPinhole;
  return text.replace(text.find(old_piece), old_piece.size(), new_piece);
}

std::string ErrorOf(const std::string& text) {
  const Result<CameraFile> file = ParseCameraFile("rig/camera.json", text);
  return file.ok() ? "" : file.error().message;
}

CameraFile Brown() {
  CameraFile file;
  file.lens = {LensModel::kBrown, 4000, 3000, 3000.1, 1.0 / 3.0 + 3000.0, 2000.7, 1499.9, {}};
  file.lens.coefficients = {-0.1, 0.02, 1e-3 / 3.0, -2e-4, 0.005};
  return file;
}

void ExpectSame(const CameraFile& a, const CameraFile& b) {
  EXPECT_EQ(a.lens.model, b.lens.model);
  EXPECT_EQ(a.lens.width_px, b.lens.width_px);
  EXPECT_EQ(a.lens.height_px, b.lens.height_px);
  EXPECT_EQ(a.lens.fx_px, b.lens.fx_px);
  EXPECT_EQ(a.lens.fy_px, b.lens.fy_px);
  EXPECT_EQ(a.lens.cx_px, b.lens.cx_px);
  EXPECT_EQ(a.lens.cy_px, b.lens.cy_px);
  EXPECT_EQ(a.lens.coefficients, b.lens.coefficients);
  EXPECT_EQ(a.rms_px, b.rms_px);
  ASSERT_EQ(a.covariance.has_value(), b.covariance.has_value());
  if (a.covariance) {
    EXPECT_EQ(*a.covariance, *b.covariance);
  }
}

TEST(CameraFile, ReadsTheDocumentedForm) {
  const Result<CameraFile> file = ParseCameraFile("camera.json", kPinhole);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->lens.model, LensModel::kPinhole);
  EXPECT_EQ(file->lens.width_px, 640);
  EXPECT_EQ(file->lens.height_px, 480);
  EXPECT_EQ(file->lens.fx_px, 500.5);
  EXPECT_EQ(file->lens.fy_px, 501.0);
  EXPECT_EQ(file->lens.cx_px, 320.0);
  EXPECT_EQ(file->lens.cy_px, 240.0);
  EXPECT_FALSE(file->covariance.has_value());
  EXPECT_FALSE(file->rms_px.has_value());
}

TEST(CameraFile, TakesOpenCvsShortLists) {
  for (const int count : {0, 4, 5, 8, 12, 14}) {
    std::string list;
    for (int i = 0; i < count; ++i) list += (i == 0 ? "0.00" : ", 0.00") + std::to_string(i + 1);
    std::string text = With("[]", "[" + list + "]");
    text.replace(text.find("PINHOLE"), 7, "OPENCV");
    const Result<CameraFile> file = ParseCameraFile("camera.json", text);
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->lens.model, LensModel::kBrown);
    for (int i = 0; i < kMostLensCoefficients; ++i) {
      EXPECT_EQ(file->lens.coefficients[static_cast<std::size_t>(i)] != 0.0, i < count);
    }
  }
}

TEST(CameraFile, ReadsBackToTheSameBits) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    CameraFile file = Brown();
    file.lens.model = static_cast<LensModel>(trial % 4);
    file.lens.fx_px = 3000.0 + uniform(random);
    file.lens.coefficients = {};
    const int count = CoefficientCount(file.lens.model);
    for (int i = 0; i < count && i < 1 + trial % 14; ++i) {
      file.lens.coefficients[static_cast<std::size_t>(i)] = 1e-3 * uniform(random);
    }
    if (trial % 2 == 0) file.rms_px = std::abs(uniform(random));
    if (trial % 3 == 0) {
      const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(
          4 + count, 4 + count, [&](Eigen::Index, Eigen::Index) { return uniform(random); });
      file.covariance = root * root.transpose();
    }
    const Result<std::string> text = FormatCameraFile(file);
    ASSERT_TRUE(text.ok()) << text.error().message;
    const Result<CameraFile> again = ParseCameraFile("camera.json", *text);
    ASSERT_TRUE(again.ok()) << again.error().message;
    ExpectSame(file, *again);
    EXPECT_THAT(again->convention, HasSubstr("pixel centres at integer coordinates"));
  }
}

TEST(CameraFile, LeavesOutWhatWasHeldFixed) {
  CameraFile file = Brown();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(18, 18);
  covariance.topLeftCorner(9, 9).setIdentity();
  file.covariance = covariance;
  const Result<std::string> text = FormatCameraFile(file);
  ASSERT_TRUE(text.ok());
  const Result<CameraFile> again = ParseCameraFile("camera.json", *text);
  ASSERT_TRUE(again.ok()) << again.error().message;
  ExpectSame(file, *again);
  EXPECT_LT(text->size(), 2500U);
}

TEST(CameraFile, NamesTheFileAndTheMemberThatIsWrong) {
  EXPECT_EQ(ErrorOf(kPinhole), "");
  EXPECT_THAT(ErrorOf("[]"), HasSubstr("rig/camera.json: is not a JSON object"));
  EXPECT_THAT(ErrorOf(With("PINHOLE", "PINHALL")), HasSubstr("camera.json: model 'PINHALL'"));
  EXPECT_THAT(ErrorOf(With("\"model\"", "\"modal\"")), HasSubstr("model is missing"));
  EXPECT_THAT(ErrorOf(With("640", "640.5")), HasSubstr("width_px"));
  EXPECT_THAT(ErrorOf(With("640", "18446744073709551615")), HasSubstr("width_px"));
  EXPECT_THAT(ErrorOf(With("480", "-480")), HasSubstr("height_px"));
  EXPECT_THAT(ErrorOf(With("500.5", "\"500.5\"")), HasSubstr("fx_px"));
  EXPECT_THAT(ErrorOf(With("500.5", "0")), HasSubstr("focal length"));
  EXPECT_THAT(ErrorOf(With("500.5", "1e999")), HasSubstr("rig/camera.json: "));
  EXPECT_THAT(ErrorOf(With("501", "null")), HasSubstr("fy_px"));
  EXPECT_THAT(ErrorOf(With("[]", "[0.1]")), HasSubstr("coefficients are 1"));
  EXPECT_THAT(ErrorOf(With("PINHOLE", "OPENCV_FISHEYE")), HasSubstr("coefficients are 0"));
  EXPECT_THAT(ErrorOf(With("[]", "[], \"rms_px\": -1")), HasSubstr("rms_px"));
  EXPECT_THAT(ErrorOf(With("[]", "[], \"convention\": 7")), HasSubstr("convention"));
  const std::string key = "[], \"intrinsics_covariance\": ";
  EXPECT_THAT(ErrorOf(With("[]", key + "[[1]]")), HasSubstr("intrinsics_covariance is not 4 rows"));
  EXPECT_THAT(ErrorOf(With("[]", key + "[[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              HasSubstr("intrinsics_covariance is no covariance"));
  EXPECT_THAT(ErrorOf(With("[]", key + "[[1,2,0,0],[2,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              HasSubstr("intrinsics_covariance is no covariance"));
  EXPECT_THAT(ErrorOf(With("[]", key + "[[1,0.1,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              HasSubstr("intrinsics_covariance is no covariance"));
  EXPECT_THAT(ErrorOf(std::string(100'000, '[')), HasSubstr("nested too deeply"));
  EXPECT_THAT(ErrorOf(std::string(2'000'000, ' ')), HasSubstr("too long"));
}

TEST(CameraFile, DoesNotWriteWhatItWouldNotRead) {
  CameraFile file = Brown();
  file.lens.fx_px = 0.0;
  EXPECT_FALSE(FormatCameraFile(file).ok());
  file = Brown();
  file.rms_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(FormatCameraFile(file).ok());
  file = Brown();
  file.covariance = Eigen::MatrixXd::Identity(4, 4);
  EXPECT_FALSE(FormatCameraFile(file).ok());
  file = Brown();
  file.convention = "no \xff UTF-8";
  const Result<std::string> text = FormatCameraFile(file);
  ASSERT_TRUE(text.ok());
  EXPECT_TRUE(ParseCameraFile("camera.json", *text).ok());
}

TEST(CameraFile, SaysWhenThereIsNone) {
  const Result<CameraFile> file = ReadCameraFile("/nowhere/camera.json");
  ASSERT_FALSE(file.ok());
  EXPECT_THAT(file.error().message, HasSubstr("/nowhere/camera.json"));
}

TEST(CameraFileRecorded, ReadsEveryCameraOfTheRecordings) {
  LODEMARK_NEEDS_RECORDING("vision");
  for (const char* name : {"board_opencv_stereo", "kitti00_20111003", "strecha_castle_p19",
                           "strecha_fountain_p11", "uzh_board_corners", "uzh_board_handheld"}) {
    const Result<CameraFile> file =
        ReadCameraFile(test::RecordingPath(std::string("vision/") + name + "/camera.json"));
    EXPECT_TRUE(file.ok()) << file.error().message;
  }
}

}  // namespace
}  // namespace lodemark
