#include "core/geo/rotation.h"

#include <gtest/gtest.h>

#include "core/base/units.h"

namespace lodemark {
namespace {

TEST(Rotation, TurnsAboutItsAxis) {
  const Eigen::Quaterniond quarter = Turn(Eigen::Vector3d(0.0, 0.0, kPi / 2.0));
  EXPECT_LT((quarter * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(Rotation, ComesBackAsTheVectorItWas) {
  for (const double angle_rad : {0.0, 1e-15, 1e-9, 1e-3, 1.0, 3.0}) {
    const Eigen::Vector3d turn = angle_rad * Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0;
    EXPECT_LT((TurnOf(Turn(turn)) - turn).norm(), 1e-12) << angle_rad;
  }
}

TEST(Rotation, IsTheShortestOfTwo) {
  Eigen::Quaterniond turned = Turn(Eigen::Vector3d(0.1, 0.0, 0.0));
  turned.coeffs() *= -1.0;
  EXPECT_LT((TurnOf(turned) - Eigen::Vector3d(0.1, 0.0, 0.0)).norm(), 1e-12);
}

TEST(Rotation, CrossOfIsTheCrossProduct) {
  const Eigen::Vector3d v(1.0, 2.0, 3.0);
  const Eigen::Vector3d w(-2.0, 0.5, 4.0);
  EXPECT_LT((CrossOf(v) * w - v.cross(w)).norm(), 1e-15);
}

// To first order, a small turn moves a vector by the cross product.
TEST(Rotation, MovesByTheCrossProduct) {
  const Eigen::Vector3d v(1.0, 2.0, 3.0);
  const Eigen::Vector3d turn(1e-6, -2e-6, 1e-6);
  EXPECT_LT((Turn(turn) * v - v + CrossOf(v) * turn).norm(), 1e-10);
}

}  // namespace
}  // namespace lodemark
