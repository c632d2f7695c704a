// What past epochs taught about the biases between the clocks of signals and systems.
#pragma once

#include <array>

namespace lodemark {

// Clock groups are numbered from 0; a session meets them as signals appear.
inline constexpr int kMaxClockGroups = 24;

struct ClockBias {
  double mean_m = 0.0;
  double sigma_m = 1e7;  // unknown: a receiver may count another millisecond for another system
};

// Biases against group 0, which is 0 by definition. The receiver clock itself is never remembered,
// only how the groups differ.
class ClockBiases {
 public:
  ClockBiases();

  const ClockBias& operator[](int group) const { return biases_[static_cast<std::size_t>(group)]; }
  void Set(int group, const ClockBias& bias);

  // Lets the biases wander for a while.
  void Advance(double seconds);
  void Forget();

 private:
  std::array<ClockBias, kMaxClockGroups> biases_;
};

}  // namespace lodemark
