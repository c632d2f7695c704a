#include "tools/renderer/window_painting.h"

#include <algorithm>
#include <cmath>

#include "tools/renderer/lettering.h"

namespace lodemark {
namespace {

constexpr float kGlassGloss = 0.75F;

// The shadow that something of a depth throws on what lies behind it.
void Shadow(const CanvasRect& rect, double depth_m, const WindowStyle& style, Canvas* canvas) {
  if (style.shadow_u == 0.0 && style.shadow_v == 0.0) return;
  const double u_m = depth_m * style.shadow_u;
  const double v_m = depth_m * style.shadow_v;
  canvas->Shade({rect.left_m + u_m, rect.low_m - v_m, rect.right_m + u_m, rect.high_m - v_m}, 0.5F);
}

// What is seen in the panes: a dim room, curtains at the sides, a blind from above, a lamp.
void PaintRoom(const CanvasRect& rect, Random* layout, Random* day, Canvas* canvas) {
  const auto room = static_cast<float>(layout->Uniform(0.015, 0.07));
  canvas->FillRect(rect, {{0.9F * room, room, 1.05F * room}, kGlassGloss});
  const double kind = layout->Uniform();
  const double curtain_share = layout->Uniform(0.12, 0.45);
  const Colour cloth = Mix(Grey(0.55F), SaturatedColour(layout), 0.5F);
  const double moved = day->Uniform();
  if (kind < 0.45) {
    const double width_m = curtain_share * rect.width_m();
    for (const bool left : {true, false}) {
      const double from_m = left ? rect.left_m : rect.right_m - width_m;
      for (int fold = 0; fold < 4; ++fold) {
        const auto light = static_cast<float>(0.35 + 0.35 * layout->Uniform());
        canvas->FillRect({from_m + 0.25 * fold * width_m, rect.low_m,
                          from_m + 0.25 * (fold + 1) * width_m, rect.high_m},
                         {light * cloth, 0.5F});
      }
    }
  } else if (kind < 0.75) {
    // A blind: mostly where it always is.
    const double usual = layout->Uniform(0.1, 0.9);
    const double drop = moved < 0.25 ? day->Uniform(0.0, 1.0) : usual;
    const CanvasRect blind = {rect.left_m, rect.high_m - drop * rect.height_m(), rect.right_m,
                              rect.high_m};
    const auto light = static_cast<float>(layout->Uniform(0.25, 0.6));
    canvas->FillRect(blind, {light * Colour{1.0F, 0.97F, 0.9F}, 0.4F});
    for (double v_m = blind.high_m; v_m > blind.low_m; v_m -= 0.12) {
      canvas->FillRect({blind.left_m, v_m - 0.03, blind.right_m, v_m}, {Grey(0.5F * light), 0.4F});
    }
  }
  const bool lit = day->Uniform() < 0.06;
  if (lit) canvas->FillRect(rect, {{0.75F, 0.62F, 0.4F}, 0.3F}, 0.6F);
  // Things on the sill.
  const int things = static_cast<int>(layout->Index(4));
  for (int i = 0; i < things; ++i) {
    const double size_m = layout->Uniform(0.06, 0.16);
    canvas->FillEllipse(
        {layout->Uniform(rect.left_m + size_m, rect.right_m - size_m), rect.low_m + size_m}, size_m,
        1.3 * size_m, {SaturatedColour(layout), 0.3F});
  }
}

}  // namespace

void PaintWindow(const CanvasRect& rect, const WindowStyle& style, Random* layout, Random* day,
                 Canvas* canvas) {
  const double frame_m = style.frame_m;
  if (style.arched) {
    canvas->FillEllipse({rect.centre().u_m, rect.high_m}, 0.5 * rect.width_m() + frame_m,
                        0.35 * rect.width_m() + frame_m, {style.frame, 0.0F});
    canvas->FillEllipse({rect.centre().u_m, rect.high_m}, 0.5 * rect.width_m() - frame_m,
                        0.35 * rect.width_m() - frame_m, {Grey(0.03F), kGlassGloss});
  }
  canvas->FillRect(
      {rect.left_m - frame_m, rect.low_m - frame_m, rect.right_m + frame_m, rect.high_m + frame_m},
      {style.frame, 0.0F});
  PaintRoom(rect, layout, day, canvas);
  for (int i = 1; i < style.panes_across; ++i) {
    const double u_m = rect.left_m + rect.width_m() * i / style.panes_across;
    canvas->FillRect({u_m - 0.4 * frame_m, rect.low_m, u_m + 0.4 * frame_m, rect.high_m},
                     {style.frame, 0.0F});
  }
  for (int i = 1; i < style.panes_up; ++i) {
    const double share = style.panes_up == 2 ? 0.68 : static_cast<double>(i) / style.panes_up;
    const double v_m = rect.low_m + rect.height_m() * share;
    canvas->FillRect({rect.left_m, v_m - 0.4 * frame_m, rect.right_m, v_m + 0.4 * frame_m},
                     {style.frame, 0.0F});
  }
  // The lintel's shadow on panes that lie back, and that of the reveal.
  const double down_m = std::clamp(style.depth_m * style.shadow_v, 0.0, 0.8 * rect.height_m());
  if (down_m > 0.0) {
    canvas->Shade({rect.left_m, rect.high_m - down_m, rect.right_m, rect.high_m}, 0.45F);
    const double side_m =
        std::clamp(style.depth_m * style.shadow_u, -0.8 * rect.width_m(), 0.8 * rect.width_m());
    if (side_m > 0.0) {
      canvas->Shade({rect.left_m, rect.low_m, rect.left_m + side_m, rect.high_m - down_m}, 0.45F);
    } else {
      canvas->Shade({rect.right_m + side_m, rect.low_m, rect.right_m, rect.high_m - down_m}, 0.45F);
    }
  }
  if (style.sill) {
    const CanvasRect sill = {rect.left_m - 0.18, rect.low_m - 0.17, rect.right_m + 0.18,
                             rect.low_m - 0.05};
    Shadow(sill, 0.15, style, canvas);
    canvas->FillRect(sill, {0.9F * style.frame + Grey(0.05F), 0.0F});
    // Rain takes the dirt of the sill down at its ends.
    for (const double u_m : {sill.left_m + 0.06, sill.right_m - 0.06}) {
      const double length_m = layout->Uniform(0.2, 1.3);
      const double width_m = layout->Uniform(0.05, 0.14);
      canvas->Shade({u_m - width_m, sill.low_m - length_m, u_m + width_m, sill.low_m}, 0.82F);
    }
  }
}

CanvasPoint PaintAirConditioner(CanvasPoint low_left, const WindowStyle& style, Random* layout,
                                Canvas* canvas) {
  const double width_m = layout->Uniform(0.8, 1.0);
  const double height_m = layout->Uniform(0.55, 0.7);
  const CanvasRect box = {low_left.u_m, low_left.v_m, low_left.u_m + width_m,
                          low_left.v_m + height_m};
  const auto tone = static_cast<float>(layout->Uniform(0.42, 0.72));
  canvas->Shade(
      {box.left_m + 0.1, box.low_m - layout->Uniform(0.5, 2.5), box.left_m + 0.3, box.low_m},
      0.72F);
  Shadow(box, 0.35, style, canvas);
  canvas->FillRect({box.left_m - 0.05, box.low_m - 0.07, box.right_m + 0.05, box.low_m},
                   {Grey(0.1F), 0.0F});
  canvas->FillRect(box, {{tone, tone, 0.95F * tone}, 0.0F});
  canvas->FrameRect(box, 0.03, {Grey(0.6F * tone), 0.0F});
  const bool left = layout->Uniform() < 0.5;
  const CanvasPoint fan = {box.left_m + (left ? 0.36 : 0.64) * width_m, box.centre().v_m};
  const double radius_m = 0.4 * height_m;
  canvas->FillEllipse(fan, radius_m, radius_m, {Grey(0.05F), 0.0F});
  canvas->FillEllipse(fan, 0.3 * radius_m, 0.3 * radius_m, {Grey(0.8F * tone), 0.0F});
  canvas->FillRect({box.left_m + (left ? 0.76 : 0.06) * width_m, box.low_m + 0.4 * height_m,
                    box.left_m + (left ? 0.92 : 0.22) * width_m, box.low_m + 0.55 * height_m},
                   {SaturatedColour(layout), 0.0F});
  const double pipe_u_m = left ? box.right_m : box.left_m;
  const double away_m = left ? 0.25 : -0.25;
  canvas->Stroke({pipe_u_m, box.low_m + 0.2}, {pipe_u_m + away_m, box.low_m + 0.25}, 0.05,
                 {Grey(0.6F), 0.0F});
  canvas->Stroke({pipe_u_m + away_m, box.low_m + 0.25}, {pipe_u_m + away_m, box.high_m + 0.4}, 0.05,
                 {Grey(0.6F), 0.0F});
  return fan;
}

void PaintBalcony(const CanvasRect& rect, Random* layout, Random* day, Canvas* canvas) {
  canvas->FillRect({rect.left_m - 0.1, rect.low_m - 0.2, rect.right_m + 0.1, rect.low_m},
                   {Grey(0.42F), 0.0F});
  canvas->Shade({rect.left_m - 0.1, rect.low_m - 0.65, rect.right_m + 0.1, rect.low_m - 0.2},
                0.62F);
  // Washing: other pieces every day.
  const int pieces = static_cast<int>(day->Index(5));
  for (int i = 0; i < pieces; ++i) {
    const double left_m = day->Uniform(rect.left_m, rect.right_m - 0.5);
    const double width_m = day->Uniform(0.25, 0.5);
    const double length_m = day->Uniform(0.3, 0.7);
    canvas->FillRect({left_m, rect.high_m + 0.5 - length_m, left_m + width_m, rect.high_m + 0.5},
                     {SaturatedColour(day), 0.0F});
  }
  const Paint rail = {Grey(static_cast<float>(layout->Uniform(0.05, 0.5))), 0.0F};
  const double pitch_m = layout->Uniform(0.12, 0.2);
  for (double u_m = rect.left_m; u_m <= rect.right_m; u_m += pitch_m) {
    canvas->Stroke({u_m, rect.low_m}, {u_m, rect.high_m}, 0.03, rail);
  }
  canvas->Stroke({rect.left_m, rect.high_m}, {rect.right_m, rect.high_m}, 0.07, rail);
  const int pots = static_cast<int>(layout->Index(4));
  for (int i = 0; i < pots; ++i) {
    const double u_m = layout->Uniform(rect.left_m + 0.2, rect.right_m - 0.2);
    canvas->FillEllipse({u_m, rect.low_m + 0.35}, 0.25, 0.3, {{0.06F, 0.15F, 0.04F}, 0.0F});
    canvas->FillRect({u_m - 0.12, rect.low_m, u_m + 0.12, rect.low_m + 0.22},
                     {{0.35F, 0.15F, 0.08F}, 0.0F});
  }
}

CanvasPoint PaintDoor(const CanvasRect& rect, Random* layout, Canvas* canvas) {
  const Colour tone = 0.5F * SaturatedColour(layout);
  canvas->FillRect({rect.left_m - 0.15, rect.low_m, rect.right_m + 0.15, rect.high_m + 0.15},
                   {Grey(static_cast<float>(layout->Uniform(0.25, 0.6))), 0.0F});
  canvas->FillRect(rect, {tone, 0.1F});
  const double middle_m = rect.centre().u_m;
  for (const double left_m : {rect.left_m, middle_m}) {
    const CanvasRect leaf = {left_m + 0.08, rect.low_m + 0.12, left_m + 0.5 * rect.width_m() - 0.08,
                             rect.high_m - 0.12};
    canvas->FrameRect({leaf.left_m, leaf.low_m, leaf.right_m, leaf.low_m + 0.45 * leaf.height_m()},
                      0.05, {0.5F * tone, 0.1F});
    canvas->FillRect({leaf.left_m, leaf.low_m + 0.52 * leaf.height_m(), leaf.right_m, leaf.high_m},
                     {Grey(0.03F), kGlassGloss});
  }
  const CanvasPoint plate = {rect.right_m + 0.5, rect.low_m + 1.8};
  canvas->FillRect({plate.u_m - 0.22, plate.v_m - 0.16, plate.u_m + 0.22, plate.v_m + 0.16},
                   {{0.05F, 0.12F, 0.45F}, 0.1F});
  PaintWriting({plate.u_m - 0.16, plate.v_m - 0.09, plate.u_m + 0.18, plate.v_m + 0.09},
               {Grey(0.85F), 0.0F}, layout, canvas);
  return plate;
}

}  // namespace lodemark
