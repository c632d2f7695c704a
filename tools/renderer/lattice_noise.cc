#include "tools/renderer/lattice_noise.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

float Corner(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return static_cast<float>(static_cast<std::int32_t>(CellBits(x, y, seed))) * 0x1p-31F;
}

// Integral from 0 to x of a train of bands.
double BandIntegral(double x, double period, double band) {
  const double whole = std::floor(x / period);
  return whole * band + std::min(x - whole * period, band);
}

}  // namespace

std::uint32_t CellBits(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  // Mixing steps of Wang's and Murmur's kind: multiply by odd numbers, fold the high half down.
  std::uint32_t h = seed * 0x9e3779b1U;
  h ^= static_cast<std::uint32_t>(x) * 0x85ebca6bU;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h ^= static_cast<std::uint32_t>(y) * 0xc2b2ae35U;
  h = (h ^ (h >> 16)) * 0x297a2d39U;
  h = (h ^ (h >> 15)) * 0x85ebca6bU;
  return h ^ (h >> 13);
}

float SmoothNoise(double x, double y, std::uint32_t seed) {
  const double floor_x = std::floor(x);
  const double floor_y = std::floor(y);
  const auto ix = static_cast<std::int32_t>(floor_x);
  const auto iy = static_cast<std::int32_t>(floor_y);
  const auto fx = static_cast<float>(x - floor_x);
  const auto fy = static_cast<float>(y - floor_y);
  const float sx = fx * fx * (3.0F - 2.0F * fx);
  const float sy = fy * fy * (3.0F - 2.0F * fy);
  const float low = Corner(ix, iy, seed) + sx * (Corner(ix + 1, iy, seed) - Corner(ix, iy, seed));
  const float high =
      Corner(ix, iy + 1, seed) + sx * (Corner(ix + 1, iy + 1, seed) - Corner(ix, iy + 1, seed));
  return low + sy * (high - low);
}

float FractalNoise(double x_m, double y_m, const NoiseOctaves& octaves, double footprint_m,
                   std::uint32_t seed) {
  float sum = 0.0F;
  float amplitude = 1.0F - octaves.falloff;
  double size_m = octaves.largest_m;
  for (int i = 0; i < octaves.count; ++i) {
    const auto fade = static_cast<float>(std::clamp(2.0 - 2.0 * footprint_m / size_m, 0.0, 1.0));
    if (fade <= 0.0F) break;
    sum += fade * amplitude *
           SmoothNoise(x_m / size_m, y_m / size_m, seed + static_cast<std::uint32_t>(i) * 7919U);
    amplitude *= octaves.falloff;
    size_m *= 0.5;
  }
  return sum;
}

float BandShare(double x, double period, double band, double footprint) {
  const double half = 0.5 * std::max(footprint, 1e-6);
  return static_cast<float>(
      (BandIntegral(x + half, period, band) - BandIntegral(x - half, period, band)) / (2.0 * half));
}

}  // namespace lodemark
