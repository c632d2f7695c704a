#include "core/fusion/position_statement.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/base/random.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

PositionStatement Stated(const Eigen::Vector3d& offset_m, const Eigen::Matrix3d& covariance_m2) {
  PositionStatement statement;
  statement.information_pm2 = covariance_m2.inverse();
  statement.pull_pm = statement.information_pm2 * offset_m;
  return statement;
}

Eigen::Matrix3d SomeCovariance() {
  Eigen::Matrix3d root;
  root << 2.0, 0.0, 0.0, 0.7, 1.5, 0.0, -0.4, 0.2, 4.0;
  return root * root.transpose();
}

TEST(PositionStatement, CostsLeastWhereItSaysItIs) {
  const Eigen::Vector3d said(3.0, -2.0, 1.0);
  const PositionStatement statement = Stated(said, SomeCovariance());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-0.1, 0.1}) {
      EXPECT_GT(statement.CostAt(said + step * Eigen::Vector3d::Unit(axis)),
                statement.CostAt(said));
    }
  }
  // One sigma along an axis of the covariance costs a half.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(SomeCovariance());
  const Eigen::Vector3d sigma = std::sqrt(axes.eigenvalues()[1]) * axes.eigenvectors().col(1);
  EXPECT_NEAR(statement.CostAt(said + sigma) - statement.CostAt(said), 0.5, 1e-12);
}

TEST(PositionStatement, MomentsAreThoseItWasMadeFrom) {
  const Eigen::Vector3d said(3.0, -2.0, 1.0);
  Eigen::Vector3d offset_m;
  Eigen::Matrix3d covariance_m2;
  Stated(said, SomeCovariance()).Moments(1e3, &offset_m, &covariance_m2);
  EXPECT_TRUE(offset_m.isApprox(said, 1e-9));
  EXPECT_TRUE(covariance_m2.isApprox(SomeCovariance(), 1e-9));
}

TEST(PositionStatement, ClaimsNothingAlongWhatItDoesNotKnow) {
  PositionStatement statement;
  statement.information_pm2 = Eigen::Vector3d(0.25, 0.0, 0.0).asDiagonal();
  statement.pull_pm = {0.5, 0.0, 0.0};
  EXPECT_EQ(statement.Rank(1e3), 1);
  Eigen::Vector3d offset_m;
  Eigen::Matrix3d covariance_m2;
  statement.Moments(1e3, &offset_m, &covariance_m2);
  EXPECT_TRUE(offset_m.isApprox(Eigen::Vector3d(2.0, 0.0, 0.0)));
  EXPECT_DOUBLE_EQ(covariance_m2(0, 0), 4.0);
  EXPECT_DOUBLE_EQ(covariance_m2(1, 1), 1e6);
}

TEST(PositionStatement, CommonErrorAddsToItsCovarianceAndLeavesItsPlace) {
  const Eigen::Vector3d said(3.0, -2.0, 1.0);
  const Eigen::Matrix3d common = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  Eigen::Vector3d offset_m;
  Eigen::Matrix3d covariance_m2;
  Stated(said, SomeCovariance()).WithCommonError(common).Moments(1e3, &offset_m, &covariance_m2);
  EXPECT_TRUE(offset_m.isApprox(said, 1e-9));
  EXPECT_TRUE(covariance_m2.isApprox(SomeCovariance() + common, 1e-9));
}

TEST(PositionStatement, TogetherItCostsWhatEachCosts) {
  Random random(6);
  const auto drawn = [&random](double within) {
    return Eigen::Vector3d(random.Uniform(-within, within), random.Uniform(-within, within),
                           random.Uniform(-within, within));
  };
  for (int trial = 0; trial < 50; ++trial) {
    PositionStatement first = Stated(drawn(5.0), SomeCovariance());
    PositionStatement second = Stated(drawn(5.0), 2.0 * SomeCovariance());
    first.around_in_ecef = EcefFromGeodetic({0.84, 0.2, 250.0});
    second.around_in_ecef = first.around_in_ecef + drawn(1.0).normalized() * 100.0;
    const PositionStatement both = Together(first, second);
    const Eigen::Matrix3d first_axes = EnuFromEcefRotation(GeodeticFromEcef(first.around_in_ecef));
    const Eigen::Matrix3d second_axes =
        EnuFromEcefRotation(GeodeticFromEcef(second.around_in_ecef));
    const auto excess = [&](const Eigen::Vector3d& offset_m) {
      const Eigen::Vector3d from_second =
          second_axes *
          (first.around_in_ecef + first_axes.transpose() * offset_m - second.around_in_ecef);
      return both.CostAt(offset_m) - first.CostAt(offset_m) - second.CostAt(from_second);
    };
    const double constant = excess(Eigen::Vector3d::Zero());
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector3d offset_m = drawn(10.0);
      // Axes 100 m apart are turned by 16 microradians times the tangent of the latitude, which
      // turns a pull of some hundred metres' worth by as much.
      const double pull_pm = (second.information_pm2 * Eigen::Vector3d::Constant(110.0)).norm();
      EXPECT_NEAR(excess(offset_m), constant, 4e-5 * pull_pm * offset_m.norm());
    }
  }
}

}  // namespace
}  // namespace lodemark
