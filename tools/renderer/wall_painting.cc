#include "tools/renderer/wall_painting.h"

#include <algorithm>
#include <cmath>

#include "tools/renderer/lattice_noise.h"

namespace lodemark {
namespace {

std::uint32_t SeedFrom(Random* random) { return static_cast<std::uint32_t>(random->NextBits()); }

// Courses of stones with joints between; each stone has a tone of its own.
struct Masonry {
  double length_m;
  double course_m;
  double joint_m;
  float variety;  // of the stones' brightness
  Colour joint;
  bool bonded;  // every other course is shifted by half a stone
};

void PaintMasonry(const Masonry& masonry, const Colour& tone, const CanvasRect& rect,
                  std::uint32_t seed, Canvas* canvas) {
  const double texel_m = canvas->texel_m();
  const NoiseOctaves grain = {0.9 * masonry.length_m, 5, 0.7F};
  // A texel that holds many stones shows their mean.
  const auto clear = static_cast<float>(std::clamp(1.6 * masonry.course_m / texel_m, 0.3, 1.0));
  canvas->ForTexels(rect, [&](double u_m, double v_m, Paint* texel) {
    const auto course = static_cast<std::int32_t>(std::floor(v_m / masonry.course_m));
    const double shift_m = masonry.bonded && course % 2 != 0 ? 0.5 * masonry.length_m : 0.0;
    const auto stone = static_cast<std::int32_t>(std::floor((u_m + shift_m) / masonry.length_m));
    const float own = 2.0F * CellNumber(stone, course, seed) - 1.0F;
    const float reddish = CellNumber(stone, course, seed + 1U) - 0.5F;
    const float light = 1.0F + clear * masonry.variety * own +
                        0.22F * FractalNoise(u_m, v_m, grain, texel_m, seed + 2U);
    const float joint =
        1.0F - (1.0F - BandShare(v_m, masonry.course_m, masonry.joint_m, texel_m)) *
                   (1.0F - BandShare(u_m + shift_m, masonry.length_m, masonry.joint_m, texel_m));
    const Colour stone_colour =
        light * Colour{tone.r * (1.0F + 0.3F * clear * masonry.variety * reddish), tone.g,
                       tone.b * (1.0F - 0.3F * clear * masonry.variety * reddish)};
    *texel = {Mix(stone_colour, masonry.joint, joint), 0.0F};
  });
}

void PaintPlain(const Colour& tone, float roughness, const CanvasRect& rect, std::uint32_t seed,
                Canvas* canvas) {
  const double texel_m = canvas->texel_m();
  const NoiseOctaves grain = {2.0, 7, 0.75F};
  canvas->ForTexels(rect, [&](double u_m, double v_m, Paint* texel) {
    const float light = 1.0F + roughness * FractalNoise(u_m, v_m, grain, texel_m, seed);
    *texel = {light * tone, 0.0F};
  });
}

// A line that wanders: a crack, a cable.
void PaintCrack(CanvasPoint from, double length_m, Random* random, Canvas* canvas) {
  double direction_rad = random->Uniform(-2.2, -0.9);
  CanvasPoint at = from;
  const double step_m = 0.25;
  for (double way_m = 0.0; way_m < length_m; way_m += step_m) {
    direction_rad += random->Gaussian(0.0, 0.5);
    const CanvasPoint to = {at.u_m + step_m * std::cos(direction_rad),
                            at.v_m + step_m * std::sin(direction_rad)};
    canvas->Stroke(at, to, 0.025, {Grey(0.12F), 0.0F}, 0.8F);
    at = to;
  }
}

// Where plaster came off and was put back in another tone, or not at all.
void PaintPatches(const Colour& tone, bool bricks_below, Random* random, Canvas* canvas) {
  const double area_m2 = canvas->width_m() * canvas->height_m();
  const auto patches = static_cast<int>(area_m2 / 45.0);
  for (int i = 0; i < patches; ++i) {
    const CanvasPoint at = {random->Uniform(0.0, canvas->width_m()),
                            random->Uniform(0.0, canvas->height_m())};
    const double wide_m = random->Uniform(0.3, 1.4);
    const double high_m = random->Uniform(0.2, 1.1);
    if (bricks_below && random->Uniform() < 0.35) {
      const std::uint32_t seed = SeedFrom(random);
      const int blots = 4;
      for (int k = 0; k < blots; ++k) {
        const CanvasPoint part = {at.u_m + random->Uniform(-0.5, 0.5) * wide_m,
                                  at.v_m + random->Uniform(-0.5, 0.5) * high_m};
        const double radius_m = 0.4 * random->Uniform(0.4, 1.0) * wide_m;
        const double tone_shift = CellNumber(k, 0, seed);
        canvas->FillEllipse(part, radius_m, 0.8 * radius_m,
                            {{0.26F + 0.1F * static_cast<float>(tone_shift), 0.14F, 0.09F}, 0.0F},
                            0.9F);
      }
    } else {
      const auto light = static_cast<float>(random->Uniform(0.72, 1.22));
      canvas->FillRect({at.u_m - 0.5 * wide_m, at.v_m - 0.5 * high_m, at.u_m + 0.5 * wide_m,
                        at.v_m + 0.5 * high_m},
                       {light * tone, 0.0F}, 0.8F);
    }
  }
  const auto cracks = static_cast<int>(area_m2 / 40.0);
  for (int i = 0; i < cracks; ++i) {
    PaintCrack({random->Uniform(0.0, canvas->width_m()), random->Uniform(0.0, canvas->height_m())},
               random->Uniform(0.6, 3.5), random, canvas);
  }
}

}  // namespace

Colour WallTone(FacadeKind kind, Random* building) {
  const auto light = static_cast<float>(building->Uniform(0.8, 1.2));
  const auto warm = static_cast<float>(building->Uniform(-0.06, 0.06));
  Colour tone = Grey(0.4F);
  switch (kind) {
    case FacadeKind::kBrick:
      tone = {0.33F, 0.16F, 0.11F};
      break;
    case FacadeKind::kStone:
      tone = {0.46F, 0.42F, 0.35F};
      break;
    case FacadeKind::kPlaster:
      tone = {0.56F, 0.50F, 0.38F};
      break;
    case FacadeKind::kTiles:
      tone = {0.58F, 0.58F, 0.55F};
      break;
    case FacadeKind::kGlass:
      tone = {0.10F, 0.13F, 0.15F};
      break;
    case FacadeKind::kConcrete:
      tone = {0.40F, 0.40F, 0.385F};
      break;
    case FacadeKind::kFoliage:
      tone = {0.40F, 0.34F, 0.27F};
      break;
    case FacadeKind::kShops:
      tone = {0.50F, 0.46F, 0.42F};
      break;
    case FacadeKind::kBus:
      tone = {0.55F, 0.55F, 0.58F};
      break;
  }
  return {light * tone.r * (1.0F + warm), light * tone.g, light * tone.b * (1.0F - 2.0F * warm)};
}

void PaintWall(FacadeKind kind, const Colour& tone, Random* random, Canvas* canvas) {
  const std::uint32_t seed = SeedFrom(random);
  const CanvasRect whole = canvas->whole();
  switch (kind) {
    case FacadeKind::kBrick:
    case FacadeKind::kFoliage:
      PaintMasonry({0.25, 0.083, 0.012, 0.36F, {0.45F, 0.43F, 0.4F}, true}, tone, whole, seed,
                   canvas);
      PaintPatches(tone, false, random, canvas);
      break;
    case FacadeKind::kStone:
      PaintMasonry({0.9, 0.45, 0.025, 0.30F, 0.35F * tone, true}, tone, whole, seed, canvas);
      break;
    case FacadeKind::kTiles:
      PaintMasonry({0.2, 0.1, 0.008, 0.10F, Grey(0.3F), false}, tone, whole, seed, canvas);
      break;
    case FacadeKind::kConcrete:
      PaintMasonry({3.0, 1.5, 0.02, 0.05F, Grey(0.22F), false}, tone, whole, seed, canvas);
      break;
    case FacadeKind::kGlass:
    case FacadeKind::kBus:
      PaintPlain(tone, 0.03F, whole, seed, canvas);
      break;
    case FacadeKind::kPlaster:
    case FacadeKind::kShops:
      PaintPlain(tone, 0.14F, whole, seed, canvas);
      PaintPatches(tone, true, random, canvas);
      break;
  }
}

void PaintWeather(float strength, Random* random, Canvas* canvas) {
  const std::uint32_t seed = SeedFrom(random);
  const double texel_m = canvas->texel_m();
  const NoiseOctaves clouds = {9.0, 8, 0.72F};
  const NoiseOctaves streaks = {0.8, 4, 0.7F};
  canvas->ForTexels(canvas->whole(), [&](double u_m, double v_m, Paint* texel) {
    const float cloud = FractalNoise(u_m, v_m, clouds, texel_m, seed);
    // Ten times as long as wide.
    const float streak = FractalNoise(u_m, 0.1 * v_m, streaks, texel_m, seed + 77U);
    const float foot = 0.25F * std::exp(-static_cast<float>(v_m) / 0.8F);
    const float light = 1.0F + strength * (0.5F * cloud + 0.35F * std::min(streak, 0.0F)) - foot;
    texel->colour = std::max(light, 0.2F) * texel->colour;
  });
}

void PaintLeaves(const CanvasRect& rect, double per_m2, double leaf_share, Random* random,
                 Canvas* canvas) {
  const std::uint32_t seed = SeedFrom(random);
  const NoiseOctaves clumps = {3.0, 4, 0.65F};
  const auto count = static_cast<int>(per_m2 * rect.width_m() * rect.height_m());
  for (int i = 0; i < count; ++i) {
    const CanvasPoint at = {random->Uniform(rect.left_m, rect.right_m),
                            random->Uniform(rect.low_m, rect.high_m)};
    const double light = random->Uniform(0.35, 1.25);
    const double size_m = random->Uniform(0.05, 0.17);
    const double fate = random->Uniform();
    const float density = FractalNoise(at.u_m, at.v_m, clumps, 0.0, seed);
    const double above = (at.v_m - rect.low_m) / rect.height_m();
    if (density < 1.0 * above - 0.75 || fate > leaf_share) continue;
    const auto autumn = static_cast<float>(std::max(0.0, 0.9 - leaf_share) * random->Uniform());
    const Colour green = {0.06F + 0.35F * autumn, 0.14F + 0.02F * autumn, 0.035F};
    const auto bright = static_cast<float>(light * (1.0 + 0.6 * density));
    canvas->FillEllipse(at, size_m, 0.8 * size_m, {std::max(bright, 0.25F) * green, 0.0F}, 0.95F);
  }
}

}  // namespace lodemark
