#include "core/fusion/position_statement.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

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

}  // namespace
}  // namespace lodemark
