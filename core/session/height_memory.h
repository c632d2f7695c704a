// A weak memory of the height: receivers rise and fall less than single epochs scatter.
#pragma once

#include <cstdint>
#include <optional>

#include "core/fusion/point_problem.h"
#include "core/session/session.h"

namespace lodemark {

// Carries the last height on, by the vertical speed from Doppler as far as that is trustworthy and
// by what slopes allow.
class HeightMemory {
 public:
  // Empty before the first fix and long after the last one.
  std::optional<HeightPrior> At(std::int64_t time_gps_ns) const;
  // From an estimate that is a fix.
  void Learn(const SessionEstimate& estimate);
  void Forget() { has_fix_ = false; }

 private:
  bool has_fix_ = false;
  std::int64_t time_gps_ns_ = 0;
  double height_m_ = 0.0;
  double variance_m2_ = 0.0;
  double climb_mps_ = 0.0;
  double climb_variance_m2ps2_ = 0.0;
};

}  // namespace lodemark
