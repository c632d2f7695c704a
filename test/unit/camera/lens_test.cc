#include "core/camera/lens.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "core/base/units.h"
#include "test/unit/camera/lenses.h"

namespace lodemark {
namespace {

using test::Lens1000;
using test::ManyLenses;

Eigen::Vector3d Direction(double angle_rad, double azimuth_rad) {
  return {std::sin(angle_rad) * std::cos(azimuth_rad), std::sin(angle_rad) * std::sin(azimuth_rad),
          std::cos(angle_rad)};
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The projection's derivative along two perpendicular directions that make a right-handed frame
// with the given one.
Eigen::Matrix2d PixelsPerRadian(const ProjectionJacobian& jacobian,
                                const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = Eigen::Vector3d::UnitZ().cross(direction).normalized();
  across.col(1) = direction.cross(across.col(0));
  return jacobian.by_point * across;
}

double RadiansPerPixel(const ProjectionJacobian& jacobian, const Eigen::Vector3d& direction) {
  return PixelsPerRadian(jacobian, direction).inverse().norm();
}

// 1e-9 px, or the rounding of a pixel that far away.
double Tolerance_px(const Eigen::Vector2d& pixel) { return std::max(1e-9, 3e-14 * pixel.norm()); }

Lens Make(const LensParameters& parameters) {
  const Result<Lens> lens = Lens::Create(parameters);
  EXPECT_TRUE(lens.ok()) << (lens.ok() ? "" : lens.error().message);
  return *lens;
}

TEST(Lens, GivesEveryPixelBackWhichItUnprojects) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    int found = 0;
    for (double x = -500.0; x <= 1500.0; x += 7.0) {
      for (double y = -400.0; y <= 1100.0; y += 7.0) {
        const Eigen::Vector2d pixel(x, y);
        const auto bearing = lens.Unproject(pixel);
        if (!bearing) continue;
        ++found;
        ASSERT_NEAR(bearing->norm(), 1.0, 1e-15) << name;
        const auto again = lens.Project(*bearing);
        ASSERT_TRUE(again.has_value()) << name << ": " << pixel.transpose();
        ASSERT_LT((*again - pixel).norm(), Tolerance_px(pixel))
            << name << ": " << pixel.transpose();
      }
    }
    EXPECT_GT(found, 5'000) << name;
  }
}

TEST(Lens, FindsEveryDirectionWhichItProjects) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    const double limit_rad = lens.field_limit_rad();
    for (int i = 0; i < 200; ++i) {
      for (int j = 0; j < 72; ++j) {
        const double angle_rad = limit_rad * (i + 0.5) / 200.0;
        const Eigen::Vector3d direction = Direction(angle_rad, j * kPi / 36.0);
        const auto pixel = lens.Project(direction);
        // Only a tilted sensor may see less than the cone.
        if (!pixel && name == "tilted") continue;
        ASSERT_TRUE(pixel.has_value()) << name << ": " << angle_rad;
        // Near a tilted sensor's horizon rounding alone exceeds the promise.
        if (pixel->norm() > (name == "tilted" ? 1e4 : 1e7)) continue;
        const auto again = lens.Unproject(*pixel);
        ASSERT_TRUE(again.has_value())
            << name << ": " << angle_rad << " of " << limit_rad << ", " << j;
        // The fold may make an angle 1e4 times as uncertain as its pixel.
        ASSERT_LT(AngleBetween(*again, direction), 1e-8) << name << ": " << angle_rad;
      }
    }
  }
}

TEST(Lens, RefusesBeyondItsField) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    for (int j = 0; j < 72; ++j) {
      for (double angle_rad = lens.field_limit_rad() + 1e-9; angle_rad < kPi; angle_rad += 0.01) {
        ASSERT_FALSE(lens.Project(Direction(angle_rad, j * kPi / 36.0)).has_value())
            << name << ": " << angle_rad;
      }
    }
  }
}

TEST(Lens, NeverUnprojectsAPixelBeyondTheFold) {
  // f(r) = r - 0.35 r^3 has its greatest value 2/3 r0 at r0 = 1 / sqrt(1.05).
  const Lens lens = Make(Lens1000(LensModel::kBrown, 400.0, {-0.35}));
  const double fold = 1.0 / std::sqrt(1.05);
  EXPECT_NEAR(std::tan(lens.field_limit_rad()), fold, 1e-3);
  EXPECT_LT(std::tan(lens.field_limit_rad()), fold);
  const double reach_px = 400.0 * 2.0 / 3.0 * fold;
  EXPECT_TRUE(lens.Unproject({505.0 + reach_px - 0.001, 340.0}).has_value());
  EXPECT_FALSE(lens.Unproject({505.0 + reach_px + 0.001, 340.0}).has_value());
  EXPECT_FALSE(lens.Unproject({0.0, 0.0}).has_value());
}

TEST(Lens, KnowsTheFoldsOfItsPolynomials) {
  // Roots of f' by hand: 1 - 3 (0.15) t^2 + 5 (0.01) t^4 = 0 for the fisheye.
  const Lens fisheye = Make(Lens1000(LensModel::kFisheye, 400.0, {-0.15, 0.01}));
  const double u = (0.45 - std::sqrt(0.45 * 0.45 - 4.0 * 0.05)) / (2.0 * 0.05);
  EXPECT_NEAR(fisheye.field_limit_rad(), std::sqrt(u), 1e-3);
  // f = x / (1 + x^2) has its fold at 45 degrees.
  const Lens rational = Make(Lens1000(LensModel::kBrown, 400.0, {0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_NEAR(rational.field_limit_rad(), 0.25 * kPi, 1e-3);
  // f = x / (1 - x^2) has a pole there.
  const Lens pole = Make(Lens1000(LensModel::kBrown, 400.0, {0.0, 0.0, 0.0, 0.0, 0.0, -1.0}));
  EXPECT_NEAR(pole.field_limit_rad(), 0.25 * kPi, 1e-3);
  EXPECT_LE(pole.field_limit_rad(), 0.25 * kPi);
  EXPECT_EQ(Make(Lens1000(LensModel::kFisheye, 150.0, {})).field_limit_rad(), kPi);
  EXPECT_EQ(Make(Lens1000(LensModel::kBrown, 150.0, {0.1})).field_limit_rad(), 0.5 * kPi);
}

// Inside the limit the map turns no area over.
TEST(Lens, HasAPositiveDeterminantInItsField) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    const double most_rad = std::min(lens.field_limit_rad(), 1.55);
    for (int i = 1; i <= 100; ++i) {
      for (int j = 0; j < 36; ++j) {
        const double angle_rad = most_rad * i / 100.0 * (1.0 - 1e-9);
        const Eigen::Vector3d d = Direction(angle_rad, j * kPi / 18.0);
        ProjectionJacobian jacobian;
        if (!lens.Project(d, &jacobian)) continue;
        EXPECT_GT(PixelsPerRadian(jacobian, d).determinant(), 0.0) << name << ": " << angle_rad;
      }
    }
  }
}

TEST(Lens, JacobianByThePointMatchesDifferences) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    const double most_rad = std::min(0.97 * lens.field_limit_rad(), 1.4);
    for (const double share : {1e-7, 1e-3, 0.009, 0.011, 0.3, 0.7, 1.0}) {
      for (int j = 0; j < 12; ++j) {
        const Eigen::Vector3d point = 3.0 * Direction(share * most_rad, 0.1 + j * kPi / 6.0);
        ProjectionJacobian jacobian;
        if (!lens.Project(point, &jacobian)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const double h = 1e-5;
          Eigen::Vector3d ahead = point;
          Eigen::Vector3d behind = point;
          ahead[axis] += h;
          behind[axis] -= h;
          const Eigen::Vector2d slope =
              (lens.Project(ahead).value() - lens.Project(behind).value()) / (2.0 * h);
          const double scale = jacobian.by_point.norm();
          EXPECT_LT((slope - jacobian.by_point.col(axis)).norm(), 1e-6 * scale)
              << name << ": " << share << " axis " << axis;
        }
      }
    }
  }
}

TEST(Lens, JacobianByTheIntrinsicsMatchesDifferences) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    const double angle_rad = std::min(0.5 * lens.field_limit_rad(), 1.0);
    const Eigen::Vector3d point = 3.0 * Direction(angle_rad, 0.7);
    ProjectionJacobian jacobian;
    ASSERT_TRUE(lens.Project(point, &jacobian).has_value());
    for (int i = 0; i < 4 + CoefficientCount(parameters.model); ++i) {
      const auto changed = [&](double change) {
        LensParameters p = parameters;
        double* const fields[] = {&p.fx_px, &p.fy_px, &p.cx_px, &p.cy_px};
        (i < 4 ? *fields[i] : p.coefficients[static_cast<std::size_t>(i - 4)]) += change;
        return Make(p).Project(point).value();
      };
      const double h = 1e-5;
      const Eigen::Vector2d slope = (changed(h) - changed(-h)) / (2.0 * h);
      EXPECT_LT((slope - jacobian.by_intrinsics.col(i)).norm(), 1e-6 * (1.0 + slope.norm()))
          << name << ": " << i;
    }
    for (int i = 4 + CoefficientCount(parameters.model); i < kMostIntrinsics; ++i) {
      EXPECT_TRUE(jacobian.by_intrinsics.col(i).isZero(0.0));
    }
  }
}

TEST(Lens, SeesBehindItselfThroughAFisheye) {
  const Lens lens = Make(Lens1000(LensModel::kFisheye, 150.0, {}));
  const Eigen::Vector3d behind(1.0, -1.0, -1.0);
  const auto pixel = lens.Project(behind);
  ASSERT_TRUE(pixel.has_value());
  // 125.26 degrees from the axis.
  const double angle_rad = kPi - std::atan(std::sqrt(2.0));
  EXPECT_NEAR(pixel->x(), 505.0 + 150.0 * angle_rad * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(pixel->y(), 340.0 - 151.5 * angle_rad * std::sqrt(0.5), 1e-9);
  EXPECT_LT(AngleBetween(lens.Unproject(*pixel).value(), behind), 1e-12);
  EXPECT_FALSE(lens.Project({0.0, 0.0, -1.0}).has_value());
}

TEST(Lens, PutsTheAxisOnThePrincipalPoint) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    const auto pixel = lens.Project({0.0, 0.0, 2.0});
    ASSERT_TRUE(pixel.has_value()) << name;
    EXPECT_EQ(*pixel, Eigen::Vector2d(505.0, 340.0)) << name;
    const auto axis = lens.Unproject(*pixel);
    ASSERT_TRUE(axis.has_value()) << name;
    EXPECT_LT((*axis - Eigen::Vector3d::UnitZ()).norm(), 1e-12) << name;
    EXPECT_FALSE(lens.Project({0.0, 0.0, 0.0}).has_value()) << name;
  }
}

TEST(Lens, DoesNotCareHowFarAPointIs) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    const Eigen::Vector3d point(0.1, -0.2, 0.7);
    for (const double scale : {1e-150, 1e-6, 1e6, 1e150, 1e300}) {
      const auto pixel = lens.Project(scale * point);
      ASSERT_TRUE(pixel.has_value()) << name << ": " << scale;
      EXPECT_LT((*pixel - *lens.Project(point)).norm(), 1e-9) << name << ": " << scale;
    }
  }
}

TEST(Lens, UnprojectsManyAsItDoesOne) {
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    std::vector<Eigen::Vector2d> pixels;
    for (double x = -50.0; x < 1050.0; x += 37.0) pixels.emplace_back(x, 700.0 - 0.6 * x);
    std::vector<Eigen::Vector3d> bearings(pixels.size());
    std::vector<std::uint8_t> valid(pixels.size());
    std::size_t expected = 0;
    const std::size_t found = lens.Unproject(pixels, bearings, valid);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto one = lens.Unproject(pixels[i]);
      expected += one ? 1 : 0;
      EXPECT_EQ(valid[i], one ? 1 : 0);
      EXPECT_EQ(bearings[i], one.value_or(Eigen::Vector3d::Zero()));
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(Lens, AnswersNothingToWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [name, parameters] : ManyLenses()) {
    const Lens lens = Make(parameters);
    for (const double bad : {nan, infinity, -infinity}) {
      EXPECT_FALSE(lens.Unproject({bad, 10.0}).has_value()) << name;
      EXPECT_FALSE(lens.Unproject({10.0, bad}).has_value()) << name;
      EXPECT_FALSE(lens.Project({bad, 0.0, 1.0}).has_value()) << name;
      EXPECT_FALSE(lens.Project({0.0, bad, 1.0}).has_value()) << name;
      EXPECT_FALSE(lens.Project({0.0, 0.1, bad}).has_value()) << name;
    }
  }
}

TEST(Lens, RefusesParametersThatMakeNoLens) {
  const auto refused = [](auto change) {
    LensParameters p = Lens1000(LensModel::kFisheye, 300.0, {0.01});
    change(p);
    const Result<Lens> lens = Lens::Create(p);
    return !lens.ok() && lens.error().code == ErrorCode::kInvalidArgument &&
           lens.error().message.starts_with("lens: ");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(refused([](LensParameters&) {}));
  EXPECT_TRUE(refused([](LensParameters& p) { p.width_px = 0; }));
  EXPECT_TRUE(refused([](LensParameters& p) { p.height_px = 65536; }));
  EXPECT_TRUE(refused([](LensParameters& p) { p.fx_px = 0.0; }));
  EXPECT_TRUE(refused([](LensParameters& p) { p.fy_px = -300.0; }));
  EXPECT_TRUE(refused([&](LensParameters& p) { p.fy_px = nan; }));
  EXPECT_TRUE(refused([&](LensParameters& p) { p.cx_px = nan; }));
  EXPECT_TRUE(refused([](LensParameters& p) { p.cy_px = 10'001.0; }));
  EXPECT_TRUE(refused([&](LensParameters& p) { p.coefficients[2] = nan; }));
  EXPECT_TRUE(refused([](LensParameters& p) { p.coefficients[4] = 0.1; }));
  EXPECT_TRUE(refused([](LensParameters& p) { p.model = static_cast<LensModel>(9); }));
  EXPECT_TRUE(refused([](LensParameters& p) {
    p.model = LensModel::kBrown;
    p.coefficients[12] = 1.5;
  }));
  EXPECT_TRUE(refused([](LensParameters& p) { p.coefficients[0] = -1e300; }));
}

// Whatever the coefficients: what comes back is right, and what projects comes back.
TEST(Lens, IsNeverWrongWhateverItsCoefficients) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int created = 0;
  int projected = 0;
  int lost = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    LensParameters p = Lens1000(static_cast<LensModel>(1 + trial % 3), 300.0, {});
    const double size = std::pow(10.0, 3.0 * uniform(random) - 2.0);
    for (int i = 0; i < CoefficientCount(p.model); ++i) {
      p.coefficients[static_cast<std::size_t>(i)] = size * uniform(random);
    }
    if (trial % 5 == 0) p.coefficients[static_cast<std::size_t>(trial % 4)] *= 1e12;
    const Result<Lens> lens = Lens::Create(p);
    if (!lens.ok()) continue;
    ++created;
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d direction =
          Direction(lens->field_limit_rad() * std::abs(uniform(random)), kPi * uniform(random));
      ProjectionJacobian jacobian;
      const auto pixel = lens->Project(direction, &jacobian);
      if (!pixel || pixel->norm() > 1e7) continue;
      ++projected;
      const auto again = lens->Unproject(*pixel);
      if (!again) {
        if (pixel->norm() < 3e3) ++lost;  // twice the image, and rounding is no excuse
        continue;
      }
      ASSERT_LT((*lens->Project(*again) - *pixel).norm(), Tolerance_px(*pixel)) << trial;
      // As far as the pixel tells.
      const double most_rad =
          1e-7 + 10.0 * Tolerance_px(*pixel) * RadiansPerPixel(jacobian, direction);
      ASSERT_LT(AngleBetween(*again, direction), most_rad) << trial;
    }
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector2d pixel(500.0 + 900.0 * uniform(random), 350.0 + 700.0 * uniform(random));
      const auto bearing = lens->Unproject(pixel);
      if (!bearing) continue;
      const auto again = lens->Project(*bearing);
      ASSERT_TRUE(again.has_value()) << trial;
      ASSERT_LT((*again - pixel).norm(), 1e-9) << trial;
    }
  }
  EXPECT_GT(created, 2000);
  EXPECT_GT(projected, 50'000);
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace lodemark
