#include "core/resection/pose_scoring.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/resection/collinearity.h"

namespace lodemark {
namespace {

constexpr std::size_t kBlock = SightTable::kBlock;
constexpr int kSteps = 4;

// Rotation by rows, then translation.
using FlatPose = std::array<float, 12>;

FlatPose Flattened(const Rigid3& pose) {
  const Eigen::Matrix3d rotation = pose.rotation().toRotationMatrix();
  FlatPose flat;
  for (std::size_t k = 0; k < 9; ++k) {
    flat[k] = static_cast<float>(
        rotation(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3)));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    flat[9 + k] = static_cast<float>(pose.translation()[static_cast<Eigen::Index>(k)]);
  }
  return flat;
}

using Block = Eigen::Array<float, static_cast<int>(kBlock), 1>;

// Squared misfits of one block, each at most limit, as those behind the camera have it.
inline Block BlockMisfits(const SightTable& table, std::size_t first, const FlatPose& pose,
                          float limit) {
  constexpr float kTiny = 1e-30F;
  const auto column = [&](int which) {
    return Eigen::Map<const Block>(table.column(which) + first);
  };
  const auto dot = [&](int which, const Block& x, const Block& y, const Block& z) {
    const Block product = column(which) * x + column(which + 1) * y + column(which + 2) * z;
    return product;
  };
  const auto in_camera = [&](std::size_t row) {
    const Block coordinate = pose[3 * row] * column(SightTable::kLandmark) +
                             pose[3 * row + 1] * column(SightTable::kLandmark + 1) +
                             pose[3 * row + 2] * column(SightTable::kLandmark + 2) + pose[9 + row];
    return coordinate;
  };
  const Block x = in_camera(0);
  const Block y = in_camera(1);
  const Block z = in_camera(2);
  const Block along = dot(SightTable::kBearing, x, y, z).max(0.0F);
  const Block u = dot(SightTable::kTangentX, x, y, z);
  const Block v = dot(SightTable::kTangentY, x, y, z);
  const Block squares =
      ((u * u + v * v) / (along * along + column(SightTable::kSpread) + kTiny)).min(limit);
  return squares;
}

struct Misfit {
  Eigen::Vector2d value;
  double weight = 1.0;  // one over what the landmark's spread does to its variance
  double square = 0.0;  // weighted
  double along_m = 0.0;
};

Misfit MisfitOf(const SightTable& table, std::size_t row, const Eigen::Vector3d& in_camera) {
  Misfit misfit;
  misfit.along_m = table.bearing(row).dot(in_camera);
  misfit.value = table.tangent(row) * in_camera / misfit.along_m;
  const double squared_m2 = misfit.along_m * misfit.along_m;
  misfit.weight = squared_m2 / (squared_m2 + table.spread_m2(row));
  misfit.square = misfit.weight * misfit.value.squaredNorm();
  return misfit;
}

}  // namespace

SequentialTest::SequentialTest(double good_share, double bad_share) {
  const double good = std::clamp(good_share, 1e-4, 0.95);
  const double bad = std::clamp(bad_share, 1e-5, 0.25 * good);
  per_sight_ = std::log((1.0 - bad) / (1.0 - good));
  per_agreeing_ = per_sight_ + std::log(good / bad);
  limit_ = -std::log(kFalseAlarms);
}

PoseScore ScorePose(const SightTable& table, const Rigid3& camera_from_world, double threshold,
                    const SequentialTest& test, double most_cost) {
  const FlatPose pose = Flattened(camera_from_world);
  const float limit = static_cast<float>(threshold * threshold);
  // The rows that pad the last block agree with nothing.
  const double padding =
      static_cast<double>(limit) * static_cast<double>(table.blocks() * kBlock - table.size());
  PoseScore score;
  for (std::size_t block = 0; block < table.blocks(); ++block) {
    const Block squares = BlockMisfits(table, block * kBlock, pose, limit);
    int agreeing = 0;
    for (std::size_t i = 0; i < kBlock; ++i) {
      agreeing += squares.data()[i] < limit ? 1 : 0;
    }
    score.cost += static_cast<double>(squares.sum());
    score.agreeing += static_cast<std::size_t>(agreeing);
    score.seen = std::min(score.seen + kBlock, table.size());
    if (score.cost > most_cost + padding || test.GivesUp(score.seen, score.agreeing)) return score;
  }
  score.cost -= padding;
  score.is_complete = true;
  return score;
}

Rigid3 ImprovePose(const SightTable& table, const Rigid3& start_camera_from_world,
                   double wide_threshold, double threshold, const ResectionPriors& priors,
                   std::size_t most_sights) {
  CameraPose pose(start_camera_from_world);
  const double information = 9.0 / (threshold * threshold);
  for (int step = 0; step < kSteps; ++step) {
    const double share = std::min(1.0, static_cast<double>(step) / (kSteps - 2));
    const double within = wide_threshold * std::pow(threshold / wide_threshold, share);
    Matrix6d normal = Matrix6d::Zero();
    Vector6d right = Vector6d::Zero();
    std::size_t used = 0;
    for (std::size_t row = 0; row < table.size() && used < most_sights; ++row) {
      const Eigen::Vector3d ray = table.landmark(row) - pose.centre_in_enu_m;
      const Eigen::Vector3d in_camera = pose.matrix * ray;
      const Misfit misfit = MisfitOf(table, row, in_camera);
      if (!(misfit.along_m > 0.0) || !(misfit.square < within * within)) continue;
      ++used;
      // In camera axes: a shift of the landmarks and a turn of them about the camera.
      const Eigen::Matrix<double, 2, 3> by_shift =
          (table.tangent(row) - misfit.value * table.bearing(row).transpose()) / misfit.along_m;
      Eigen::Matrix<double, 2, 6> by_pose;
      by_pose.leftCols<3>() = by_shift;
      for (Eigen::Index k = 0; k < 2; ++k) {
        const Eigen::Vector3d along_row = by_shift.row(k).transpose();
        by_pose.block<1, 3>(k, 3) = in_camera.cross(along_row).transpose();
      }
      normal.noalias() += misfit.weight * by_pose.transpose() * by_pose;
      right.noalias() -= misfit.weight * by_pose.transpose() * misfit.value;
    }
    normal *= information;
    right *= information;
    if (priors.gravity || priors.position) {
      // The same in terms of the centre and a turn in ENU: shift = -R dc, turn = -R dr.
      Matrix6d prior = Matrix6d::Zero();
      Vector6d prior_right = Vector6d::Zero();
      PriorCost(priors, pose, &prior, &prior_right);
      Matrix6d to_camera = Matrix6d::Zero();
      to_camera.topLeftCorner<3, 3>() = -pose.matrix;
      to_camera.bottomRightCorner<3, 3>() = -pose.matrix;
      normal += to_camera * prior * to_camera.transpose();
      right += to_camera * prior_right;
    }
    normal.diagonal() *= 1.0 + 1e-6;
    const Eigen::LDLT<Matrix6d> factor(normal);
    const Vector6d in_camera = factor.solve(right);
    if (factor.info() != Eigen::Success || !in_camera.allFinite()) break;
    Vector6d in_enu;
    in_enu << -(pose.matrix.transpose() * in_camera.head<3>()),
        -(pose.matrix.transpose() * in_camera.tail<3>());
    pose = pose.Moved(in_enu);
  }
  return pose.camera_from_enu();
}

}  // namespace lodemark
