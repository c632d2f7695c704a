#include "core/fusion/visual_range_group.h"

#include <Eigen/Eigenvalues>

#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// Ranges from one pose to exact landmarks have a covariance of rank three: the other combinations
// hold by geometry, but only at the pose itself. Variances so small beside the largest are those.
constexpr double kExact = 1e-6;

}  // namespace

void VisualRangeGroup::Set(std::span<const Eigen::Vector3d> points_in_ecef,
                           std::span<const double> ranges_m, const Eigen::MatrixXd& covariance_m2) {
  points_in_ecef_.assign(points_in_ecef.begin(), points_in_ecef.end());
  ranges_m_.assign(ranges_m.begin(), ranges_m.end());
  if (covariance_m2.rows() == 0) {
    whitener_.resize(0, 0);
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance_m2);
  const double least_m2 = kExact * axes.eigenvalues().maxCoeff();
  const auto exact = static_cast<Eigen::Index>((axes.eigenvalues().array() <= least_m2).count());
  const Eigen::Index kept = covariance_m2.rows() - exact;  // eigenvalues ascend
  whitener_ = axes.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse().asDiagonal() *
              axes.eigenvectors().rightCols(kept).transpose();
}

PositionStatement VisualRangeGroup::At(const Eigen::Vector3d& point_in_ecef) {
  PositionStatement statement;
  statement.around_in_ecef = point_in_ecef;
  const auto count = static_cast<Eigen::Index>(points_in_ecef_.size());
  if (whitener_.rows() == 0) return statement;
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(GeodeticFromEcef(point_in_ecef));
  Eigen::MatrixX3d slope(count, 3);
  Eigen::VectorXd misclosure(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d line = points_in_ecef_[k] - point_in_ecef;
    const double distance_m = line.norm();
    slope.row(i) = -(enu_from_ecef * line / distance_m).transpose();
    misclosure[i] = ranges_m_[k] - distance_m;
  }
  const Eigen::MatrixX3d whitened = whitener_ * slope;
  statement.information_pm2 = whitened.transpose() * whitened;
  statement.pull_pm = whitened.transpose() * (whitener_ * misclosure);
  return statement;
}

}  // namespace lodemark
