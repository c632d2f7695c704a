#include "core/geo/rigid3.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

Eigen::Vector3d AnyVector(Random& random) {
  Eigen::Vector3d vector;
  for (double& value : vector) value = random.Gaussian();
  return vector;
}

Rigid3 AnyRigid3(Random& random) {
  Eigen::Vector4d coefficients;
  for (double& value : coefficients) value = random.Gaussian();
  const Eigen::Quaterniond rotation(coefficients);  // the constructor makes it a unit one
  return {rotation, 10.0 * AnyVector(random)};
}

// The same transform as a homogeneous 4 x 4 matrix, which Eigen multiplies on its own.
Eigen::Matrix4d MatrixOf(const Rigid3& transform) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = transform.rotation().toRotationMatrix();
  matrix.topRightCorner<3, 1>() = transform.translation();
  return matrix;
}

TEST(Rigid3, IsIdentityWhenDefault) {
  const Eigen::Vector3d point(1.0, 2.0, 3.0);
  EXPECT_EQ(Rigid3() * point, point);
}

TEST(Rigid3, RotatesThenTranslates) {
  const Rigid3 transform(Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitZ())),
                         Eigen::Vector3d(10.0, 0.0, 0.0));
  EXPECT_LT((transform * Eigen::Vector3d(1.0, 0.0, 5.0) - Eigen::Vector3d(10.0, 1.0, 5.0)).norm(),
            1e-15);
}

TEST(Rigid3, MultipliesLikeMatrices) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Rigid3 c_from_b = AnyRigid3(random);
    const Rigid3 b_from_a = AnyRigid3(random);
    const Rigid3 c_from_a = c_from_b * b_from_a;
    ASSERT_LT((MatrixOf(c_from_a) - MatrixOf(c_from_b) * MatrixOf(b_from_a)).norm(), 1e-13);
    const Eigen::Vector3d point = AnyVector(random);
    ASSERT_LT((c_from_a * point - c_from_b * (b_from_a * point)).norm(), 1e-13);
  }
}

TEST(Rigid3, InverseUndoesOnBothSides) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Rigid3 transform = AnyRigid3(random);
    const Eigen::Vector3d point = AnyVector(random);
    ASSERT_LT((transform.Inverse() * (transform * point) - point).norm(), 1e-13);
    ASSERT_LT((transform * (transform.Inverse() * point) - point).norm(), 1e-13);
    ASSERT_LT((MatrixOf(transform.Inverse()) - MatrixOf(transform).inverse()).norm(), 1e-12);
  }
}

TEST(Rigid3, KeepsDistancesThroughLongProducts) {
  Random random(3);
  Rigid3 product;
  for (int i = 0; i < 10'000; ++i) product = AnyRigid3(random) * product;
  EXPECT_NEAR(product.rotation().norm(), 1.0, 1e-15);
  const Eigen::Vector3d first = AnyVector(random);
  const Eigen::Vector3d second = AnyVector(random);
  EXPECT_NEAR((product * first - product * second).norm(), (first - second).norm(), 1e-9);
}

}  // namespace
}  // namespace lodemark
