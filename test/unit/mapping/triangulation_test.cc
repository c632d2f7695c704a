#include "tools/mapping/triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "core/base/random.h"

namespace lodemark {
namespace {

// Cameras on an arc around the origin, ten metres away, that look at it through a wide Brown lens.
class Arc {
 public:
  Arc() : lens_(MakeLens()) {
    for (int i = 0; i < 6; ++i) {
      const double azimuth = 0.2 * i - 0.5;
      const Eigen::Vector3d centre(10.0 * std::sin(azimuth), 0.3 * i, -10.0 * std::cos(azimuth));
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitY()));
      poses_.emplace_back(turn, -(turn * centre));
    }
  }

  std::vector<PointView> Views(const Eigen::Vector3d& point, double noise_px,
                               Random* random) const {
    std::vector<PointView> views;
    for (const Rigid3& pose : poses_) {
      PointView view;
      view.lens = &lens_;
      view.camera_from_world = &pose;
      view.sigma_px = 0.5 + 0.25 * static_cast<double>(views.size() % 3);
      const auto pixel = lens_.Project(pose * point);
      if (!pixel) continue;
      view.pixel = *pixel + noise_px * view.sigma_px *
                                Eigen::Vector2d(random->Gaussian(), random->Gaussian());
      view.bearing = lens_.Unproject(view.pixel).value_or(Eigen::Vector3d::UnitZ());
      views.push_back(view);
    }
    return views;
  }

 private:
  static Lens MakeLens() {
    LensParameters parameters;
    parameters.model = LensModel::kBrown;
    parameters.width_px = 1200;
    parameters.height_px = 900;
    parameters.fx_px = 800.0;
    parameters.fy_px = 810.0;
    parameters.cx_px = 600.0;
    parameters.cy_px = 450.0;
    parameters.coefficients[0] = -0.1;
    return *Lens::Create(parameters);
  }

  Lens lens_;
  std::vector<Rigid3> poses_;
};

TEST(Triangulation, FindsThePointOfExactPixels) {
  const Arc arc;
  Random random(1);
  const Eigen::Vector3d point(0.7, -0.4, 1.1);
  const auto found = Triangulate(arc.Views(point, 0.0, &random), {});
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((found->in_world - point).norm(), 1e-9);
  EXPECT_EQ(found->used, 6);
  EXPECT_NEAR(found->parallax_rad, 1.0, 0.15);
}

TEST(Triangulation, PassesOverMistakenViews) {
  const Arc arc;
  Random random(2);
  const Eigen::Vector3d point(-0.5, 0.2, -0.8);
  std::vector<PointView> views = arc.Views(point, 0.3, &random);
  for (const std::size_t i : {1U, 4U}) {
    views[i].pixel += Eigen::Vector2d(30.0, -25.0);
    views[i].bearing = *views[i].lens->Unproject(views[i].pixel);
  }
  const auto found = Triangulate(views, {});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->used, 4);
  EXPECT_EQ(found->is_used[1], 0);
  EXPECT_EQ(found->is_used[4], 0);
  EXPECT_LT((found->in_world - point).norm(), 0.02);
}

TEST(Triangulation, ScattersAsItsCovarianceSays) {
  const Arc arc;
  Random random(3);
  constexpr int kRounds = 1500;
  constexpr double kNoise_px = 0.8;
  double sum = 0.0;
  double squares = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Vector3d point(random.Uniform(-2, 2), random.Uniform(-2, 2),
                                random.Uniform(-2, 2));
    TriangulationOptions options;
    options.largest_residual_px = 8.0;
    const auto found = Triangulate(arc.Views(point, kNoise_px, &random), options);
    ASSERT_TRUE(found.has_value());
    const Eigen::Matrix3d covariance = kNoise_px * kNoise_px * found->unit_covariance;
    const Eigen::Vector3d error = found->in_world - point;
    sum += error.dot(covariance.ldlt().solve(error));
    squares += found->squares / (2.0 * found->used - 3.0);
  }
  // A chi-square number of 3 degrees of freedom scatters by 2.45; the mean of 1500 by 0.063.
  EXPECT_NEAR(sum / kRounds, 3.0, 0.25);
  EXPECT_NEAR(std::sqrt(squares / kRounds), kNoise_px, 0.03);
}

TEST(Triangulation, RefusesPointsSeenFromOneSide) {
  const Arc arc;
  Random random(4);
  std::vector<PointView> views = arc.Views({0, 0, 0}, 0.1, &random);
  EXPECT_FALSE(Triangulate(std::span(views).first(1), {}).has_value());
  TriangulationOptions options;
  options.least_parallax_rad = 0.3;
  EXPECT_FALSE(Triangulate(std::span(views).first(2), options).has_value());
  EXPECT_TRUE(Triangulate(views, options).has_value());
  options.least_views = 7;
  EXPECT_FALSE(Triangulate(views, options).has_value());
  views.assign(3, views.front());
  EXPECT_FALSE(Triangulate(views, {}).has_value());
  EXPECT_FALSE(Triangulate({}, {}).has_value());
}

TEST(Triangulation, AppraisesWithoutMovingThePoint) {
  const Arc arc;
  Random random(5);
  const Eigen::Vector3d point(0.1, 0.2, 0.3);
  const std::vector<PointView> views = arc.Views(point, 0.0, &random);
  const Eigen::Vector3d off = point + Eigen::Vector3d(0.002, 0.0, 0.0);
  const auto appraised = AppraisePoint(off, views, {});
  ASSERT_TRUE(appraised.has_value());
  EXPECT_EQ(appraised->in_world, off);
  EXPECT_GT(appraised->squares, 0.0);
  EXPECT_FALSE(AppraisePoint(point + Eigen::Vector3d(5, 0, 0), views, {}).has_value());
}

}  // namespace
}  // namespace lodemark
