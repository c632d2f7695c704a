#include "tools/renderer/outdoors.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "tools/renderer/lattice_noise.h"

namespace lodemark {
namespace {

std::uint32_t Short(std::uint64_t seed) { return static_cast<std::uint32_t>(seed ^ (seed >> 32)); }

// Slabs in a grid, crossed by darker bands every few metres, mended here and there.
Colour PavingColour(std::uint32_t seed, const Eigen::Vector2d& at_m,
                    const Eigen::Vector2d& footprint_m) {
  constexpr double kSlab_m = 0.6;
  constexpr double kBands_m = 6.0;
  const double widest_m = footprint_m.maxCoeff();
  const auto slab_x = static_cast<std::int32_t>(std::floor(at_m.x() / kSlab_m));
  const auto slab_y = static_cast<std::int32_t>(std::floor(at_m.y() / kSlab_m));
  const auto clear = static_cast<float>(std::clamp(1.6 - 1.6 * widest_m / kSlab_m, 0.0, 1.0));
  const float own = clear * (CellNumber(slab_x, slab_y, seed) - 0.5F);
  const float mended = clear * (CellNumber(slab_x, slab_y, seed + 5U) > 0.96F ? -0.35F : 0.0F);
  const float joint = 1.0F - (1.0F - BandShare(at_m.x(), kSlab_m, 0.02, footprint_m.x())) *
                                 (1.0F - BandShare(at_m.y(), kSlab_m, 0.02, footprint_m.y()));
  const float band = 1.0F - (1.0F - BandShare(at_m.x(), kBands_m, kSlab_m, footprint_m.x())) *
                                (1.0F - BandShare(at_m.y(), kBands_m, kSlab_m, footprint_m.y()));
  const float light = (1.0F + 0.3F * own + mended) * (1.0F - 0.35F * band) * (1.0F - 0.45F * joint);
  return light * Colour{0.34F, 0.32F, 0.30F};
}

Colour AsphaltColour(std::uint32_t seed, const Eigen::Vector2d& at_m,
                     const Eigen::Vector2d& footprint_m) {
  const NoiseOctaves grain = {0.16, 3, 0.6F};
  const float speckle = FractalNoise(at_m.x(), at_m.y(), grain, footprint_m.maxCoeff(), seed);
  Colour tone = (1.0F + 0.35F * speckle) * Grey(0.12F);
  // A line along the road every 3.5 m, broken.
  const float line = BandShare(at_m.x(), 3.5, 0.14, footprint_m.x()) *
                     BandShare(at_m.y(), 6.0, 3.0, footprint_m.y());
  return Mix(tone, Grey(0.6F), line);
}

Colour GrassColour(std::uint32_t seed, const Eigen::Vector2d& at_m,
                   const Eigen::Vector2d& footprint_m, double winter) {
  const NoiseOctaves blades = {0.5, 5, 0.7F};
  const float light =
      1.0F + 0.6F * FractalNoise(at_m.x(), at_m.y(), blades, footprint_m.maxCoeff(), seed);
  return light * Mix({0.09F, 0.16F, 0.04F}, {0.22F, 0.19F, 0.09F}, static_cast<float>(winter));
}

}  // namespace

Colour GroundColour(const Scene& scene, const Daylight& day, const Eigen::Vector2d& at_m,
                    const Eigen::Vector2d& footprint_m) {
  const std::uint32_t seed = Short(scene.seed * 31U + 7U);
  Colour colour;
  switch (scene.ground) {
    case GroundKind::kPaving:
      colour = PavingColour(seed, at_m, footprint_m);
      break;
    case GroundKind::kAsphalt:
      colour = AsphaltColour(seed, at_m, footprint_m);
      break;
    case GroundKind::kGrass:
      colour = GrassColour(seed, at_m, footprint_m, day.winter);
      break;
  }
  const NoiseOctaves dirt = {14.0, 7, 0.65F};
  const float cloud = FractalNoise(at_m.x(), at_m.y(), dirt, footprint_m.maxCoeff(), seed + 1'000U);
  colour = (1.0F + 0.3F * cloud) * colour;
  // Puddles and leaves come and go.
  const NoiseOctaves wet = {5.0, 4, 0.6F};
  const float damp =
      FractalNoise(at_m.x(), at_m.y(), wet, footprint_m.maxCoeff(), Short(day.seed * 131U + 17U));
  return (1.0F - 0.3F * SmoothStep(0.18F, 0.3F, damp)) * colour;
}

LightLevels LevelsOf(const Daylight& day) {
  LightLevels levels;
  levels.to_sun_in_enu = {std::sin(day.sun_azimuth_rad) * std::cos(day.sun_elevation_rad),
                          std::cos(day.sun_azimuth_rad) * std::cos(day.sun_elevation_rad),
                          std::sin(day.sun_elevation_rad)};
  const auto cloud = static_cast<float>(std::clamp(day.cloud, 0.0, 1.0));
  const auto high = static_cast<float>(std::clamp(std::sin(day.sun_elevation_rad), 0.0, 1.0));
  const float strength = (1.0F - cloud) * 0.95F * SmoothStep(-0.02F, 0.25F, high);
  // Redder the longer its way through the air.
  const float red = 0.45F * (1.0F - high) * (1.0F - high);
  levels.sun = strength * Colour{1.0F, 0.95F - 0.25F * red, 0.86F - 0.6F * red};
  levels.sky = (0.30F + 0.30F * cloud) * Mix({0.78F, 0.94F, 1.22F}, {0.98F, 1.0F, 1.03F}, cloud);
  return levels;
}

Colour HazeColour(const LightLevels& levels) { return 1.25F * levels.sky + 0.18F * levels.sun; }

Colour SkyColour(const Scene& scene, const Daylight& day, const LightLevels& levels,
                 const Eigen::Vector3d& direction_in_enu) {
  const double up = direction_in_enu.z();
  const auto cloud_cover = static_cast<float>(std::clamp(day.cloud, 0.0, 1.0));
  const Colour zenith = Mix({0.14F, 0.30F, 0.68F}, {0.72F, 0.75F, 0.80F}, cloud_cover);
  const Colour horizon = Mix({0.62F, 0.74F, 0.86F}, {0.86F, 0.88F, 0.90F}, cloud_cover);
  const auto rise = static_cast<float>(std::clamp(up, 0.0, 1.0));
  Colour colour = Mix(horizon, zenith, std::sqrt(rise));
  if (up > 0.02) {
    // Clouds on a flat ceiling.
    const double x = direction_in_enu.x() / (up + 0.12);
    const double y = direction_in_enu.y() / (up + 0.12);
    const NoiseOctaves puffs = {1.6, 5, 0.55F};
    const float density = FractalNoise(x, y, puffs, 0.02, Short(day.seed * 977U + 3U));
    const float share =
        SmoothStep(0.35F - 0.6F * cloud_cover, 0.75F - 0.4F * cloud_cover, density + 0.25F) *
        SmoothStep(0.02F, 0.2F, rise);
    colour = Mix(colour, Grey(0.95F), 0.85F * share);
  }
  const auto toward = static_cast<float>(direction_in_enu.dot(levels.to_sun_in_enu));
  if (toward > 0.0F) {
    const float glow = std::pow(toward, 60.0F) + 8.0F * std::pow(toward, 2'500.0F);
    colour += glow * levels.sun;
  }
  // The town beyond, the same every day.
  const double azimuth_rad = std::atan2(direction_in_enu.x(), direction_in_enu.y());
  const auto block = static_cast<std::int32_t>(std::floor(azimuth_rad * 45.0));
  const float roof = 0.012F + 0.045F * CellNumber(block, 3, Short(scene.seed)) *
                                  CellNumber(block, 4, Short(scene.seed));
  const float town = 1.0F - SmoothStep(roof - 0.0006F, roof + 0.0006F, static_cast<float>(up));
  return Mix(colour, 0.8F * HazeColour(levels) + Grey(0.02F), 0.9F * town);
}

}  // namespace lodemark
