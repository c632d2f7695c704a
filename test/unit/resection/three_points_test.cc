#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "core/resection/minimal_solvers.h"
#include "test/unit/resection/random_scenes.h"

namespace lodemark {
namespace {

constexpr int kScenes = 5'000;

template <typename MakePoint>
std::array<Eigen::Vector3d, 3> ThreeOf(MakePoint make, Random& random) {
  std::array<Eigen::Vector3d, 3> points;
  for (Eigen::Vector3d& point : points) point = make(random);
  return points;
}

PoseSet<4> Solve(const Scene<3>& scene) {
  return PoseFromThreePoints(scene.bearings, scene.points_in_world);
}

TEST(PoseFromThreePoints, FindsThePoseOfEveryOrdinaryScene) {
  Random random(1);
  for (int i = 0; i < 20 * kScenes; ++i) {
    const Scene<3> scene = SceneOf(ThreeOf(PointInFront, random), 30.0, random);
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-8) << "scene " << i;
  }
}

TEST(PoseFromThreePoints, FindsThePoseWherePointsLieAllRoundTheCamera) {
  Random random(2);
  for (int i = 0; i < 20 * kScenes; ++i) {
    const Scene<3> scene = SceneOf(ThreeOf(PointAround, random), 30.0, random);
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-8) << "scene " << i;
  }
}

TEST(PoseFromThreePoints, GivesOnlyPosesThatPutThePointsOnTheirBearings) {
  Random random(3);
  for (int i = 0; i < kScenes; ++i) {
    const Scene<3> scene = SceneOf(ThreeOf(PointAround, random), 30.0, random);
    for (const Rigid3& pose : Solve(scene)) ASSERT_LT(scene.BearingErrorOf(pose), 1e-8);
  }
}

TEST(PoseFromThreePoints, HoldsAtTheEarthsRadiusFromTheOrigin) {
  Random random(4);
  for (int i = 0; i < kScenes; ++i) {
    const Scene<3> scene = SceneOf(ThreeOf(PointInFront, random), 4.0e6, random);
    // Coordinates are rounded to a nanometre there; a near triangle makes the most of it.
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-5) << "scene " << i;
  }
}

TEST(PoseFromThreePoints, HoldsForATriangleThatIsASpeckFarAway) {
  Random random(5);
  for (int i = 0; i < kScenes; ++i) {
    std::array<Eigen::Vector3d, 3> points = ThreeOf(RandomVector, random);
    for (Eigen::Vector3d& point : points) point.z() += 1.0e5;
    const Scene<3> scene = SceneOf(points, 0.0, random);
    // A metre at 1e5 m: the bearings' own rounding is 1e-11 of the triangle.
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-6) << "scene " << i;
  }
}

TEST(PoseFromThreePoints, HoldsWherePointsAreAllButOnOneLine) {
  Random random(6);
  for (int i = 0; i < kScenes; ++i) {
    std::array<Eigen::Vector3d, 3> points;
    for (std::size_t k = 0; k < 3; ++k) {
      points[k] = Eigen::Vector3d(0.0, 0.0, 20.0) +
                  (static_cast<double>(k) - random.Uniform()) * Eigen::Vector3d(1.0, 2.0, -1.0) +
                  1e-5 * RandomVector(random);
    }
    const Scene<3> scene = SceneOf(points, 1.0, random);
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-6) << "scene " << i;
  }
}

TEST(PoseFromThreePoints, HoldsWhereTwoPointsAllButCoincide) {
  Random random(7);
  for (int i = 0; i < kScenes; ++i) {
    std::array<Eigen::Vector3d, 3> points = ThreeOf(PointInFront, random);
    points[1] = points[0] + 1e-3 * RandomVector(random);
    const Scene<3> scene = SceneOf(points, 1.0, random);
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-4) << "scene " << i;
  }
}

TEST(PoseFromThreePoints, GivesAllFourPosesAboveAnEquilateralTriangle) {
  for (double height = 1.8; height < 30.0; height *= 1.001) {
    Scene<3> scene;
    for (std::size_t k = 0; k < 3; ++k) {
      const double azimuth_rad = 2.0 * std::numbers::pi * static_cast<double>(k) / 3.0;
      scene.points_in_world[k] = {std::cos(azimuth_rad), std::sin(azimuth_rad), height};
      scene.bearings[k] = scene.points_in_world[k].normalized();
    }
    const PoseSet<4> poses = Solve(scene);
    EXPECT_EQ(poses.count, 4) << "height " << height;
    EXPECT_LT(scene.BestErrorOf(poses), 1e-8) << "height " << height;
  }
}

// On the cylinder through the triangle's corners, two poses become one.
TEST(PoseFromThreePoints, FindsTheDoublePoseOfTheDangerousCylinder) {
  Random random(8);
  int missed = 0;
  for (int i = 0; i < kScenes; ++i) {
    std::array<Eigen::Vector3d, 3> points;
    const double azimuth_rad = random.Uniform(0.0, 2.0 * std::numbers::pi);
    const Eigen::Vector3d camera(std::cos(azimuth_rad), std::sin(azimuth_rad),
                                 random.Uniform(0.5, 8.0));
    for (Eigen::Vector3d& point : points) {
      const double corner_rad = random.Uniform(0.0, 2.0 * std::numbers::pi);
      point = Eigen::Vector3d(std::cos(corner_rad), std::sin(corner_rad), 0.0) - camera;
    }
    const Scene<3> scene = SceneOf(points, 1.0, random);
    // A double solution keeps half the digits; the worst triangles, fewer.
    if (!(scene.BestErrorOf(Solve(scene)) < 1e-4)) ++missed;
  }
  EXPECT_LE(missed, kScenes / 500);
}

TEST(PoseFromThreePoints, DoesNotDependOnTheOrderOfThePoints) {
  Random random(9);
  for (int i = 0; i < kScenes; ++i) {
    const Scene<3> scene = SceneOf(ThreeOf(PointInFront, random), 30.0, random);
    const PoseSet<4> poses = Solve(scene);
    for (const auto& order : {std::array<std::size_t, 3>{1, 2, 0}, {2, 0, 1}, {1, 0, 2}}) {
      Scene<3> permuted = scene;
      for (std::size_t k = 0; k < 3; ++k) {
        permuted.bearings[k] = scene.bearings[order[k]];
        permuted.points_in_world[k] = scene.points_in_world[order[k]];
      }
      const PoseSet<4> again = Solve(permuted);
      ASSERT_EQ(again.count, poses.count);
      for (const Rigid3& pose : poses) {
        permuted.camera_from_world = pose;
        ASSERT_LT(permuted.BestErrorOf(again), 1e-6);
      }
    }
  }
}

TEST(PoseFromThreePoints, DoesNotDependOnTheUnitOfLength) {
  Random random(10);
  for (int i = 0; i < kScenes; ++i) {
    const Scene<3> scene = SceneOf(ThreeOf(PointInFront, random), 30.0, random);
    const PoseSet<4> poses = Solve(scene);
    for (const double unit : {0x1p-30, 0x1p+30}) {
      Scene<3> scaled = scene;
      for (Eigen::Vector3d& point : scaled.points_in_world) point *= unit;
      const PoseSet<4> again = Solve(scaled);
      ASSERT_EQ(again.count, poses.count);
      for (int k = 0; k < poses.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        const Rigid3& expected = poses.camera_from_world[index];
        scaled.camera_from_world = {expected.rotation(), unit * expected.translation()};
        ASSERT_LT(scaled.ErrorOf(again.camera_from_world[index]), 1e-12);
      }
    }
  }
}

TEST(PoseFromThreePoints, AgreesWithOpenCv) {
  Random random(11);
  int compared = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Scene<3> scene = SceneOf(ThreeOf(PointInFront, random), 3.0, random);
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& point = scene.points_in_world[k];
      points.emplace_back(point.x(), point.y(), point.z());
      pixels.emplace_back(scene.bearings[k].x() / scene.bearings[k].z(),
                          scene.bearings[k].y() / scene.bearings[k].z());
    }
    std::vector<cv::Mat> rotations;
    std::vector<cv::Mat> translations;
    cv::solveP3P(points, pixels, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, translations,
                 cv::SOLVEPNP_AP3P);
    const PoseSet<4> poses = Solve(scene);
    for (std::size_t k = 0; k < rotations.size(); ++k) {
      const Eigen::Vector3d angle_axis(rotations[k].ptr<double>());
      if (!angle_axis.allFinite() || angle_axis.norm() == 0.0) continue;
      Scene<3> theirs = scene;
      theirs.camera_from_world = {
          Eigen::Quaterniond(Eigen::AngleAxisd(angle_axis.norm(), angle_axis.normalized())),
          Eigen::Vector3d(translations[k].ptr<double>())};
      // Only what is a solution; those behind the camera are none of ours.
      if (theirs.BearingErrorOf(theirs.camera_from_world) > 1e-9) continue;
      ASSERT_LT(theirs.BestErrorOf(poses), 1e-4) << "scene " << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, kScenes);
}

TEST(PoseFromThreePoints, GivesNoneForAScaleOfNothing) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::nan(""));
  const Eigen::Vector3d beyond = Eigen::Vector3d::Constant(1e300);
  // On a line, in one place, two in one place; bearings alike; no numbers.
  EXPECT_EQ(PoseFromThreePoints({x, y, z}, {x, 2.0 * x, 5.0 * x}).count, 0);
  EXPECT_EQ(PoseFromThreePoints({x, y, z}, {x, x, x}).count, 0);
  EXPECT_EQ(PoseFromThreePoints({x, y, z}, {x, x, y}).count, 0);
  EXPECT_EQ(PoseFromThreePoints({z, z, x}, {x, y, z}).count, 0);
  EXPECT_EQ(PoseFromThreePoints({z, z, z}, {x, y, z}).count, 0);
  EXPECT_EQ(PoseFromThreePoints({nowhere, y, z}, {x, y, z}).count, 0);
  EXPECT_EQ(PoseFromThreePoints({x, y, z}, {x, nowhere, z}).count, 0);
  for (const Rigid3& pose : PoseFromThreePoints({x, y, z}, {beyond, y, z})) {
    EXPECT_TRUE(pose.translation().allFinite() && pose.rotation().coeffs().allFinite());
  }
}

TEST(PoseFromThreePoints, GivesNoneOnALineFarFromTheOrigin) {
  Random random(12);
  for (int i = 0; i < kScenes; ++i) {
    const Eigen::Vector3d direction = RandomVector(random);
    const Eigen::Vector3d start = 6.4e6 * RandomVector(random).normalized();
    const auto bearings = ThreeOf(RandomVector, random);
    const PoseSet<4> poses = PoseFromThreePoints(
        {bearings[0].normalized(), bearings[1].normalized(), bearings[2].normalized()},
        {start, start + 3.0 * direction, start + 7.0 * direction});
    EXPECT_EQ(poses.count, 0);
  }
}

}  // namespace
}  // namespace lodemark
