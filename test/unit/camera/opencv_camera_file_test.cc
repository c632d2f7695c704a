#include "core/camera/opencv_camera_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "test/recordings.h"
#include "test/unit/camera/lenses.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

constexpr const char* kStereo = R"(%YAML:1.0
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 501., 240., 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.25, 0.05, 1e-3, 2e-3, 0. ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 600., 0., 320., 0., 601., 240., 0., 0., 1. ]
)";

// A file of one camera with these lines for its matrix and the rest.
std::string File(const std::string& matrix, const std::string& rest) {
  return "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n"
         "   rows: 3\n   cols: 3\n   dt: d\n   data: [ " +
         matrix + " ]\n" + rest;
}

constexpr const char* kMatrix = "500., 0., 320., 0., 501., 240., 0., 0., 1.";

std::string Distortion(const std::string& name, const std::string& values) {
  return name + ": !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ " + values +
         " ]\n";
}

std::string ErrorOf(const std::string& text) {
  const Result<LensParameters> lens = ParseOpenCvCameraFile("a/b.yml", text);
  return lens.ok() ? "" : lens.error().message;
}

TEST(OpenCvCameraFile, ReadsBackToTheSameBits) {
  for (const OpenCvFileForm form : {OpenCvFileForm::kYaml, OpenCvFileForm::kXml}) {
    for (auto [name, lens] : test::ManyLenses()) {
      lens.fx_px += 1.0 / 3.0;
      const Result<std::string> text = FormatOpenCvCameraFile(lens, form);
      if (lens.model == LensModel::kThinPrismFisheye) {
        ASSERT_FALSE(text.ok());
        EXPECT_EQ(text.error().code, ErrorCode::kUnsupported);
        continue;
      }
      ASSERT_TRUE(text.ok()) << text.error().message;
      const Result<LensParameters> again = ParseOpenCvCameraFile("camera.yml", *text);
      ASSERT_TRUE(again.ok()) << name << ": " << again.error().message;
      EXPECT_EQ(again->model, lens.model) << name;
      EXPECT_EQ(again->width_px, lens.width_px);
      EXPECT_EQ(again->height_px, lens.height_px);
      EXPECT_EQ(again->fx_px, lens.fx_px) << name;
      EXPECT_EQ(again->fy_px, lens.fy_px) << name;
      EXPECT_EQ(again->cx_px, lens.cx_px) << name;
      EXPECT_EQ(again->cy_px, lens.cy_px) << name;
      EXPECT_EQ(again->coefficients, lens.coefficients) << name;
    }
  }
}

// What is written means to OpenCV what it means here.
TEST(OpenCvCameraFile, IsReadByOpenCv) {
  const LensParameters lens = test::ManyLenses()[9].parameters;
  for (const OpenCvFileForm form : {OpenCvFileForm::kYaml, OpenCvFileForm::kXml}) {
    const cv::FileStorage storage(*FormatOpenCvCameraFile(lens, form),
                                  cv::FileStorage::READ | cv::FileStorage::MEMORY);
    cv::Mat matrix;
    cv::Mat coefficients;
    storage["camera_matrix"] >> matrix;
    storage["distortion_coefficients"] >> coefficients;
    EXPECT_EQ(static_cast<int>(storage["image_width"]), lens.width_px);
    EXPECT_EQ(matrix.at<double>(1, 2), lens.cy_px);
    ASSERT_EQ(coefficients.total(), 14U);
    EXPECT_EQ(coefficients.at<double>(13), lens.coefficients[13]);
  }
}

TEST(OpenCvCameraFile, KnowsTheSpellings) {
  for (const char* name : {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs"}) {
    const std::string text = File(kMatrix, Distortion(name, "-0.25, 0.05, 1e-3, 2e-3, 0.1"));
    const Result<LensParameters> lens = ParseOpenCvCameraFile("a.yml", text);
    ASSERT_TRUE(lens.ok()) << lens.error().message;
    EXPECT_EQ(lens->model, LensModel::kBrown);
    EXPECT_EQ(lens->fy_px, 501.0);
    EXPECT_EQ(lens->cx_px, 320.0);
    EXPECT_EQ(lens->coefficients[4], 0.1);
  }
  std::string text = File(kMatrix, "");
  text.replace(text.find("camera_matrix"), 13, "Camera_Matrix");
  EXPECT_EQ(ParseOpenCvCameraFile("a.yml", text)->model, LensModel::kPinhole);
}

TEST(OpenCvCameraFile, ReadsEitherCameraOfAStereoPair) {
  OpenCvCameraChoice choice;
  choice.width_px = 640;
  choice.height_px = 480;
  const Result<LensParameters> left = ParseOpenCvCameraFile("s.yml", kStereo, choice);
  ASSERT_TRUE(left.ok()) << left.error().message;
  EXPECT_EQ(left->fx_px, 500.0);
  EXPECT_EQ(left->coefficients[0], -0.25);
  choice.camera = 2;
  const Result<LensParameters> right = ParseOpenCvCameraFile("s.yml", kStereo, choice);
  ASSERT_TRUE(right.ok()) << right.error().message;
  EXPECT_EQ(right->fx_px, 600.0);
  EXPECT_EQ(right->model, LensModel::kPinhole);
  EXPECT_THAT(ErrorOf(kStereo), HasSubstr("a/b.yml: image_width is missing"));
}

TEST(OpenCvCameraFile, NamesTheFileAndTheFieldThatIsWrong) {
  EXPECT_EQ(ErrorOf(File(kMatrix, "")), "");
  EXPECT_THAT(ErrorOf(""), HasSubstr("a/b.yml: is no OpenCV storage"));
  EXPECT_THAT(ErrorOf("<?xml version="), HasSubstr("is no OpenCV storage"));
  EXPECT_THAT(ErrorOf("<?xml version=\"1.0\"?><other></other>"), HasSubstr("is no OpenCV storage"));
  EXPECT_THAT(ErrorOf("%YAML:1.0\n"), HasSubstr("a/b.yml: "));
  EXPECT_THAT(ErrorOf("%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"),
              HasSubstr("camera_matrix is missing"));
  EXPECT_THAT(ErrorOf(File("1, 2, 3", "")), HasSubstr("camera_matrix is no 3 x 3"));
  EXPECT_THAT(ErrorOf(File("500., 1., 320., 0., 501., 240., 0., 0., 1.", "")),
              HasSubstr("camera_matrix is skewed"));
  EXPECT_THAT(ErrorOf(File("-500., 0., 320., 0., 501., 240., 0., 0., 1.", "")),
              HasSubstr("focal lengths"));
  EXPECT_THAT(ErrorOf(File(kMatrix, Distortion("distCoeffs", "0.1, 0.2"))),
              HasSubstr("distCoeffs has 2 coefficients"));
  EXPECT_THAT(ErrorOf(File(kMatrix, Distortion("distCoeffs", "0.1, 0.2, 0, x"))),
              HasSubstr("distCoeffs is no list"));
  EXPECT_THAT(ErrorOf(File(kMatrix, Distortion("distCoeffs", "0.1, 0.2, 0, .NaN"))),
              HasSubstr("distCoeffs is no list"));
  EXPECT_THAT(
      ErrorOf(File(kMatrix, "fisheye_model: 1\n" + Distortion("distCoeffs", "0, 0, 0, 0, 0"))),
      HasSubstr("distCoeffs has 5 coefficients"));
}

TEST(OpenCvCameraFile, SurvivesEveryCutAndEveryChangedByte) {
  const std::string whole[] = {
      *FormatOpenCvCameraFile(test::ManyLenses()[1].parameters, OpenCvFileForm::kYaml),
      *FormatOpenCvCameraFile(test::ManyLenses()[11].parameters, OpenCvFileForm::kXml)};
  for (const std::string& text : whole) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      std::string broken = text.substr(0, i);
      const Result<LensParameters> cut = ParseOpenCvCameraFile("a.yml", broken);
      EXPECT_TRUE(cut.ok() || cut.error().message.starts_with("a.yml: "));
      for (const char byte : {'\0', '<', '9', '[', '-', '\xff', '\n'}) {
        broken = text;
        broken[i] = byte;
        const Result<LensParameters> lens = ParseOpenCvCameraFile("a.yml", broken);
        EXPECT_TRUE(lens.ok() || lens.error().message.starts_with("a.yml: "));
      }
    }
  }
}

TEST(OpenCvCameraFile, DoesNotBelieveTheSizeOfAMatrix) {
  std::string text = File(kMatrix, "");
  text.replace(text.find("rows: 3"), 7, "rows: 300000000");
  EXPECT_EQ(ErrorOf(text), "");
}

TEST(OpenCvCameraFileRecorded, ReadsThoseOfTheBoards) {
  LODEMARK_NEEDS_RECORDING("vision/board_opencv_stereo");
  LODEMARK_NEEDS_RECORDING("vision/board_fisheye_20160627");
  const std::string stereo = test::RecordingPath("vision/board_opencv_stereo/");
  const Result<LensParameters> left = ReadOpenCvCameraFile(stereo + "left_intrinsics.yml");
  ASSERT_TRUE(left.ok()) << left.error().message;
  EXPECT_EQ(left->model, LensModel::kBrown);
  EXPECT_NEAR(left->fx_px, 535.9157, 1e-4);
  EXPECT_NEAR(left->coefficients[4], 0.23839, 1e-5);
  OpenCvCameraChoice second;
  second.camera = 2;
  second.width_px = 640;
  second.height_px = 480;
  const Result<LensParameters> right = ReadOpenCvCameraFile(stereo + "intrinsics.yml", second);
  ASSERT_TRUE(right.ok()) << right.error().message;
  EXPECT_NEAR(right->cx_px, 334.5574, 1e-4);
  EXPECT_FALSE(ReadOpenCvCameraFile(stereo + "stereo_calib.xml").ok());
  const Result<LensParameters> fisheye = ReadOpenCvCameraFile(
      test::RecordingPath("vision/board_fisheye_20160627/out_camera_fisheye_data.xml"));
  ASSERT_TRUE(fisheye.ok()) << fisheye.error().message;
  EXPECT_EQ(fisheye->model, LensModel::kFisheye);
  EXPECT_NEAR(fisheye->fx_px, 318.3099, 1e-4);
}

}  // namespace
}  // namespace lodemark
