// How one wall of a building looks.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/renderer/canvas.h"
#include "tools/renderer/scene.h"

namespace lodemark {

// What decides a wall's looks. Without its day, the wall is that of any day.
struct FacadeDesign {
  FacadeKind kind = FacadeKind::kPlaster;
  double width_m = 20.0;
  double height_m = 15.0;
  std::uint64_t building_seed = 1;  // of the colours
  int wall = 0;                     // its number in the building: of everything else
  double sun_slope_u = 0.0;         // how far the shadow of what stands out by 1 m falls aside
  double sun_slope_v = 0.0;         // and down; 0 without sun
};

// A painted wall, and the middles of things that stay where they are and that a surveyor would
// pick: fans, emblems, plates.
struct PaintedFacade {
  Canvas canvas;
  std::vector<CanvasPoint> distinct_points;
};

// The same for the same arguments. The day decides blinds, lights, posters and leaves, and nothing
// of where things are.
PaintedFacade PaintFacade(const FacadeDesign& design, const Daylight& day, double texel_m);

}  // namespace lodemark
