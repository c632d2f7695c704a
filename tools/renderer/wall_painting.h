// The bare wall: bricks, blocks, plaster, tiles, panels, leaves, and the weather on it.
#pragma once

#include "core/base/random.h"
#include "tools/renderer/canvas.h"
#include "tools/renderer/scene.h"

namespace lodemark {

// The tone of a building of this kind.
Colour WallTone(FacadeKind kind, Random* building);

void PaintWall(FacadeKind kind, const Colour& tone, Random* random, Canvas* canvas);

// Dirt and damp over all that was painted: clouds of it, streaks that run down, a dark foot.
void PaintWeather(float strength, Random* random, Canvas* canvas);

// Ivy over a rectangle, thicker below; the share of leaves that winter leaves.
void PaintLeaves(const CanvasRect& rect, double per_m2, double leaf_share, Random* random,
                 Canvas* canvas);

}  // namespace lodemark
