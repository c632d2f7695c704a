// The sights as the search for a pose reads them: bearings worked out once, and columns that vector
// units run along.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/lens.h"
#include "core/resection/sights.h"

namespace lodemark {

// Indices of the sights in an order that their content and the seed shuffle, and that owes nothing
// to the order they come in.
std::vector<std::size_t> ShuffledOrder(std::span<const LandmarkSight> sights, std::uint64_t seed);

// Rows are the sights that the lens can have imaged, in their order: a shuffled one, since scoring
// gives up by what the first rows say.
//
// The misfit of a row to a pose is counted in the plane that touches the unit sphere at the
// bearing b: a landmark at q in camera axes strays by A q / (b . q), A being the derivative of the
// lens at b over the sight's sigma. That is the pixel residual to first order, for any lens, at the
// cost of a pinhole. The landmark's own covariance adds spread / (b . q)^2 to its square.
class SightTable {
 public:
  static constexpr std::size_t kBlock = 16;

  // centred: landmarks about their mean. threshold_px weighs pixels against landmarks.
  SightTable(std::span<const LandmarkSight> centred, const Lens& lens, double threshold_px);

  std::size_t size() const { return sight_.size(); }
  std::size_t blocks() const { return (size() + kBlock - 1) / kBlock; }

  std::size_t sight(std::size_t row) const { return sight_[row]; }  // index in the caller's span
  const Eigen::Vector3d& bearing(std::size_t row) const { return bearing_[row]; }
  const Eigen::Vector3d& landmark(std::size_t row) const { return landmark_[row]; }
  const Eigen::Matrix<double, 2, 3>& tangent(std::size_t row) const { return tangent_[row]; }
  double spread_m2(std::size_t row) const { return spread_m2_[row]; }

  // Rows from the surest to the least sure, and whether that is an order at all.
  const std::vector<std::size_t>& by_quality() const { return by_quality_; }
  bool has_qualities() const { return has_qualities_; }

  // Pixels per radian about the middle of the sights, over their sigma.
  double typical_scale() const { return typical_scale_; }

  // Padded with rows that agree with no pose.
  enum Column { kLandmark = 0, kBearing = 3, kTangentX = 6, kTangentY = 9, kSpread = 12, kColumns };
  const float* column(int which) const { return columns_[static_cast<std::size_t>(which)].data(); }

 private:
  void FillColumns();

  std::vector<std::size_t> sight_;
  std::vector<Eigen::Vector3d> bearing_;
  std::vector<Eigen::Vector3d> landmark_;
  std::vector<Eigen::Matrix<double, 2, 3>> tangent_;
  std::vector<double> spread_m2_;
  std::vector<std::size_t> by_quality_;
  bool has_qualities_ = false;
  double typical_scale_ = 1.0;
  std::array<std::vector<float>, kColumns> columns_;
};

}  // namespace lodemark
