// The density of a range error model, tabulated for evaluation by the thousand.
#pragma once

#include <algorithm>
#include <array>

#include "core/fusion/observation.h"

namespace lodemark {

// Nodes every quarter sigma within 6 sigma of zero, then every sixth of a late scale for 6 late
// scales; linear between, constant beyond. Single precision: densities enter as factors of a
// weight.
class DensityTable {
 public:
  void Fill(const RangeErrorModel& model);

  float operator()(float error_m) const {
    const float place = std::clamp((error_m - core_begin_m_) * core_nodes_per_m_, 0.0f, kCore) +
                        std::clamp((error_m - tail_begin_m_) * tail_nodes_per_m_, 0.0f, kTail);
    const int node = static_cast<int>(place);
    const float before = nodes_[static_cast<std::size_t>(node)];
    const float after = nodes_[static_cast<std::size_t>(node) + 1];
    return before + (place - static_cast<float>(node)) * (after - before);
  }

 private:
  static constexpr float kCore = 48.0f;  // steps
  static constexpr float kTail = 36.0f;
  static constexpr int kSteps = static_cast<int>(kCore + kTail);

  float core_begin_m_ = 0.0f;
  float core_nodes_per_m_ = 1.0f;
  float tail_begin_m_ = 0.0f;
  float tail_nodes_per_m_ = 1.0f;
  std::array<float, kSteps + 2> nodes_ = {};
};

}  // namespace lodemark
