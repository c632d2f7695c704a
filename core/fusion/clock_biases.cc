#include "core/fusion/clock_biases.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Hardware biases drift with temperature by decimetres an hour.
constexpr double kWalk_m_per_sqrt_s = 0.02;

// Errors of neighbouring epochs are alike, so averaging many of them gains less than their number
// says: a bias is never believed better than this.
constexpr double kSmallestSigma_m = 0.3;

}  // namespace

ClockBiases::ClockBiases() { Forget(); }

void ClockBiases::Set(int group, const ClockBias& bias) {
  if (group <= 0 || group >= kMaxClockGroups) return;
  biases_[static_cast<std::size_t>(group)] = {bias.mean_m,
                                              std::max(bias.sigma_m, kSmallestSigma_m)};
}

void ClockBiases::Advance(double seconds) {
  for (std::size_t i = 1; i < biases_.size(); ++i) {
    biases_[i].sigma_m = std::sqrt(biases_[i].sigma_m * biases_[i].sigma_m +
                                   kWalk_m_per_sqrt_s * kWalk_m_per_sqrt_s * seconds);
  }
}

void ClockBiases::Forget() {
  biases_.fill(ClockBias());
  biases_[0].sigma_m = 0.0;
}

}  // namespace lodemark
