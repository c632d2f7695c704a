// Random numbers that are the same on every platform, for simulation and seeded sampling.
#pragma once

#include <cstdint>

namespace lodemark {

// xoshiro256** of Blackman and Vigna (2018), seeded by splitmix64. Not for secrets.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  std::uint64_t NextBits();

  // Uniform in [0, 1), 53 bits.
  double Uniform();
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  // Uniform in 0 .. count-1, without bias. count is at least 1.
  std::uint64_t Index(std::uint64_t count);

  // Standard normal (Marsaglia's polar method).
  double Gaussian();
  double Gaussian(double mean, double sigma) { return mean + sigma * Gaussian(); }

  // Exponential with the given mean.
  double Exponential(double mean);

 private:
  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace lodemark
