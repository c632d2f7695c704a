// Inner loops over the samples of PosteriorSampling.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "core/fusion/density_table.h"

namespace lodemark {

// Sums over points z with weights w.
struct WeightedSums {
  double weights = 0.0;
  double squared_weights = 0.0;
  Eigen::Vector4d first = Eigen::Vector4d::Zero();   // of w z
  Eigen::Matrix4d second = Eigen::Matrix4d::Zero();  // of w z z'
};

// A set of points in four dimensions and a weight for each. Where the processor has wide vectors
// they are used; the results are the same bits without.
class WeightedSamples {
 public:
  // Room for at least so many; a multiple of kLanes.
  explicit WeightedSamples(int count);

  std::size_t count() const { return weights_.size(); }
  void SetPoint(std::size_t k, const Eigen::Vector4d& point);
  double coordinate(std::size_t dimension, std::size_t k) const {
    return static_cast<double>(points_[dimension][k]);
  }
  std::vector<double>& weights() { return weights_; }

  // Divides all weights by the largest.
  void Normalise();

  // Multiplies each weight by the density at constant + slope . point.
  void Multiply(const DensityTable& density, float constant, const Eigen::Vector4f& slope);
  WeightedSums Sum() const;

  static constexpr std::size_t kLanes = 4;

 private:
  std::array<std::vector<float>, 4> points_;
  std::vector<double> weights_;
  bool wide_ = false;  // the processor has AVX2
};

}  // namespace lodemark
