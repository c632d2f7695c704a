#include "core/camera/image_undistortion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "test/unit/camera/lenses.h"

namespace lodemark {
namespace {

using test::Lens1000;
using test::ManyLenses;

// A scene far away: grey by the direction, smooth over some pixels.
double GreyOf(const Eigen::Vector3d& direction) {
  return 128.0 + 50.0 * std::sin(9.0 * direction.x()) +
         50.0 * std::cos(7.0 * direction.y() + 2.0 * direction.x());
}

// The photograph of it.
std::vector<std::uint8_t> PhotoBy(const Lens& lens) {
  const LensParameters& p = lens.parameters();
  std::vector<std::uint8_t> photo;
  for (int y = 0; y < p.height_px; ++y) {
    for (int x = 0; x < p.width_px; ++x) {
      const auto direction = lens.Unproject({x, y});
      photo.push_back(direction ? static_cast<std::uint8_t>(std::lround(GreyOf(*direction))) : 0);
    }
  }
  return photo;
}

GrayImage ImageOf(const std::vector<std::uint8_t>& pixels, const Lens& lens) {
  const LensParameters& p = lens.parameters();
  return {pixels.data(), p.width_px, p.height_px, p.width_px};
}

Lens Make(const LensParameters& parameters) { return *Lens::Create(parameters); }

TEST(ImageUndistortion, ShowsWhatAPinholeWouldHaveSeen) {
  const std::vector<test::NamedLens> lenses = ManyLenses();
  for (std::size_t i = 0; i < lenses.size(); i += 2) {
    const auto& [name, parameters] = lenses[i];
    const Lens source = Make(parameters);
    const Result<Lens> target = ImageUndistortion::InscribedPinhole(source);
    ASSERT_TRUE(target.ok()) << name << ": " << target.error().message;
    const Result<ImageUndistortion> undistortion = ImageUndistortion::Create(source, *target);
    ASSERT_TRUE(undistortion.ok());
    const std::vector<std::uint8_t> photo = PhotoBy(source);
    std::vector<std::uint8_t> straight(photo.size());
    ASSERT_TRUE(undistortion->Apply(ImageOf(photo, source), straight, parameters.width_px).ok());
    double most = 0.0;
    double sum = 0.0;
    for (int y = 0; y < parameters.height_px; ++y) {
      for (int x = 0; x < parameters.width_px; ++x) {
        const double expected = GreyOf(*target->Unproject({x, y}));
        const double grey = straight[static_cast<std::size_t>(y * parameters.width_px + x)];
        most = std::max(most, std::abs(grey - expected));
        sum += std::abs(grey - expected);
      }
    }
    EXPECT_LT(sum / static_cast<double>(photo.size()), 0.6) << name;
    // Where the lens ends inside the image its photograph is black next to the last that it saw.
    if (!name.starts_with("fold") && name != "fisheye fold") {
      EXPECT_LT(most, 2.5) << name;
    }
  }
}

TEST(InscribedPinhole, ShowsNothingTheSourceDidNotSee) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens source = Make(parameters);
    const Result<Lens> target = ImageUndistortion::InscribedPinhole(source);
    ASSERT_TRUE(target.ok()) << name;
    const LensParameters& p = target->parameters();
    EXPECT_EQ(p.model, LensModel::kPinhole);
    EXPECT_NEAR(p.fx_px / p.fy_px, parameters.fx_px / parameters.fy_px, 1e-9);
    double least_margin_px = 1e9;
    for (int x = 0; x < p.width_px; x += 9) {
      for (int y = 0; y < p.height_px; y += 9) {
        const auto pixel = source.Project(*target->Unproject({x, y}));
        ASSERT_TRUE(pixel.has_value()) << name;
        const double margin_px =
            std::min({pixel->x(), pixel->y(), 999.0 - pixel->x(), 699.0 - pixel->y()});
        ASSERT_GT(margin_px, -0.001) << name;
        least_margin_px = std::min(least_margin_px, margin_px);
      }
    }
    // Unless the widest pinhole is reached or the lens ends before the image does, it touches.
    const double half_diagonal = std::hypot(999.0 / (2.0 * p.fx_px), 699.0 / (2.0 * p.fy_px));
    const bool ends_inside = name.starts_with("fold") || name == "fisheye fold";
    if (half_diagonal < 3.99 && !ends_inside) {
      EXPECT_LT(least_margin_px, 3.5) << name;
    }
  }
}

TEST(InscribedPinhole, IsThePinholeItself) {
  const LensParameters p = Lens1000(LensModel::kPinhole, 800.0, {});
  const Result<Lens> same = ImageUndistortion::InscribedPinhole(Make(p));
  ASSERT_TRUE(same.ok());
  EXPECT_NEAR(same->parameters().fx_px, p.fx_px, 1e-3);
  EXPECT_NEAR(same->parameters().fy_px, p.fy_px, 1e-3);
  EXPECT_NEAR(same->parameters().cx_px, p.cx_px, 1e-3);
  EXPECT_NEAR(same->parameters().cy_px, p.cy_px, 1e-3);
}

TEST(ImageUndistortion, IsBlackWhereTheSourceHasNothing) {
  const Lens source = Make(Lens1000(LensModel::kFisheye, 400.0, {-0.02}));
  LensParameters wide = Lens1000(LensModel::kPinhole, 20.0, {});
  wide.width_px = 300;
  wide.height_px = 200;
  wide.cx_px = 150.0;
  wide.cy_px = 100.0;
  const Result<ImageUndistortion> undistortion = ImageUndistortion::Create(source, Make(wide));
  ASSERT_TRUE(undistortion.ok());
  const std::vector<std::uint8_t> photo(700'000, 200);
  std::vector<std::uint8_t> straight(310 * 200, 7);
  ASSERT_TRUE(undistortion->Apply(ImageOf(photo, source), straight, 310).ok());
  EXPECT_EQ(straight[310 * 100], 0);
  EXPECT_EQ(straight[310 * 100 + 299], 0);
  EXPECT_EQ(straight[310 * 100 + 150], 200);
  EXPECT_EQ(straight[305], 7);  // between the rows nothing is touched
}

TEST(ImageUndistortion, RefusesImagesThatDoNotFit) {
  const Lens source = Make(Lens1000(LensModel::kBrown, 800.0, {-0.1}));
  const Result<Lens> target = ImageUndistortion::InscribedPinhole(source);
  EXPECT_FALSE(ImageUndistortion::Create(source, source).ok());
  const Result<ImageUndistortion> undistortion = ImageUndistortion::Create(source, *target);
  ASSERT_TRUE(undistortion.ok());
  const std::vector<std::uint8_t> photo(700'000, 200);
  std::vector<std::uint8_t> straight(700'000);
  GrayImage image = ImageOf(photo, source);
  EXPECT_TRUE(undistortion->Apply(image, straight, 1000).ok());
  EXPECT_FALSE(undistortion->Apply(image, straight, 999).ok());
  EXPECT_FALSE(undistortion->Apply(image, straight, -1000).ok());
  EXPECT_FALSE(undistortion->Apply(image, straight, 1001).ok());
  EXPECT_FALSE(undistortion->Apply(image, {}, 1000).ok());
  EXPECT_FALSE(undistortion->Apply({}, straight, 1000).ok());
  image.stride_bytes = 999;
  EXPECT_FALSE(undistortion->Apply(image, straight, 1000).ok());
  image = ImageOf(photo, source);
  image.width_px = 999;
  EXPECT_FALSE(undistortion->Apply(image, straight, 1000).ok());

  LensParameters huge = Lens1000(LensModel::kPinhole, 800.0, {});
  huge.width_px = 65535;
  EXPECT_FALSE(ImageUndistortion::Create(source, Make(huge)).ok());
  huge.width_px = huge.height_px = 32'000;
  EXPECT_FALSE(ImageUndistortion::Create(Make(huge), *target).ok());
}

TEST(InscribedPinhole, HasAPixelOfAnImageOfOne) {
  LensParameters tiny = Lens1000(LensModel::kBrown, 100.0, {-0.1});
  tiny.width_px = tiny.height_px = 1;
  tiny.cx_px = tiny.cy_px = 0.0;
  const Lens source = Make(tiny);
  const Result<Lens> target = ImageUndistortion::InscribedPinhole(source);
  if (target.ok()) {
    EXPECT_TRUE(ImageUndistortion::Create(source, *target).ok());
  }
}

}  // namespace
}  // namespace lodemark
