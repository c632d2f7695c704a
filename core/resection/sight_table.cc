#include "core/resection/sight_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace lodemark {
namespace {

// The finaliser of splitmix64 (Steele, Lea and Flood, 2014).
std::uint64_t Mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

// By the pixel alone: landmarks change their numbers with their frame's origin.
std::uint64_t KeyOf(const Eigen::Vector2d& pixel, std::uint64_t seed) {
  const std::uint64_t x = std::bit_cast<std::uint64_t>(pixel.x() + 0.0);
  const std::uint64_t y = std::bit_cast<std::uint64_t>(pixel.y() + 0.0);
  return Mixed(Mixed(seed + x) + 0x9e3779b97f4a7c15u + y);
}

// Sigmas of a landmark that a threshold is worth: five pixels where the noise is one are five
// sigmas of it, but thresholds are set with more than noise in mind.
constexpr double kSigmasInThreshold = 3.0;

}  // namespace

std::vector<std::size_t> ShuffledOrder(std::span<const LandmarkSight> sights, std::uint64_t seed) {
  struct Entry {
    std::uint64_t key = 0;
    std::size_t sight = 0;
  };
  std::vector<Entry> entries;
  entries.reserve(sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i) {
    entries.push_back({KeyOf(sights[i].pixel, seed), i});
  }
  const auto content = [&](std::size_t i) {
    const LandmarkSight& sight = sights[i];
    return std::tuple(sight.landmark_in_enu_m.x(), sight.landmark_in_enu_m.y(),
                      sight.landmark_in_enu_m.z(), sight.pixel_sigma_px, sight.quality);
  };
  std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : content(a.sight) < content(b.sight);
  });
  std::vector<std::size_t> order;
  order.reserve(sights.size());
  for (const Entry& entry : entries) order.push_back(entry.sight);
  return order;
}

SightTable::SightTable(std::span<const LandmarkSight> centred, const Lens& lens,
                       double threshold_px) {
  std::vector<Eigen::Vector2d> pixels;
  pixels.reserve(centred.size());
  for (const LandmarkSight& sight : centred) pixels.push_back(sight.pixel);
  std::vector<Eigen::Vector3d> bearings(centred.size());
  std::vector<std::uint8_t> valid(centred.size());
  lens.Unproject(pixels, bearings, valid);

  const double spread_weight =
      kSigmasInThreshold * kSigmasInThreshold / (threshold_px * threshold_px);
  sight_.reserve(centred.size());
  bearing_.reserve(centred.size());
  landmark_.reserve(centred.size());
  tangent_.reserve(centred.size());
  spread_m2_.reserve(centred.size());
  double sum_of_scales = 0.0;
  ProjectionJacobian jacobian;
  for (std::size_t i = 0; i < centred.size(); ++i) {
    if (valid[i] == 0) continue;
    const LandmarkSight& sight = centred[i];
    const Eigen::Vector3d& bearing = bearings[i];
    if (!lens.Project(bearing, &jacobian)) continue;
    const Eigen::Matrix<double, 2, 3> tangent = jacobian.by_point / sight.pixel_sigma_px;
    const double square = 0.5 * tangent.squaredNorm();
    if (!std::isfinite(square) || !(square > 0.0)) continue;
    sight_.push_back(i);
    bearing_.push_back(bearing);
    landmark_.push_back(sight.landmark_in_enu_m);
    tangent_.push_back(tangent);
    spread_m2_.push_back(spread_weight * square * sight.landmark_covariance_m2.trace() / 3.0);
    sum_of_scales += std::sqrt(square);
  }
  if (!sight_.empty()) typical_scale_ = sum_of_scales / static_cast<double>(sight_.size());

  by_quality_.resize(size());
  for (std::size_t row = 0; row < size(); ++row) by_quality_[row] = row;
  const auto quality = [&](std::size_t row) { return centred[sight_[row]].quality; };
  std::stable_sort(by_quality_.begin(), by_quality_.end(),
                   [&](std::size_t a, std::size_t b) { return quality(a) > quality(b); });
  has_qualities_ = !sight_.empty() && quality(by_quality_.front()) > quality(by_quality_.back());
  FillColumns();
}

void SightTable::FillColumns() {
  for (std::vector<float>& column : columns_) column.assign(blocks() * kBlock, 0.0F);
  const auto fill = [&](std::size_t which, std::size_t row, double value) {
    columns_[which][row] = static_cast<float>(value);
  };
  for (std::size_t row = 0; row < size(); ++row) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Index axis = static_cast<Eigen::Index>(k);
      fill(kLandmark + k, row, landmark_[row][axis]);
      fill(kBearing + k, row, bearing_[row][axis]);
      fill(kTangentX + k, row, tangent_[row](0, axis));
      fill(kTangentY + k, row, tangent_[row](1, axis));
    }
    fill(kSpread, row, spread_m2_[row]);
  }
}

}  // namespace lodemark
