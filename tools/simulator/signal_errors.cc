#include "tools/simulator/signal_errors.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

std::uint64_t StreamSeed(std::uint64_t seed, SatelliteId satellite, SignalCode signal) {
  return ((seed * 1'000'003 + static_cast<std::uint64_t>(satellite.system)) * 1'000 +
          satellite.number) *
             100'000 +
         static_cast<std::uint64_t>(signal.band) * 256 +
         static_cast<std::uint64_t>(signal.attribute);
}

}  // namespace

GaussMarkov::GaussMarkov(double sigma, double time_constant_s, Random* random)
    : sigma_(sigma), time_constant_s_(time_constant_s), value_(random->Gaussian(0.0, sigma)) {}

double GaussMarkov::Step(double interval_s, Random* random) {
  const double kept = std::exp(-interval_s / time_constant_s_);
  value_ = kept * value_ + std::sqrt(1.0 - kept * kept) * random->Gaussian(0.0, sigma_);
  return value_;
}

// Standing, multipath changes with the satellites' motion; walking, within a few steps.
SignalErrors::SignalErrors(SatelliteId satellite, SignalCode signal, double multipath_sigma_m,
                           bool moving, bool by_chance, std::uint64_t seed)
    : wide_(signal.band == '5'),
      by_chance_(by_chance),
      ionosphere_random_(StreamSeed(seed, satellite, {})),
      random_(StreamSeed(seed, satellite, signal)),
      antenna_db_(random_.Gaussian(0.0, 1.5)),
      ionosphere_(0.12, 1800.0, &ionosphere_random_),
      fading_db_(moving ? 2.0 : 1.0, moving ? 4.0 : 25.0, &random_),
      multipath_((wide_ ? 0.45 : 1.0) * multipath_sigma_m, moving ? 6.0 : 60.0, &random_),
      late_(1.0, moving ? 5.0 : 90.0, &random_) {}

SignalDisturbance SignalErrors::Step(double elevation_rad, const ReceivedPaths& paths,
                                     double interval_s) {
  SignalDisturbance out;
  const double sine = std::max(0.05, std::sin(elevation_rad));
  out.ionosphere_scale = std::max(0.3, 1.0 + ionosphere_.Step(interval_s, &ionosphere_random_));
  const double fading_db = fading_db_.Step(interval_s, &random_);
  const double late = late_.Step(interval_s, &random_);
  // Reflections that outdo the direct signal come now and then, from low satellites above all:
  // they weaken it and are late, never early.
  const double blocked = by_chance_ ? std::max(0.0, late - 0.6 - 1.8 * sine) : 0.0;
  out.cn0_dbhz = std::clamp(28.0 + 17.0 * std::pow(sine, 0.6) + antenna_db_ + fading_db -
                                7.0 * blocked - (wide_ ? 2.0 : 0.0) + paths.gain_db,
                            by_chance_ ? 12.0 : 0.0, 52.0);
  const double weakness = std::pow(10.0, (45.0 - out.cn0_dbhz) / 20.0);
  out.code_sigma_m = (wide_ ? 0.25 : 0.9) * weakness;
  out.rate_sigma_mps = 0.02 + 0.03 * weakness;
  out.phase_sigma_m = 0.0015 + 0.0015 * weakness;
  const double multipath_m = 0.7 / std::sqrt(sine) * multipath_.Step(interval_s, &random_);
  out.code_error_m =
      multipath_m + 18.0 * blocked + paths.code_error_m + random_.Gaussian(0.0, out.code_sigma_m);
  out.rate_error_mps = paths.rate_error_mps + random_.Gaussian(0.0, out.rate_sigma_mps);
  out.phase_error_m = paths.phase_error_m + random_.Gaussian(0.0, out.phase_sigma_m);
  return out;
}

}  // namespace lodemark
