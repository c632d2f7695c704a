// The density of a range error model, tabulated for evaluation by the thousand.
#pragma once

#include <array>

#include "core/fusion/observation.h"

namespace lodemark {

// Nodes every quarter sigma within 6 sigma of zero, then every sixth of a late scale for 6 late
// scales; linear between, constant beyond. Single precision: densities enter as factors of a
// weight.
class DensityTable {
 public:
  void Fill(const RangeErrorModel& model);

  // Where the error model says nothing, at NaN, the table does neither.
  float operator()(float error_m) const {
    const float core = (error_m - core_begin_m_) * core_nodes_per_m_;
    const float tail = (error_m - tail_begin_m_) * tail_nodes_per_m_;
    const float place = Within(core, kCore) + Within(tail, kTail);
    const int node = static_cast<int>(place);
    const float before = nodes_[static_cast<std::size_t>(node)];
    const float after = nodes_[static_cast<std::size_t>(node) + 1];
    return before + (place - static_cast<float>(node)) * (after - before);
  }

 private:
  // From 0 to the largest; the largest for NaN. Comparisons that compilers turn into vectors.
  static float Within(float place, float largest) {
    const float below = place < largest ? place : largest;
    return below > 0.0f ? below : 0.0f;
  }

  static constexpr int kCoreSteps = 48;
  static constexpr int kTailSteps = 36;
  static constexpr float kCore = kCoreSteps;
  static constexpr float kTail = kTailSteps;
  static constexpr int kSteps = kCoreSteps + kTailSteps;

  float core_begin_m_ = 0.0f;
  float core_nodes_per_m_ = 1.0f;
  float tail_begin_m_ = 0.0f;
  float tail_nodes_per_m_ = 1.0f;
  std::array<float, kSteps + 2> nodes_ = {};
};

}  // namespace lodemark
