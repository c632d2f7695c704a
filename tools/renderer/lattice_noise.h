// Repeatable irregularity: numbers that hang on a place and a seed alone.
#pragma once

#include <cstdint>

namespace lodemark {

// Well mixed bits of a cell.
std::uint32_t CellBits(std::int32_t x, std::int32_t y, std::uint32_t seed);

// The same as a number in 0 .. 1.
inline float CellNumber(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return static_cast<float>(CellBits(x, y, seed) >> 8) * 0x1p-24F;
}

// Smooth, in -1 .. 1, with features of size 1.
float SmoothNoise(double x, double y, std::uint32_t seed);

// How a sum of smooth noises of halving size is made.
struct NoiseOctaves {
  double largest_m = 1.0;
  int count = 4;
  float falloff = 0.55F;  // of the amplitude from one octave to the next
};

// Within about -1 .. 1. Octaves too fine for the footprint (the width that one sample stands for)
// fade out, so that the mean over the footprint is what comes.
float FractalNoise(double x_m, double y_m, const NoiseOctaves& octaves, double footprint_m,
                   std::uint32_t seed);

// Share of the interval of width footprint around x that lies in bands [k period, k period + band].
float BandShare(double x, double period, double band, double footprint);

}  // namespace lodemark
