// The density of a range error model, tabulated for evaluation by the thousand.
#pragma once

#include <algorithm>
#include <array>

#include "core/fusion/observation.h"

namespace lodemark {

// Equidistant nodes from 6 sigma before zero to 6 sigma and 6 late scales behind it, linear
// between, constant beyond. Single precision: densities enter as factors of a weight.
class DensityTable {
 public:
  void Fill(const RangeErrorModel& model);

  float operator()(float error_m) const {
    const float place = std::clamp((error_m - begin_m_) * nodes_per_m_, 0.0f, last_place_);
    const int node = static_cast<int>(place);
    const float before = nodes_[static_cast<std::size_t>(node)];
    const float after = nodes_[static_cast<std::size_t>(node) + 1];
    return before + (place - static_cast<float>(node)) * (after - before);
  }

 private:
  static constexpr int kFewestNodes = 48;
  static constexpr int kMostNodes = 512;

  float begin_m_ = 0.0f;
  float nodes_per_m_ = 1.0f;
  float last_place_ = 0.0f;
  std::array<float, kMostNodes + 2> nodes_ = {};
};

}  // namespace lodemark
