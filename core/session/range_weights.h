// How much each code range is trusted: noise by C/N0 and elevation, the chance of a reflection, and
// a scale per signal learned from past epochs.
#pragma once

#include <array>
#include <cstdint>

#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"

namespace lodemark {

// What is known of one signal at one epoch.
struct SignalQuality {
  double cn0_dbhz = 0.0;        // 0 if unknown
  double elevation_rad = 0.0;
  double reported_sigma_m = 0.0;  // 0 if unknown
  double model_sigma_m = 0.0;   // of orbit, clock and atmosphere
  bool multipath_reported = false;
};

class RangeWeights {
 public:
  RangeErrorModel ErrorModel(int clock_group, const SignalQuality& quality) const;

  // Learns from an adjusted epoch: residual, its share of the redundancy and its weight.
  void Learn(int clock_group, const RangeErrorModel& model, double model_sigma_m,
             double residual_m, double redundancy_share, double core_share);
  void Forget();

 private:
  struct Scale {
    double squares = 0.0;
    double count = 0.0;
  };
  std::array<Scale, kMaxClockGroups> scales_ = {};
};

}  // namespace lodemark
