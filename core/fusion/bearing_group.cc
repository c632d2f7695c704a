#include "core/fusion/bearing_group.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "core/geo/rotation.h"

namespace lodemark {
namespace {

// An attitude that nothing is known of: no better than half a turn.
constexpr double kAnyAttitude_rad = kPi;

// Median length of a normal vector of two dimensions, in sigmas.
constexpr double kMedianLength = 1.17741;

// Times what is expected, beyond which the median says that the position is off: noise alone hardly
// ever makes it so large.
constexpr double kSurelyOff = 2.0;

// Scale of the noise that is not noise any more.
constexpr double kStillOff = 1.5;

// Steps of attitude and shift at a fixed position, and those below which they end.
constexpr int kMostTurns = 8;
constexpr double kNoTurn_rad = 1e-7;
constexpr double kNoShift_m = 1e-5;

// Below this the point is behind the camera or beside it.
constexpr double kLeastForward = 0.05;

}  // namespace

void BearingGroup::Set(std::span<const BearingObservation> bearings, const AttitudePriors& priors,
                       const Eigen::Quaterniond& camera_from_ecef, const BearingOptions& options) {
  bearings_.assign(bearings.begin(), bearings.end());
  linear_.resize(bearings_.size());
  verdicts_.assign(bearings_.size(), BearingVerdict());
  priors_ = priors;
  options_ = options;
  camera_from_ecef_ = camera_from_ecef.normalized();
  shift_m_.setZero();
  sigma_factor_ = 1.0;
}

// A landmark in camera axes q, seen in direction b: to first order its deviation from b, in the
// plane that touches the unit sphere there, is q / (b . q) - b, and the whitener W removes b.
void BearingGroup::Linearise(const Eigen::Vector3d& camera_in_ecef) {
  const Eigen::Matrix3d camera_from_enu =
      camera_from_ecef_.toRotationMatrix() * enu_from_ecef_.transpose();
  for (std::size_t i = 0; i < bearings_.size(); ++i) {
    const BearingObservation& bearing = bearings_[i];
    LinearBearing& linear = linear_[i];
    const Eigen::Vector3d ray = enu_from_ecef_ * (bearing.point_in_ecef - camera_in_ecef);
    const Eigen::Vector3d q = camera_from_enu * ray;
    const double along_m = bearing.direction_in_camera.dot(q);
    linear.seen = along_m > kLeastForward * q.norm();
    if (!linear.seen) continue;
    const Eigen::Vector2d deviation = bearing.whitener * q / along_m;
    const Eigen::Matrix<double, 2, 3> by_q =
        (bearing.whitener - deviation * bearing.direction_in_camera.transpose()) / along_m;
    const Eigen::Matrix<double, 2, 3> by_point = by_q * camera_from_enu;
    linear.slope.leftCols<3>() = -by_point;
    linear.slope.rightCols<3>() = by_point * CrossOf(ray);
    linear.residual = -deviation;
    // The landmark's own error makes the bearing less sure.
    Eigen::Matrix2d covariance = by_point * bearing.point_covariance_enu_m2 * by_point.transpose();
    covariance.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::Matrix2d> factor(covariance);
    factor.matrixL().solveInPlace(linear.slope);
    factor.matrixL().solveInPlace(linear.residual);
    linear.slope /= sigma_factor_;
    linear.residual /= sigma_factor_;
  }
}

// Where the position is off, all bearings are: what more than half of them share is taken for
// noise.
void BearingGroup::Weigh() {
  sizes_.clear();
  for (const LinearBearing& linear : linear_) {
    if (linear.seen) sizes_.push_back(linear.residual.norm());
  }
  scale_ = 1.0;
  if (!sizes_.empty()) {
    const auto middle = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
    std::nth_element(sizes_.begin(), middle, sizes_.end());
    scale_ = std::max(1.0, *middle / (kSurelyOff * kMedianLength));
  }
  const double wrong = options_.wrong_probability / options_.wrong_area;
  for (std::size_t i = 0; i < bearings_.size(); ++i) {
    BearingVerdict& verdict = verdicts_[i];
    verdict = BearingVerdict();
    if (!linear_[i].seen) continue;
    verdict.residual = linear_[i].residual;
    const double variance = scale_ * scale_;
    const double right = (1.0 - options_.wrong_probability) / (2.0 * kPi * variance) *
                         std::exp(-0.5 * linear_[i].residual.squaredNorm() / variance);
    verdict.weight = right / (right + wrong);
  }
}

BearingGroup::Normals BearingGroup::Sum() const {
  Normals normals;
  for (std::size_t i = 0; i < bearings_.size(); ++i) {
    const double weight = verdicts_[i].weight / (scale_ * scale_);
    if (!(weight > 0.0)) continue;
    const LinearBearing& linear = linear_[i];
    normals.information.noalias() += weight * linear.slope.transpose() * linear.slope;
    normals.right.noalias() += weight * linear.slope.transpose() * linear.residual;
  }
  AddPriors(&normals);
  return normals;
}

void BearingGroup::AddPriors(Normals* normals) const {
  auto information = normals->information.bottomRightCorner<3, 3>();
  auto right = normals->right.tail<3>();
  information.diagonal().array() += 1.0 / (kAnyAttitude_rad * kAnyAttitude_rad);
  const Eigen::Matrix3d camera_from_enu =
      camera_from_ecef_.toRotationMatrix() * enu_from_ecef_.transpose();
  if (priors_.gravity) {
    const double weight = 1.0 / (priors_.gravity->sigma_rad * priors_.gravity->sigma_rad);
    const Eigen::Matrix3d slope = camera_from_enu * CrossOf(Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d residual = priors_.gravity->up_in_camera - camera_from_enu.col(2);
    information += weight * slope.transpose() * slope;
    right += weight * slope.transpose() * residual;
  }
  if (priors_.heading) {
    // The optical axis, and how its heading changes as the camera turns.
    const Eigen::Vector3d axis = camera_from_enu.row(2).transpose();
    const double level = axis.head<2>().squaredNorm();
    if (level < 1e-4) return;  // looks straight up or down: no heading
    const double weight = 1.0 / (priors_.heading->sigma_rad * priors_.heading->sigma_rad);
    const Eigen::Vector3d slope(axis.x() * axis.z() / level, axis.y() * axis.z() / level, -1.0);
    const double residual =
        std::remainder(priors_.heading->heading_rad - std::atan2(axis.x(), axis.y()), 2.0 * kPi);
    information += weight * slope * slope.transpose();
    right += weight * slope * residual;
  }
}

// Schur's complement of the attitude.
BearingGroup::Reduced BearingGroup::WithoutAttitude(const Normals& normals) {
  const Eigen::LLT<Eigen::Matrix3d> attitude(normals.information.bottomRightCorner<3, 3>());
  const Eigen::Matrix3d cross = normals.information.topRightCorner<3, 3>();
  Reduced reduced;
  reduced.information = normals.information.topLeftCorner<3, 3>() -
                        cross * attitude.solve(Eigen::Matrix3d(cross.transpose()));
  reduced.pull =
      normals.right.head<3>() - cross * attitude.solve(Eigen::Vector3d(normals.right.tail<3>()));
  return reduced;
}

// The bearings speak of a camera that stands off the point by the common shift s, known to be zero
// within M. Eliminated as the attitude is: with S and g the bearings' information and pull there,
// (I + S M)^-1 S about the point, and (I + S M)^-1 (g + S s).
PositionStatement BearingGroup::Stated(const Reduced& reduced) const {
  const PositionStatement at_point = {around_in_ecef_, reduced.information,
                                      reduced.pull + reduced.information * shift_m_};
  return at_point.WithCommonError(options_.common_covariance_enu_m2);
}

// Attitude and common shift are put where they fit the point best.
PositionStatement BearingGroup::At(const Eigen::Vector3d& point_in_ecef) {
  around_in_ecef_ = point_in_ecef;
  enu_from_ecef_ = EnuFromEcefRotation(GeodeticFromEcef(point_in_ecef));
  const Eigen::Matrix3d& common_m2 = options_.common_covariance_enu_m2;
  Reduced reduced;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    Linearise(point_in_ecef + enu_from_ecef_.transpose() * shift_m_);
    Weigh();
    normals_ = Sum();
    reduced = WithoutAttitude(normals_);
    // Least of the bearings' cost and of the shift's own.
    const Eigen::Vector3d shift_step =
        (Eigen::Matrix3d::Identity() + common_m2 * reduced.information).inverse() *
        (common_m2 * reduced.pull - shift_m_);
    const Eigen::LLT<Eigen::Matrix3d> attitude(normals_.information.bottomRightCorner<3, 3>());
    const Eigen::Vector3d step = attitude.solve(Eigen::Vector3d(
        normals_.right.tail<3>() - normals_.information.bottomLeftCorner<3, 3>() * shift_step));
    if (turn + 1 == kMostTurns || (step.norm() < kNoTurn_rad && shift_step.norm() < kNoShift_m)) {
      break;
    }
    shift_m_ += shift_step;
    // enu_from_camera = exp(step) * estimate, hence camera_from_ecef by the inverse on the right.
    const Eigen::Vector3d turn_in_ecef = enu_from_ecef_.transpose() * step;
    camera_from_ecef_ = (camera_from_ecef_ * Turn(-turn_in_ecef)).normalized();
  }
  return Stated(reduced);
}

// More than half of the bearings with their own noise, not with what all are off by.
bool BearingGroup::Agrees() const {
  std::size_t agreeing = 0;
  for (const BearingVerdict& verdict : verdicts_) agreeing += verdict.weight > 0.5 ? 1 : 0;
  return scale_ < kStillOff && 2 * agreeing > verdicts_.size();
}

void BearingGroup::TakeOut(std::size_t part, Normals* normals) const {
  const double weight = verdicts_[part].weight / (scale_ * scale_);
  if (!(weight > 0.0)) return;
  const LinearBearing& linear = linear_[part];
  normals->information.noalias() -= weight * linear.slope.transpose() * linear.slope;
  normals->right.noalias() -= weight * linear.slope.transpose() * linear.residual;
}

PositionStatement BearingGroup::Without(std::size_t part) const {
  Normals normals = normals_;
  TakeOut(part, &normals);
  return Stated(WithoutAttitude(normals));
}

PositionStatement BearingGroup::WithoutBoth(std::size_t part, std::size_t other) const {
  Normals normals = normals_;
  TakeOut(part, &normals);
  TakeOut(other, &normals);
  return Stated(WithoutAttitude(normals));
}

// Of every bearing two residuals, less what position and attitude take of them.
GroupMisfit BearingGroup::MisfitBeside(const Eigen::Matrix3d& information_pm2) const {
  Eigen::Matrix<double, 6, 6> information = normals_.information;
  const PositionStatement beside = {around_in_ecef_, information_pm2, Eigen::Vector3d::Zero()};
  information.topLeftCorner<3, 3>() +=
      beside.WithCommonError(options_.common_covariance_enu_m2).information_pm2;
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(information);
  if (factor.info() != Eigen::Success) return {};
  GroupMisfit misfit;
  for (std::size_t i = 0; i < bearings_.size(); ++i) {
    const double weight = verdicts_[i].weight;
    if (!(weight > 0.0)) continue;
    const LinearBearing& linear = linear_[i];
    const Eigen::Matrix<double, 6, 2> gain =
        factor.solve(Eigen::Matrix<double, 6, 2>(linear.slope.transpose()));
    misfit.squares += weight * linear.residual.squaredNorm();
    misfit.redundancy += weight * (2.0 - weight * (linear.slope * gain).trace());
  }
  return misfit;
}

// Law of total covariance: the attitude's at a fixed position, and what the position's adds.
Eigen::Matrix3d BearingGroup::AttitudeCovariance(
    const Eigen::Matrix3d& position_covariance_enu_m2) const {
  const Eigen::Matrix3d at_position = normals_.information.bottomRightCorner<3, 3>().inverse();
  const Eigen::Matrix3d by_position = at_position * normals_.information.bottomLeftCorner<3, 3>();
  return at_position + by_position * position_covariance_enu_m2 * by_position.transpose();
}

}  // namespace lodemark
