#include "tools/mapping/similarity3.h"

#include <Eigen/SVD>
#include <cmath>
#include <cstddef>

namespace lodemark {
namespace {

// Of the second extent of the points to the first, below which they count as a line: rounding.
constexpr double kLeastBreadth = 1e-9;

}  // namespace

Rigid3 CameraFromTarget(const Rigid3& camera_from_source, const Similarity3& target_from_source) {
  const Eigen::Quaterniond rotation =
      camera_from_source.rotation() * target_from_source.rotation.conjugate();
  const Eigen::Vector3d centre = target_from_source * camera_from_source.Inverse().translation();
  return {rotation, -(rotation * centre)};
}

std::optional<Similarity3> SimilarityFromPoints(std::span<const Eigen::Vector3d> sources,
                                                std::span<const Eigen::Vector3d> targets,
                                                std::span<const double> weights) {
  if (sources.size() < 3) return std::nullopt;
  double total = 0.0;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  for (std::size_t i = 0; i < sources.size(); ++i) {
    total += weight(i);
    source_mean += weight(i) * sources[i];
    target_mean += weight(i) * targets[i];
  }
  if (!(total > 0.0)) return std::nullopt;
  source_mean /= total;
  target_mean /= total;

  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const Eigen::Vector3d source = sources[i] - source_mean;
    products += weight(i) * (targets[i] - target_mean) * source.transpose();
    spread += weight(i) * source * source.transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> breadth(spread);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d size = svd.singularValues();
  // The spread holds squares.
  const bool line = !(breadth.singularValues()(1) >
                      kLeastBreadth * kLeastBreadth * breadth.singularValues()(0)) ||
                    !(size(1) > kLeastBreadth * size(0));
  if (line) return std::nullopt;
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs(2) = -1.0;

  Similarity3 similarity;
  similarity.rotation = Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * signs.asDiagonal() *
                                                           svd.matrixV().transpose()))
                            .normalized();
  similarity.scale = size.dot(signs) / spread.trace();
  similarity.translation = target_mean - similarity.scale * (similarity.rotation * source_mean);
  const bool finite = std::isfinite(similarity.scale) && similarity.scale > 0.0 &&
                      similarity.translation.allFinite();
  return finite ? std::optional(similarity) : std::nullopt;
}

}  // namespace lodemark
