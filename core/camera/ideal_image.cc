#include "core/camera/ideal_image.h"

#include <cmath>

namespace lodemark {
namespace {

// Squares of coordinates between these neither overflow nor lose digits.
constexpr double kLeastSquare = 1e-200;
constexpr double kMostSquare = 1e200;

// Below this square of the tangent the angle's series serves: its next term is 1e-16.
constexpr double kSmallTangentSquare = 1e-4;

std::optional<Eigen::Vector2d> ToEquidistant(const Eigen::Vector3d& point) {
  const double square = point.squaredNorm();
  if (!(square > kLeastSquare && square < kMostSquare)) {
    if (!point.allFinite() || point.isZero(0.0)) return std::nullopt;
    const double size = point.cwiseAbs().maxCoeff();
    return ToEquidistant(point / size);
  }
  const double across = std::sqrt(point.x() * point.x() + point.y() * point.y());
  if (across == 0.0) {
    if (point.z() < 0.0) return std::nullopt;
    return Eigen::Vector2d(point.x() / point.z(), point.y() / point.z());
  }
  return Eigen::Vector2d(point.head<2>() * (std::atan2(across, point.z()) / across));
}

Eigen::Matrix<double, 2, 3> EquidistantByPoint(const Eigen::Vector3d& point,
                                               const Eigen::Vector2d& ideal) {
  const double size = point.cwiseAbs().maxCoeff();
  const double x = point.x() / size;
  const double y = point.y() / size;
  const double z = point.z() / size;
  const double u = x * x + y * y;
  const double distance2 = u + z * z;
  // ideal = w (x, y) with w = angle / across; bend is the derivative of w by across, over across.
  double w = 0.0;
  double bend = 0.0;
  const double e = u / (z * z);
  if (z > 0.0 && e < kSmallTangentSquare) {
    w = (1.0 - e * (1.0 / 3.0 - e * (1.0 / 5.0 - e / 7.0))) / z;
    bend = (-2.0 / 3.0 + e * (4.0 / 5.0 - e * (6.0 / 7.0))) / (z * z * z);
  } else {
    w = ideal.norm() / std::sqrt(u);
    bend = (z / distance2 - w) / u;
  }
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << w + bend * x * x, bend * x * y, -x / distance2,  //
      bend * x * y, w + bend * y * y, -y / distance2;
  return by_point / size;
}

}  // namespace

std::optional<Eigen::Vector2d> ToIdeal(IdealImage ideal_image, const Eigen::Vector3d& point) {
  if (ideal_image == IdealImage::kEquidistant) return ToEquidistant(point);
  if (!(point.z() > 0.0) || !std::isfinite(point.z())) return std::nullopt;
  return Eigen::Vector2d(point.x() / point.z(), point.y() / point.z());
}

Eigen::Matrix<double, 2, 3> IdealByPoint(IdealImage ideal_image, const Eigen::Vector3d& point,
                                         const Eigen::Vector2d& ideal) {
  if (ideal_image == IdealImage::kEquidistant) return EquidistantByPoint(point, ideal);
  const double per_z = 1.0 / point.z();
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << per_z, 0.0, -ideal.x() * per_z, 0.0, per_z, -ideal.y() * per_z;
  return by_point;
}

Eigen::Vector3d FromIdeal(IdealImage ideal_image, const Eigen::Vector2d& ideal) {
  const double u = ideal.squaredNorm();
  if (ideal_image == IdealImage::kPlane) {
    const double scale = 1.0 / std::sqrt(1.0 + u);
    return {ideal.x() * scale, ideal.y() * scale, scale};
  }
  const double angle = std::sqrt(u);
  // Where the square underflows, the sine is the angle.
  const double scale = angle > 0.0 ? std::sin(angle) / angle : 1.0;
  return {ideal.x() * scale, ideal.y() * scale, std::cos(angle)};
}

}  // namespace lodemark
