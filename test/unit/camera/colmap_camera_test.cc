#include "core/camera/colmap_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "test/unit/camera/lenses.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

Result<LensParameters> From(std::string_view model, std::initializer_list<double> numbers) {
  const std::vector<double> parameters(numbers);
  return LensFromColmap(model, 1000, 700, parameters);
}

TEST(ColmapCamera, MovesThePrincipalPointByHalfAPixel) {
  const Result<LensParameters> lens = From("PINHOLE", {800.0, 810.0, 500.0, 350.0});
  ASSERT_TRUE(lens.ok());
  EXPECT_EQ(lens->model, LensModel::kPinhole);
  EXPECT_EQ(lens->width_px, 1000);
  EXPECT_EQ(lens->height_px, 700);
  EXPECT_EQ(lens->fx_px, 800.0);
  EXPECT_EQ(lens->fy_px, 810.0);
  EXPECT_EQ(lens->cx_px, 499.5);
  EXPECT_EQ(lens->cy_px, 349.5);
}

TEST(ColmapCamera, KnowsTheModelsWithOneFocalLength) {
  const Result<LensParameters> pinhole = From("SIMPLE_PINHOLE", {800.0, 500.0, 350.0});
  ASSERT_TRUE(pinhole.ok());
  EXPECT_EQ(pinhole->fy_px, 800.0);
  EXPECT_EQ(pinhole->cy_px, 349.5);
  const Result<LensParameters> radial = From("RADIAL", {800.0, 500.0, 350.0, -0.1, 0.02});
  ASSERT_TRUE(radial.ok());
  EXPECT_EQ(radial->model, LensModel::kBrown);
  EXPECT_EQ(radial->coefficients[0], -0.1);
  EXPECT_EQ(radial->coefficients[1], 0.02);
  EXPECT_EQ(From("SIMPLE_RADIAL", {800.0, 500.0, 350.0, -0.1})->coefficients[0], -0.1);
  const Result<LensParameters> fisheye =
      From("RADIAL_FISHEYE", {300.0, 500.0, 350.0, -0.01, 0.002});
  ASSERT_TRUE(fisheye.ok());
  EXPECT_EQ(fisheye->model, LensModel::kFisheye);
  EXPECT_EQ(fisheye->coefficients[1], 0.002);
  EXPECT_EQ(From("SIMPLE_RADIAL_FISHEYE", {300.0, 500.0, 350.0, -0.01})->coefficients[0], -0.01);
}

TEST(ColmapCamera, GivesBackWhatItWasGiven) {
  const struct {
    const char* model;
    std::vector<double> parameters;
  } cameras[] = {
      {"PINHOLE", {800.0, 810.0, 500.0, 350.0}},
      {"OPENCV", {800.0, 810.0, 500.0, 350.0, -0.1, 0.02, 1e-3, 2e-3}},
      {"FULL_OPENCV", {800.0, 810.0, 500.0, 350.0, -0.1, 0.02, 1e-3, 2e-3, 0.1, 0.01, 0.02, 0.03}},
      {"OPENCV_FISHEYE", {300.0, 310.0, 500.0, 350.0, -0.01, 2e-3, 1e-3, 1e-4}},
      {"THIN_PRISM_FISHEYE",
       {300.0, 310.0, 500.0, 350.0, -0.01, 2e-3, 1e-3, 2e-3, 1e-3, 1e-4, 1e-3, 2e-3}},
  };
  for (const auto& camera : cameras) {
    const Result<LensParameters> lens = LensFromColmap(camera.model, 1000, 700, camera.parameters);
    ASSERT_TRUE(lens.ok()) << lens.error().message;
    const Result<ColmapLens> again = ColmapFromLens(*lens);
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ(again->model, camera.model);
    EXPECT_EQ(again->parameters, camera.parameters);
  }
}

TEST(ColmapCamera, HasNoTiltedSensorsAndNoFieldOfViewModel) {
  for (const auto& [name, lens] : test::ManyLenses()) {
    const Result<ColmapLens> colmap = ColmapFromLens(lens);
    EXPECT_EQ(colmap.ok(), name != "tilted" && name != "prism") << name;
  }
  const Result<LensParameters> fov = From("FOV", {800.0, 810.0, 500.0, 350.0, 0.9});
  ASSERT_FALSE(fov.ok());
  EXPECT_EQ(fov.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(fov.error().message, HasSubstr("FOV"));
}

TEST(ColmapCamera, RefusesWhatMakesNoLens) {
  EXPECT_FALSE(From("PINHOLE", {800.0, 810.0, 500.0}).ok());
  EXPECT_FALSE(From("PINHOLE", {800.0, 0.0, 500.0, 350.0}).ok());
  EXPECT_FALSE(
      From("PINHOLE", {800.0, std::numeric_limits<double>::quiet_NaN(), 500.0, 350.0}).ok());
  EXPECT_FALSE(From("", {}).ok());
  const std::vector<double> pinhole = {800.0, 810.0, 500.0, 350.0};
  EXPECT_FALSE(LensFromColmap("PINHOLE", 0, 700, pinhole).ok());
  EXPECT_FALSE(
      LensFromColmap("PINHOLE", std::numeric_limits<std::uint64_t>::max(), 700, pinhole).ok());
}

}  // namespace
}  // namespace lodemark
