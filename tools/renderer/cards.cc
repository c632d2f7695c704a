#include "tools/renderer/cards.h"

#include <cmath>

#include "core/base/random.h"
#include "core/base/units.h"
#include "tools/renderer/lettering.h"

namespace lodemark {
namespace {

// A branch that splits, down to twigs.
void PaintBranch(CanvasPoint from, double direction_rad, double length_m, double width_m,
                 const Paint& bark, Random* random, Canvas* canvas) {
  if (length_m < 0.035 * canvas->height_m()) return;
  const CanvasPoint to = {from.u_m + length_m * std::sin(direction_rad),
                          from.v_m + length_m * std::cos(direction_rad)};
  canvas->Stroke(from, to, width_m, bark);
  const int parts = 2 + static_cast<int>(random->Index(2));
  for (int i = 0; i < parts; ++i) {
    const double along = random->Uniform(0.6, 1.0);
    PaintBranch({from.u_m + along * (to.u_m - from.u_m), from.v_m + along * (to.v_m - from.v_m)},
                direction_rad + random->Uniform(-0.75, 0.75),
                length_m * random->Uniform(0.55, 0.75), 0.6 * width_m, bark, random, canvas);
  }
}

}  // namespace

Canvas PaintTree(double height_m, std::uint64_t seed, const Daylight& day, double texel_m) {
  Random random(seed * 0x9e3779b97f4a7c15ULL + 5U);
  const double width_m = 0.8 * height_m;
  Canvas canvas(width_m, height_m, texel_m);
  const Paint bark = {{0.10F, 0.08F, 0.06F}, 1.0F};
  const double middle_m = 0.5 * width_m;
  PaintBranch({middle_m, 0.0}, random.Uniform(-0.05, 0.05), 0.34 * height_m, 0.035 * height_m, bark,
              &random, &canvas);
  // Clumps of leaves within an egg, each lighter above.
  const double leaves = 1.0 - day.winter;
  const int clumps = 90;
  for (int i = 0; i < clumps; ++i) {
    const double turn_rad = random.Uniform(0.0, 2.0 * kPi);
    const double out = std::sqrt(random.Uniform());
    const CanvasPoint at = {middle_m + 0.36 * width_m * out * std::sin(turn_rad),
                            0.64 * height_m + 0.27 * height_m * out * std::cos(turn_rad)};
    const double radius_m = height_m * random.Uniform(0.03, 0.07);
    const double tone = random.Uniform(0.6, 1.3);
    for (int leaf = 0; leaf < 60; ++leaf) {
      const double du = random.Gaussian(0.0, 0.5);
      const double dv = random.Gaussian(0.0, 0.45);
      const double size_m = random.Uniform(0.05, 0.11);
      const double light = tone * (0.75 + 0.3 * dv + 0.25 * random.Uniform());
      const auto autumn = static_cast<float>(day.winter * random.Uniform());
      if (random.Uniform() > leaves) continue;
      const Colour green = {0.075F + 0.3F * autumn, 0.15F - 0.03F * autumn, 0.035F};
      canvas.FillEllipse({at.u_m + du * radius_m, at.v_m + dv * radius_m}, size_m, 0.7 * size_m,
                         {static_cast<float>(std::max(light, 0.2)) * green, 1.0F});
    }
  }
  return canvas;
}

Canvas PaintPerson(std::uint64_t seed, double texel_m) {
  Random random(seed * 0x9e3779b97f4a7c15ULL + 9U);
  Canvas canvas(0.8, 1.85, texel_m);
  const Colour coat = 0.6F * SaturatedColour(&random);
  const Colour trousers = Grey(static_cast<float>(random.Uniform(0.02, 0.2)));
  const auto skin_light = static_cast<float>(random.Uniform(0.25, 0.75));
  const Paint skin = {{0.75F * skin_light, 0.52F * skin_light, 0.4F * skin_light}, 1.0F};
  const double stride_m = random.Uniform(0.05, 0.25);
  canvas.Stroke({0.4, 0.9}, {0.4 - stride_m, 0.05}, 0.15, {trousers, 1.0F});
  canvas.Stroke({0.4, 0.9}, {0.4 + stride_m, 0.05}, 0.15, {0.85F * trousers, 1.0F});
  canvas.Stroke({0.4 - stride_m - 0.03, 0.04}, {0.4 - stride_m + 0.1, 0.04}, 0.08,
                {Grey(0.03F), 1.0F});
  canvas.Stroke({0.4 + stride_m - 0.03, 0.04}, {0.4 + stride_m + 0.1, 0.04}, 0.08,
                {Grey(0.03F), 1.0F});
  canvas.FillEllipse({0.4, 1.18}, 0.21, 0.36, {coat, 1.0F});
  canvas.Stroke({0.24, 1.38}, {0.16 - 0.3 * stride_m, 0.9}, 0.1, {0.9F * coat, 1.0F});
  canvas.Stroke({0.56, 1.38}, {0.64 + 0.3 * stride_m, 0.9}, 0.1, {0.8F * coat, 1.0F});
  if (random.Uniform() < 0.5) {
    canvas.FillEllipse({0.66, 0.88}, 0.13, 0.17, {SaturatedColour(&random), 1.0F});
  }
  canvas.FillEllipse({0.4, 1.67}, 0.1, 0.13, skin);
  canvas.FillEllipse({0.4, 1.72}, 0.11, 0.09, {Grey(0.03F), 1.0F});
  return canvas;
}

}  // namespace lodemark
