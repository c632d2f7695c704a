// What disturbs one simulated signal: strength and fading, multipath, noise.
#pragma once

#include <cstdint>

#include "core/base/random.h"
#include "core/gnss/signal.h"
#include "tools/simulator/signal_paths.h"

namespace lodemark {

// A first-order Gauss-Markov process: correlated over the time constant, of the given sigma.
class GaussMarkov {
 public:
  // Starts with a draw from its stationary distribution.
  GaussMarkov(double sigma, double time_constant_s, Random* random);
  double Step(double interval_s, Random* random);
  double value() const { return value_; }

 private:
  double sigma_;
  double time_constant_s_;
  double value_;
};

struct SignalDisturbance {
  double cn0_dbhz = 0.0;
  double code_error_m = 0.0;  // multipath, later than the direct path on the whole, and noise
  double code_sigma_m = 0.0;  // of the noise
  double rate_error_mps = 0.0;
  double rate_sigma_mps = 0.0;
  double phase_error_m = 0.0;
  double phase_sigma_m = 0.0;
  double ionosphere_scale = 1.0;  // true delay over modelled, the same for a satellite's signals
};

// The disturbances of one signal over time, from a stream of random numbers of its own.
class SignalErrors {
 public:
  // by_chance: reflections that outdo the direct signal come by chance, as nobody knows the walls.
  SignalErrors(SatelliteId satellite, SignalCode signal, double multipath_sigma_m, bool moving,
               bool by_chance, std::uint64_t seed);

  SignalDisturbance Step(double elevation_rad, const ReceivedPaths& paths, double interval_s);

 private:
  bool wide_;  // L5 and E5a: ten times the chip rate of L1 C/A
  bool by_chance_;
  Random ionosphere_random_;
  Random random_;
  double antenna_db_;
  GaussMarkov ionosphere_;
  GaussMarkov fading_db_;
  GaussMarkov multipath_;
  GaussMarkov late_;
};

}  // namespace lodemark
