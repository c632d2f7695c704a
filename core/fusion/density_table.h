// The density of a range error model, tabulated for evaluation by the thousand.
#pragma once

#include <array>

#include "core/fusion/observation.h"

namespace lodemark {

// Linear interpolation between nodes: a quarter sigma apart in the core of +-6 sigma, a quarter of
// the late scale apart in the late tail behind it, constant beyond.
class DensityTable {
 public:
  void Fill(const RangeErrorModel& model);

  double operator()(double error_m) const {
    const double core = (error_m - core_begin_m_) * core_nodes_per_m_;
    if (core < 0.0) return floor_pm_;
    if (core < kCoreSteps) return Between(core_, core);
    const double tail = (error_m - tail_begin_m_) * tail_nodes_per_m_;
    return tail < kTailSteps ? Between(tail_, tail) : floor_pm_;
  }

 private:
  static constexpr int kCoreSteps = 48;
  static constexpr int kTailSteps = 32;

  template <std::size_t kSize>
  static double Between(const std::array<float, kSize>& nodes, double place) {
    const auto node = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(node);
    const double before = static_cast<double>(nodes[node]);
    return before + share * (static_cast<double>(nodes[node + 1]) - before);
  }

  double core_begin_m_ = 0.0;
  double core_nodes_per_m_ = 1.0;
  double tail_begin_m_ = 0.0;
  double tail_nodes_per_m_ = 1.0;
  double floor_pm_ = 0.0;
  std::array<float, kCoreSteps + 1> core_ = {};
  std::array<float, kTailSteps + 1> tail_ = {};
};

}  // namespace lodemark
