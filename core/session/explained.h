// Whether the ranges of an epoch say anything about the place at all.
#pragma once

#include <cstddef>
#include <span>

#include "core/fusion/point_adjustment.h"

namespace lodemark {

// So few ranges cannot tell.
inline constexpr std::size_t kFewestToExplain = 5;

// False where hardly any range looks like ordinary noise (without a lock all of them look late), or
// most fit nothing.
inline bool Explained(std::span<const ObservationVerdict> verdicts) {
  constexpr double kFewestOrdinary = 1.0;  // in sum of probabilities
  if (verdicts.size() < kFewestToExplain) return true;
  double ordinary = 0.0;
  double late = 0.0;
  for (const ObservationVerdict& verdict : verdicts) {
    ordinary += verdict.weight;
    late += verdict.late_share;
  }
  return ordinary >= kFewestOrdinary &&
         ordinary + late >= 0.5 * static_cast<double>(verdicts.size());
}

}  // namespace lodemark
