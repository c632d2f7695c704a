#include "core/fusion/visual_range_group.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

// Landmarks about the scene, seen from a resected centre that is off by an offset.
struct Resected {
  Resected(const RangeScene& scene, const Eigen::Vector3d& offset) {
    for (const Eigen::Vector3d& landmark :
         {Eigen::Vector3d(-20.0, 60.0, 3.0), Eigen::Vector3d(15.0, 55.0, 12.0),
          Eigen::Vector3d(40.0, 20.0, 0.5), Eigen::Vector3d(-8.0, 80.0, 20.0),
          Eigen::Vector3d(2.0, 48.0, 6.0)}) {
      points_in_ecef.push_back(scene.Beside(landmark));
      ranges_m.push_back((landmark - offset).norm());
      directions.push_back((landmark - offset).normalized());
    }
  }
  std::vector<Eigen::Vector3d> points_in_ecef;
  std::vector<double> ranges_m;
  std::vector<Eigen::Vector3d> directions;
};

// Ranges of one pose to exact landmarks say together what the centre says, no more: the reason why
// the diagonal of their covariance alone promises too much.
TEST(VisualRangeGroup, SaysWhatTheCentreSays) {
  const RangeScene scene;
  const Eigen::Vector3d offset(0.4, -0.7, 0.2);
  const Resected seen(scene, offset);
  Eigen::Matrix3d of_centre;
  of_centre << 0.5, 0.1, -0.05, 0.1, 1.2, 0.2, -0.05, 0.2, 0.3;
  Eigen::MatrixXd covariance(5, 5);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      covariance(i, j) = seen.directions[static_cast<std::size_t>(i)].dot(
          of_centre * seen.directions[static_cast<std::size_t>(j)]);
    }
  }
  VisualRangeGroup group;
  group.Set(seen.points_in_ecef, seen.ranges_m, covariance);
  const PositionStatement statement = group.At(scene.Beside(offset));
  EXPECT_TRUE(statement.information_pm2.inverse().isApprox(of_centre, 1e-4));
  EXPECT_LT(statement.pull_pm.norm(), 1e-3);

  // The same landmarks ten times over tell nothing new; taken for independent, they promise it.
  std::vector<Eigen::Vector3d> points;
  std::vector<double> ranges;
  for (int i = 0; i < 50; ++i) {
    points.push_back(seen.points_in_ecef[static_cast<std::size_t>(i % 5)]);
    ranges.push_back(seen.ranges_m[static_cast<std::size_t>(i % 5)]);
  }
  const Eigen::MatrixXd many = covariance.replicate(10, 10);
  group.Set(points, ranges, many);
  EXPECT_TRUE(group.At(scene.Beside(offset)).information_pm2.inverse().isApprox(of_centre, 1e-3));
  group.Set(points, ranges, many.diagonal().asDiagonal());
  EXPECT_GT(group.At(scene.Beside(offset)).information_pm2(1, 1),
            5.0 * statement.information_pm2(1, 1));
}

TEST(VisualRangeGroup, LeadsToTheCentreFromTenMetresAway) {
  const RangeScene scene;
  const Eigen::Vector3d offset(0.4, -0.7, 0.2);
  const Resected seen(scene, offset);
  VisualRangeGroup group;
  group.Set(seen.points_in_ecef, seen.ranges_m, 0.25 * Eigen::MatrixXd::Identity(5, 5));
  Eigen::Vector3d place(6.0, -7.0, 4.0);
  for (int i = 0; i < 20; ++i) {
    const PositionStatement statement = group.At(scene.Beside(place));
    place += statement.information_pm2.ldlt().solve(statement.pull_pm);
  }
  EXPECT_LT((place - offset).norm(), 1e-6);
}

TEST(VisualRangeGroup, OfNoRangesSaysNothing) {
  const RangeScene scene;
  VisualRangeGroup group;
  group.Set({}, {}, Eigen::MatrixXd(0, 0));
  EXPECT_EQ(group.At(scene.truth_in_ecef).Rank(1e3), 0);
}

}  // namespace
}  // namespace lodemark
