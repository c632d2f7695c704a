#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "core/resection/minimal_solvers.h"
#include "test/unit/resection/random_scenes.h"

namespace lodemark {
namespace {

constexpr std::size_t kScenes = 1'000;

// Points of a tilted plane, in camera axes as columns, and the camera.
struct PlaneScene {
  Rigid3 camera_from_world;
  Eigen::Matrix3Xd bearings;
  Eigen::Matrix3Xd points_in_world;

  double ErrorOf(const Rigid3& pose) const {
    double error_m = 0.0;
    double furthest_m = 0.0;
    for (Eigen::Index i = 0; i < points_in_world.cols(); ++i) {
      const Eigen::Vector3d truth = camera_from_world * points_in_world.col(i);
      error_m = std::max(error_m, (pose * points_in_world.col(i) - truth).norm());
      furthest_m = std::max(furthest_m, truth.norm());
    }
    return error_m / furthest_m;
  }
  double BearingErrorOf(const Rigid3& pose) const {
    double squares = 0.0;
    for (Eigen::Index i = 0; i < points_in_world.cols(); ++i) {
      squares += ((pose * points_in_world.col(i)).normalized() - bearings.col(i)).squaredNorm();
    }
    return std::sqrt(squares);
  }
};

// count points of a square of some size_m, its middle some distance_m off, tilted up to 70 degrees,
// anywhere around the camera or in front of it.
PlaneScene RandomPlane(int count, double size_m, double distance_m, bool is_in_front,
                       double spread_m, Random& random) {
  PlaneScene scene;
  const Eigen::Vector3d middle =
      distance_m * (is_in_front ? Eigen::Vector3d::UnitZ() : RandomVector(random).normalized());
  const Eigen::Vector3d tilt_axis = middle.unitOrthogonal();
  const Eigen::Quaterniond plane(Eigen::AngleAxisd(random.Uniform(0.0, 6.28), middle.normalized()) *
                                 Eigen::AngleAxisd(random.Uniform(0.1, 1.2), tilt_axis));
  const Eigen::Vector3d right = tilt_axis;
  const Eigen::Vector3d down = middle.normalized().cross(right);
  const Eigen::Quaterniond rotation = RandomRotation(random);
  const Eigen::Vector3d centre = spread_m * RandomVector(random);
  scene.camera_from_world = {rotation, -(rotation * centre)};
  scene.bearings.resize(3, count);
  scene.points_in_world.resize(3, count);
  const double corners[4][2] = {{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}};
  for (int i = 0; i < count; ++i) {
    // One in each quarter first, so that no three are near one line.
    const double x = 0.5 * size_m * corners[i % 4][0] * random.Uniform(0.4, 1.0);
    const double y = 0.5 * size_m * corners[i % 4][1] * random.Uniform(0.4, 1.0);
    const Eigen::Vector3d in_camera = middle + plane * (x * right + y * down);
    scene.points_in_world.col(i) = rotation.conjugate() * in_camera + centre;
    scene.bearings.col(i) = (rotation * (scene.points_in_world.col(i) - centre)).normalized();
  }
  return scene;
}

TEST(PoseFromPlane, FindsThePoseFirst) {
  Random random(1);
  for (std::size_t i = 0; i < kScenes; ++i) {
    const PlaneScene scene = RandomPlane(4 + static_cast<int>(i) % 20, 10.0,
                                         random.Uniform(8.0, 40.0), i % 2 == 0, 30.0, random);
    const PoseSet<2> poses = PoseFromPlane(scene.bearings, scene.points_in_world);
    ASSERT_GE(poses.count, 1);
    ASSERT_LT(scene.ErrorOf(poses.camera_from_world[0]), 1e-8) << "scene " << i;
    if (poses.count < 2) continue;
    ASSERT_LE(scene.BearingErrorOf(poses.camera_from_world[0]),
              scene.BearingErrorOf(poses.camera_from_world[1]));
  }
}

TEST(PoseFromPlane, FindsThePoseWhereThePlaneFillsAHalfCircle) {
  Random random(2);
  for (std::size_t i = 0; i < kScenes; ++i) {
    const PlaneScene scene = RandomPlane(8, 60.0, 5.0, true, 30.0, random);
    const PoseSet<2> poses = PoseFromPlane(scene.bearings, scene.points_in_world);
    // Past the horizon of the plane's own front there is nothing to see: skip steep tilts.
    bool is_seen_from_one_side = true;
    const Eigen::Vector3d normal =
        (scene.camera_from_world.rotation() *
         (scene.points_in_world.col(1) - scene.points_in_world.col(0))
             .cross(scene.points_in_world.col(2) - scene.points_in_world.col(0)));
    for (Eigen::Index k = 1; k < 8; ++k) {
      is_seen_from_one_side &=
          normal.dot(scene.bearings.col(k)) * normal.dot(scene.bearings.col(0)) > 0.0;
    }
    ASSERT_TRUE(is_seen_from_one_side);
    ASSERT_GE(poses.count, 1) << "scene " << i;
    ASSERT_LT(scene.ErrorOf(poses.camera_from_world[0]), 1e-8) << "scene " << i;
  }
}

TEST(PoseFromPlane, HoldsFarFromTheOriginAndForASmallPlaneFarAway) {
  Random random(3);
  for (std::size_t i = 0; i < kScenes; ++i) {
    const PlaneScene far_world = RandomPlane(12, 10.0, 20.0, true, 4.0e6, random);
    PoseSet<2> poses = PoseFromPlane(far_world.bearings, far_world.points_in_world);
    ASSERT_GE(poses.count, 1);
    ASSERT_LT(far_world.ErrorOf(poses.camera_from_world[0]), 1e-6);

    // Both poses fit to the last digits but for perspective, so take either.
    const PlaneScene far_plane = RandomPlane(12, 1.0, 1.0e4, true, 0.0, random);
    poses = PoseFromPlane(far_plane.bearings, far_plane.points_in_world);
    double best = std::numeric_limits<double>::infinity();
    for (const Rigid3& pose : poses) best = std::min(best, far_plane.ErrorOf(pose));
    ASSERT_LT(best, 1e-6);
  }
}

TEST(PoseFromPlane, DoesNotDependOnTheOrderOrTheUnit) {
  Random random(4);
  for (std::size_t i = 0; i < kScenes; ++i) {
    PlaneScene scene = RandomPlane(7, 10.0, 15.0, true, 30.0, random);
    const PoseSet<2> poses = PoseFromPlane(scene.bearings, scene.points_in_world);
    scene.bearings = scene.bearings.rowwise().reverse().eval();
    scene.points_in_world = 0x1p+15 * scene.points_in_world.rowwise().reverse().eval();
    const PoseSet<2> again = PoseFromPlane(scene.bearings, scene.points_in_world);
    ASSERT_EQ(again.count, poses.count);
    for (int k = 0; k < poses.count; ++k) {
      const auto index = static_cast<std::size_t>(k);
      const Rigid3& expected = poses.camera_from_world[index];
      scene.camera_from_world = {expected.rotation(), 0x1p+15 * expected.translation()};
      ASSERT_LT(scene.ErrorOf(again.camera_from_world[index]), 1e-6);
    }
  }
}

// The noise here is alike in pixels, as OpenCV has it, and not in angles, as we do: a few percent.
TEST(PoseFromPlane, IsAboutAsExactAsOpenCv) {
  Random random(5);
  std::vector<double> ours;
  std::vector<double> of_theirs;
  for (std::size_t i = 0; i < kScenes; ++i) {
    PlaneScene scene = RandomPlane(12, 10.0, 12.0, true, 3.0, random);
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
    for (Eigen::Index k = 0; k < 12; ++k) {
      Eigen::Vector3d seen = scene.bearings.col(k) / scene.bearings(2, k);
      seen.x() += random.Gaussian(0.0, 5e-4);
      seen.y() += random.Gaussian(0.0, 5e-4);
      scene.bearings.col(k) = seen.normalized();
      const Eigen::Vector3d point = scene.points_in_world.col(k);
      points.emplace_back(point.x(), point.y(), point.z());
      pixels.emplace_back(seen.x(), seen.y());
    }
    cv::Mat rotation;
    cv::Mat translation;
    cv::solvePnP(points, pixels, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation, translation,
                 false, cv::SOLVEPNP_IPPE);
    const Eigen::Vector3d angle_axis(rotation.ptr<double>());
    const Rigid3 theirs(
        Eigen::Quaterniond(Eigen::AngleAxisd(angle_axis.norm(), angle_axis.normalized())),
        Eigen::Vector3d(translation.ptr<double>()));
    const PoseSet<2> poses = PoseFromPlane(scene.bearings, scene.points_in_world);
    ASSERT_GE(poses.count, 1);
    ours.push_back(scene.ErrorOf(poses.camera_from_world[0]));
    of_theirs.push_back(scene.ErrorOf(theirs));
    scene.camera_from_world = theirs;
    ASSERT_LT(scene.ErrorOf(poses.camera_from_world[0]), 0.05) << "scene " << i;
  }
  for (const std::size_t rank : {kScenes / 2, kScenes * 9 / 10}) {
    std::nth_element(ours.begin(), ours.begin() + static_cast<std::ptrdiff_t>(rank), ours.end());
    std::nth_element(of_theirs.begin(), of_theirs.begin() + static_cast<std::ptrdiff_t>(rank),
                     of_theirs.end());
    EXPECT_LT(ours[rank], 1.1 * of_theirs[rank]);
  }
}

TEST(PoseFromPlane, GivesNoneForWhatIsNoPlane) {
  Random random(6);
  const PlaneScene scene = RandomPlane(4, 10.0, 15.0, true, 3.0, random);
  EXPECT_EQ(PoseFromPlane(scene.bearings.leftCols(3), scene.points_in_world.leftCols(3)).count, 0);
  EXPECT_EQ(PoseFromPlane(scene.bearings, scene.points_in_world.leftCols(3)).count, 0);
  EXPECT_EQ(PoseFromPlane({}, {}).count, 0);

  Eigen::Matrix3Xd points = scene.points_in_world;
  points.colwise() = Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_EQ(PoseFromPlane(scene.bearings, points).count, 0) << "one place";
  for (int i = 0; i < 4; ++i) points.col(i) = (1.0 + i) * Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_EQ(PoseFromPlane(scene.bearings, points).count, 0) << "one line";
  Eigen::Matrix3Xd bearings = scene.bearings;
  bearings.colwise() = Eigen::Vector3d(0.0, 0.0, 1.0);
  EXPECT_EQ(PoseFromPlane(bearings, scene.points_in_world).count, 0) << "one bearing";
  points = scene.points_in_world;
  points(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(PoseFromPlane(scene.bearings, points).count, 0);
  bearings = scene.bearings;
  bearings(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(PoseFromPlane(bearings, scene.points_in_world).count, 0);

  // Three of the four on one line, in the picture too: many homographies.
  PlaneScene line = scene;
  const double thirds[3] = {0.0, 0.4, 1.0};
  for (int i = 0; i < 3; ++i) {
    line.points_in_world.col(i) =
        (1.0 - thirds[i]) * scene.points_in_world.col(0) + thirds[i] * scene.points_in_world.col(2);
    line.bearings.col(i) = (line.camera_from_world * line.points_in_world.col(i)).normalized();
  }
  EXPECT_EQ(PoseFromPlane(line.bearings, line.points_in_world).count, 0);
}

}  // namespace
}  // namespace lodemark
