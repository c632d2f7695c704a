// Windows and what hangs beside them.
#pragma once

#include <vector>

#include "core/base/random.h"
#include "tools/renderer/canvas.h"

namespace lodemark {

// What the windows of a wall have in common.
struct WindowStyle {
  Colour frame = Grey(0.7F);
  int panes_across = 2;
  int panes_up = 2;
  double frame_m = 0.07;
  bool arched = false;
  bool sill = true;
  float depth_m = 0.18F;  // of the reveal: it throws a shadow
  double shadow_u = 0.0;  // of 1 m of depth
  double shadow_v = 0.0;
};

// layout decides what is there for good, day what changes: blinds, lights, curtains.
void PaintWindow(const CanvasRect& rect, const WindowStyle& style, Random* layout, Random* day,
                 Canvas* canvas);

// The outer part of an air conditioner, its pipe and the damp below. Gives the middle of its fan.
CanvasPoint PaintAirConditioner(CanvasPoint low_left, const WindowStyle& style, Random* layout,
                                Canvas* canvas);

// A railing before a door on an upper floor, with what people keep there.
void PaintBalcony(const CanvasRect& rect, Random* layout, Random* day, Canvas* canvas);

// A front door with a frame, panels and a number plate, whose middle it gives.
CanvasPoint PaintDoor(const CanvasRect& rect, Random* layout, Canvas* canvas);

}  // namespace lodemark
