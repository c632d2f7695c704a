// Lenses through the C interface.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/photo_scene.h"

namespace lodemark::test {
namespace {

lodemark_lens PhoneLens() {
  lodemark_lens lens = {};
  lens.struct_size = sizeof lens;
  lens.model = LODEMARK_LENS_BROWN;
  lens.width_px = 640;
  lens.height_px = 480;
  lens.fx_px = 500.0;
  lens.fy_px = 505.0;
  lens.cx_px = 321.0;
  lens.cy_px = 238.0;
  lens.coefficients[0] = -0.12;
  lens.coefficients[1] = 0.03;
  lens.coefficients[2] = 1e-3;
  return lens;
}

TEST(LensStep, UnprojectsWhatItProjects) {
  const lodemark_lens lens = PhoneLens();
  const std::vector<double> pixels = {0.0, 0.0, 321.0, 238.0, 639.0, 479.0, 100.5, 400.25};
  std::vector<double> directions(12);
  std::vector<double> again(8);
  std::vector<std::uint8_t> valid(4);
  ASSERT_EQ(lodemark_lens_unproject(&lens, pixels.data(), 4, directions.data(), valid.data()),
            LODEMARK_OK);
  EXPECT_EQ(valid, std::vector<std::uint8_t>(4, 1));
  EXPECT_NEAR(directions[5], 1.0, 1e-15);  // the principal point looks along the axis
  ASSERT_EQ(lodemark_lens_project(&lens, directions.data(), 4, again.data(), valid.data()),
            LODEMARK_OK);
  for (std::size_t i = 0; i < pixels.size(); ++i) EXPECT_NEAR(again[i], pixels[i], 1e-9);
}

TEST(LensStep, StraightensPointsOfAStraightLine) {
  const lodemark_lens lens = PhoneLens();
  // A line in space in front of the camera, as the lens bends it.
  std::vector<double> points;
  for (int i = -3; i <= 3; ++i) points.insert(points.end(), {0.15 * i, 0.3 + 0.02 * i, 1.0});
  std::vector<double> pixels(14);
  std::vector<std::uint8_t> valid(7);
  ASSERT_EQ(lodemark_lens_project(&lens, points.data(), 7, pixels.data(), valid.data()),
            LODEMARK_OK);
  ASSERT_EQ(lodemark_lens_undistort_points(&lens, pixels.data(), 7, pixels.data(), valid.data()),
            LODEMARK_OK);
  for (int i = 0; i < 7; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    EXPECT_NEAR(pixels[2 * k], 321.0 + 500.0 * 0.15 * (i - 3), 1e-7);
    EXPECT_NEAR(pixels[2 * k + 1], 238.0 + 505.0 * (0.3 + 0.02 * (i - 3)), 1e-7);
  }
}

TEST(LensStep, SaysWhichPixelsTheLensDoesNotImage) {
  lodemark_lens lens = PhoneLens();
  std::memset(lens.coefficients, 0, sizeof lens.coefficients);
  lens.coefficients[0] = -0.5;  // folds back at r = sqrt(2/3), where it reaches 0.544
  const double pixels[4] = {321.0, 238.0, 321.0 + 500.0 * 0.7, 238.0};
  double directions[6] = {};
  std::uint8_t valid[2] = {7, 7};
  ASSERT_EQ(lodemark_lens_unproject(&lens, pixels, 2, directions, valid), LODEMARK_OK);
  EXPECT_EQ(valid[0], 1);
  EXPECT_EQ(valid[1], 0);
  EXPECT_EQ(directions[3], 0.0);
}

TEST(LensStep, NamesWhatIsWrongWithALens) {
  lodemark_lens lens = PhoneLens();
  lens.fx_px = std::numeric_limits<double>::quiet_NaN();
  double pixel[2] = {1.0, 1.0};
  std::uint8_t valid = 0;
  EXPECT_EQ(lodemark_lens_undistort_points(&lens, pixel, 1, pixel, &valid),
            LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(std::strstr(lodemark_last_error(), "lens: its focal length"), lodemark_last_error())
      << lodemark_last_error();
  lens = PhoneLens();
  lens.model = 99;
  EXPECT_EQ(lodemark_lens_undistort_points(&lens, pixel, 1, pixel, &valid),
            LODEMARK_ERROR_UNSUPPORTED);
}

TEST(LensStep, RefusesNullAndNonsense) {
  const lodemark_lens lens = PhoneLens();
  double pixel[2] = {1.0, 1.0};
  double direction[3] = {};
  std::uint8_t valid = 0;
  constexpr lodemark_status kInvalid = LODEMARK_ERROR_INVALID_ARGUMENT;
  EXPECT_EQ(lodemark_lens_unproject(nullptr, pixel, 1, direction, &valid), kInvalid);
  EXPECT_EQ(lodemark_lens_unproject(&lens, nullptr, 1, direction, &valid), kInvalid);
  EXPECT_EQ(lodemark_lens_unproject(&lens, pixel, 1, nullptr, &valid), kInvalid);
  EXPECT_EQ(lodemark_lens_unproject(&lens, pixel, 1, direction, nullptr), kInvalid);
  EXPECT_EQ(lodemark_lens_unproject(&lens, pixel, -1, direction, &valid), kInvalid);
  EXPECT_EQ(lodemark_lens_unproject(&lens, nullptr, 0, nullptr, nullptr), LODEMARK_OK);
  pixel[1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(lodemark_lens_unproject(&lens, pixel, 1, direction, &valid), kInvalid);
  EXPECT_EQ(lodemark_lens_project(&lens, nullptr, 1, pixel, &valid), kInvalid);
  EXPECT_EQ(lodemark_lens_undistort_points(&lens, nullptr, 1, pixel, &valid), kInvalid);
}

TEST(UndistortionStep, LeavesThePhotographOfAPinholeAsItIs) {
  lodemark_lens lens = PhoneLens();
  lens.model = LODEMARK_LENS_PINHOLE;
  std::memset(lens.coefficients, 0, sizeof lens.coefficients);
  const std::vector<std::uint8_t> photo = Painting(3, lens.width_px, lens.height_px);
  lodemark_undistortion* undistortion = nullptr;
  ASSERT_EQ(lodemark_undistortion_open(&lens, &lens, nullptr, &undistortion), LODEMARK_OK);
  std::vector<std::uint8_t> out(photo.size());
  ASSERT_EQ(lodemark_undistortion_apply(undistortion, photo.data(), 640, out.data(), 640),
            LODEMARK_OK);
  EXPECT_EQ(out, photo);
  lodemark_undistortion_close(undistortion);
}

TEST(UndistortionStep, GivesAStraightLensAndFillsItsImage) {
  const lodemark_lens lens = PhoneLens();
  lodemark_lens straight = {};
  straight.struct_size = sizeof straight;
  lodemark_undistortion* undistortion = nullptr;
  ASSERT_EQ(lodemark_undistortion_open(&lens, nullptr, &straight, &undistortion), LODEMARK_OK);
  EXPECT_EQ(straight.model, LODEMARK_LENS_PINHOLE);
  EXPECT_EQ(straight.width_px, lens.width_px);
  const std::vector<std::uint8_t> photo(640 * 480, 200);
  std::vector<std::uint8_t> out(700 * 480, 7);
  ASSERT_EQ(lodemark_undistortion_apply(undistortion, photo.data(), 640, out.data(), 700),
            LODEMARK_OK);
  for (const std::size_t i : {std::size_t{0}, std::size_t{639}, std::size_t{479 * 700 + 639}}) {
    EXPECT_EQ(out[i], 200) << i;
  }
  EXPECT_EQ(out[650], 7);  // between the rows nothing is written
  lodemark_undistortion_close(undistortion);
}

TEST(UndistortionStep, RefusesNullAndNarrowRows) {
  const lodemark_lens lens = PhoneLens();
  constexpr lodemark_status kInvalid = LODEMARK_ERROR_INVALID_ARGUMENT;
  EXPECT_EQ(lodemark_undistortion_open(&lens, nullptr, nullptr, nullptr), kInvalid);
  lodemark_undistortion* undistortion = nullptr;
  EXPECT_EQ(lodemark_undistortion_open(nullptr, nullptr, nullptr, &undistortion), kInvalid);
  EXPECT_EQ(undistortion, nullptr);
  EXPECT_EQ(lodemark_undistortion_open(&lens, &lens, nullptr, &undistortion), kInvalid);  // bent
  ASSERT_EQ(lodemark_undistortion_open(&lens, nullptr, nullptr, &undistortion), LODEMARK_OK);
  std::vector<std::uint8_t> pixels(640 * 480);
  std::uint8_t* data = pixels.data();
  EXPECT_EQ(lodemark_undistortion_apply(nullptr, data, 640, data, 640), kInvalid);
  EXPECT_EQ(lodemark_undistortion_apply(undistortion, nullptr, 640, data, 640), kInvalid);
  EXPECT_EQ(lodemark_undistortion_apply(undistortion, data, 640, nullptr, 640), kInvalid);
  EXPECT_EQ(lodemark_undistortion_apply(undistortion, data, 639, data, 640), kInvalid);
  EXPECT_EQ(lodemark_undistortion_apply(undistortion, data, 640, data, -640), kInvalid);
  lodemark_undistortion_close(undistortion);
  lodemark_undistortion_close(nullptr);
}

}  // namespace
}  // namespace lodemark::test
