// Counts satellites, each once however many signals it sends.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>

#include "core/gnss/signal.h"

namespace lodemark {

class DistinctSatellites {
 public:
  void Add(SatelliteId satellite) {
    const auto system = static_cast<std::size_t>(satellite.system);
    if (system >= seen_.size() || seen_[system].test(satellite.number)) return;
    seen_[system].set(satellite.number);
    ++count_;
  }
  int count() const { return count_; }

 private:
  std::array<std::bitset<256>, kSystemCount> seen_;
  int count_ = 0;
};

}  // namespace lodemark
