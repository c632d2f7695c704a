#include "core/fusion/visual_range_group.h"

#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// Ranges from one pose to exact landmarks have a covariance of rank three. So much is added to
// every variance, of its mean, that it can be inverted; a hundredth of a permille of a sigma.
constexpr double kRidge = 1e-10;

}  // namespace

void VisualRangeGroup::Set(std::span<const Eigen::Vector3d> points_in_ecef,
                           std::span<const double> ranges_m, const Eigen::MatrixXd& covariance_m2) {
  points_in_ecef_.assign(points_in_ecef.begin(), points_in_ecef.end());
  ranges_m_.assign(ranges_m.begin(), ranges_m.end());
  Eigen::MatrixXd covariance = covariance_m2;
  if (covariance.rows() > 0) {
    covariance.diagonal().array() += kRidge * covariance_m2.diagonal().mean();
  }
  factor_.compute(covariance);
}

PositionStatement VisualRangeGroup::At(const Eigen::Vector3d& point_in_ecef) {
  PositionStatement statement;
  statement.around_in_ecef = point_in_ecef;
  const auto count = static_cast<Eigen::Index>(points_in_ecef_.size());
  if (count == 0 || factor_.info() != Eigen::Success) return statement;
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
  const Eigen::MatrixX3d weighted = factor_.solve(slope);
  statement.information_pm2 = slope.transpose() * weighted;
  statement.pull_pm = weighted.transpose() * misclosure;
  return statement;
}

}  // namespace lodemark
