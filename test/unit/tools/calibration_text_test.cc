// The files of 'lodemark calibrate' read back.
#include "tools/lodemark/calibration_text.h"

#include <gtest/gtest.h>

#include "core/camera/opencv_camera_file.h"
#include "core/logs/camera_file.h"
#include "test/unit/camera/board_scene.h"

namespace lodemark {
namespace {

Calibration CalibrateScene() {
  LensParameters truth;
  truth.model = LensModel::kBrown;
  truth.width_px = 1000;
  truth.height_px = 700;
  truth.fx_px = truth.fy_px = 700.0;
  truth.cx_px = 505.0;
  truth.cy_px = 340.0;
  truth.coefficients[0] = -0.2;
  truth.coefficients[1] = 0.08;
  return *Calibrate(1000, 700, test::SeeBoards(*Lens::Create(truth), 10, 0.2, 1));
}

const std::vector<CalibrationPhoto> kPhotos = {
    {"one.jpg", 54, true, 0.2, ""}, {"two \"quoted\"\n.jpg", 0, false, 0.0, "no board found"}};

TEST(CalibrationText, WritesACameraFileThatReadsBack) {
  const Calibration calibration = CalibrateScene();
  const auto text = CalibrationFile(calibration, kPhotos, "camera.json");
  ASSERT_TRUE(text.ok()) << text.error().message;
  const auto file = ParseCameraFile("camera.json", *text);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->lens.fx_px, calibration.lens.fx_px);
  EXPECT_EQ(file->lens.coefficients, calibration.lens.coefficients);
  ASSERT_TRUE(file->covariance.has_value());
  EXPECT_EQ(*file->covariance, calibration.covariance);
  EXPECT_EQ(file->rms_px, calibration.rms_px);
  EXPECT_NE(text->find("one.jpg"), std::string::npos);
}

TEST(CalibrationText, WritesOpenCvFilesThatReadBack) {
  const Calibration calibration = CalibrateScene();
  for (const char* path : {"camera.yml", "camera.xml"}) {
    const auto text = CalibrationFile(calibration, kPhotos, path);
    ASSERT_TRUE(text.ok()) << text.error().message;
    const auto lens = ParseOpenCvCameraFile(path, *text);
    ASSERT_TRUE(lens.ok()) << lens.error().message;
    EXPECT_EQ(lens->fx_px, calibration.lens.fx_px);
  }
}

TEST(CalibrationText, SaysWhichPhotographsWereNotUsedAndWhy) {
  const std::string text = CalibrationText(CalibrateScene(), kPhotos, false);
  EXPECT_NE(text.find("Lens: brown k1 k2"), std::string::npos);
  EXPECT_NE(text.find("not used: no board found"), std::string::npos);
  EXPECT_NE(text.find("; chosen"), std::string::npos);
  EXPECT_EQ(text.find("\n.jpg"), std::string::npos);
}

}  // namespace
}  // namespace lodemark
