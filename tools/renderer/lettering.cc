#include "tools/renderer/lettering.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// One character: bars across and down, a slanting one, a dot.
void PaintCharacter(const CanvasRect& cell, const Paint& ink, Random* random, Canvas* canvas) {
  const CanvasRect box = cell.Inset(0.08 * std::min(cell.width_m(), cell.height_m()));
  const double pen_m = 0.11 * cell.height_m();
  const auto u = [&](double share) { return box.left_m + share * box.width_m(); };
  const auto v = [&](double share) { return box.low_m + share * box.height_m(); };
  const int across = 1 + static_cast<int>(random->Index(3));
  for (int i = 0; i < across; ++i) {
    const double level = random->Uniform(0.0, 1.0);
    canvas->Stroke({u(random->Uniform(0.0, 0.3)), v(level)},
                   {u(random->Uniform(0.7, 1.0)), v(level)}, pen_m, ink);
  }
  const int down = 1 + static_cast<int>(random->Index(2));
  for (int i = 0; i < down; ++i) {
    const double side = random->Uniform(0.1, 0.9);
    canvas->Stroke({u(side), v(random->Uniform(0.0, 0.4))}, {u(side), v(random->Uniform(0.7, 1.0))},
                   pen_m, ink);
  }
  if (random->Uniform() < 0.5) {
    canvas->Stroke({u(random->Uniform()), v(random->Uniform(0.4, 1.0))},
                   {u(random->Uniform()), v(random->Uniform(0.0, 0.5))}, pen_m, ink);
  }
  if (random->Uniform() < 0.3) {
    canvas->FillEllipse({u(random->Uniform()), v(random->Uniform())}, 0.8 * pen_m, 0.8 * pen_m,
                        ink);
  }
}

}  // namespace

void PaintWriting(const CanvasRect& rect, const Paint& ink, Random* random, Canvas* canvas) {
  const bool stands = rect.height_m() > 1.5 * rect.width_m();
  const double height_m = stands ? rect.width_m() : rect.height_m();
  const double room_m = stands ? rect.height_m() : rect.width_m();
  if (!(height_m > 0.01)) return;
  const double pitch_m = height_m * random->Uniform(0.95, 1.2);
  double at_m = 0.0;
  while (at_m + 0.95 * height_m <= room_m) {
    if (random->Uniform() < 0.88) {
      const CanvasRect cell = stands ? CanvasRect{rect.left_m, rect.high_m - at_m - height_m,
                                                  rect.right_m, rect.high_m - at_m}
                                     : CanvasRect{rect.left_m + at_m, rect.low_m,
                                                  rect.left_m + at_m + 0.9 * height_m, rect.high_m};
      PaintCharacter(cell, ink, random, canvas);
    }
    at_m += pitch_m;
  }
}

Colour SaturatedColour(Random* random) {
  const double hue = 6.0 * random->Uniform();
  const auto channel = [&](double shift) {
    const double away = std::abs(std::remainder(hue - shift, 6.0));
    return static_cast<float>(std::clamp(2.0 - away, 0.0, 1.0));
  };
  const auto value = static_cast<float>(random->Uniform(0.12, 0.6));
  const auto pale = static_cast<float>(random->Uniform(0.15, 0.65));
  return value * Mix({channel(0.0), channel(2.0), channel(4.0)}, Grey(1.0F), pale);
}

CanvasPoint PaintSign(const CanvasRect& rect, Random* random, Canvas* canvas) {
  const double short_m = std::min(rect.width_m(), rect.height_m());
  const bool light = random->Uniform() < 0.4;
  const Colour ground =
      light ? Grey(static_cast<float>(random->Uniform(0.5, 0.85))) : SaturatedColour(random);
  const Colour ink = light ? 0.5F * SaturatedColour(random) : Colour{0.88F, 0.86F, 0.75F};
  canvas->Shade({rect.left_m, rect.low_m - 0.18, rect.right_m, rect.low_m}, 0.6F);
  canvas->FillRect(rect, {ground, 0.08F});
  canvas->FrameRect(rect, 0.06 * short_m, {0.5F * ground, 0.0F});
  CanvasRect text = rect.Inset(0.2 * short_m);
  CanvasPoint centre = rect.centre();
  if (random->Uniform() < 0.6 && rect.width_m() > 2.0 * rect.height_m()) {
    const double radius_m = 0.32 * short_m;
    centre = {rect.left_m + 0.5 * short_m, rect.centre().v_m};
    const Colour emblem = SaturatedColour(random);
    canvas->FillEllipse(centre, radius_m, radius_m, {emblem, 0.05F});
    canvas->FillEllipse(centre, 0.5 * radius_m, 0.5 * radius_m, {ink, 0.0F});
    text.left_m = centre.u_m + 1.3 * radius_m;
  }
  PaintWriting(text, {ink, 0.0F}, random, canvas);
  return centre;
}

void PaintPoster(const CanvasRect& rect, Random* random, Canvas* canvas) {
  const Colour low = SaturatedColour(random);
  const Colour high = SaturatedColour(random);
  canvas->ForTexels(rect, [&](double, double v_m, Paint* texel) {
    const auto share = static_cast<float>((v_m - rect.low_m) / rect.height_m());
    *texel = {Mix(low, high, share), 0.05F};
  });
  const int shapes = 3 + static_cast<int>(random->Index(4));
  const CanvasRect inside = rect.Inset(0.12 * rect.width_m());
  for (int i = 0; i < shapes; ++i) {
    const CanvasPoint at = {random->Uniform(inside.left_m, inside.right_m),
                            random->Uniform(inside.low_m, inside.high_m)};
    const double size_m = rect.width_m() * random->Uniform(0.06, 0.12);
    const Paint paint = {SaturatedColour(random), 0.05F};
    if (random->Uniform() < 0.6) {
      canvas->FillEllipse(at, size_m, size_m * random->Uniform(0.6, 1.4), paint);
    } else {
      canvas->FillRect({at.u_m - size_m, at.v_m - size_m, at.u_m + size_m, at.v_m + size_m}, paint);
    }
  }
  const Paint ink = {random->Uniform() < 0.5 ? Grey(0.85F) : Grey(0.04F), 0.05F};
  const double line_m = 0.13 * rect.height_m();
  PaintWriting(
      {inside.left_m, rect.high_m - 1.6 * line_m, inside.right_m, rect.high_m - 0.6 * line_m}, ink,
      random, canvas);
  PaintWriting(
      {inside.left_m, rect.low_m + 0.5 * line_m, inside.right_m, rect.low_m + 1.1 * line_m}, ink,
      random, canvas);
  canvas->FrameRect(rect, 0.03, {Grey(0.6F), 0.0F});
}

}  // namespace lodemark
