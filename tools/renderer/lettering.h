// Marks like writing: characters that no alphabet has, signs and posters full of them.
#pragma once

#include "core/base/random.h"
#include "tools/renderer/canvas.h"

namespace lodemark {

// A line of characters, each as high as the rectangle, from the left until it is full; a standing
// rectangle is written from top to bottom.
void PaintWriting(const CanvasRect& rect, const Paint& ink, Random* random, Canvas* canvas);

// A shop's sign: a ground, a border, an emblem now and then, writing. Gives the emblem's centre, or
// that of the sign.
CanvasPoint PaintSign(const CanvasRect& rect, Random* random, Canvas* canvas);

// A poster: a picture of a few bold shapes, and writing.
void PaintPoster(const CanvasRect& rect, Random* random, Canvas* canvas);

// A strong colour, as paint on metal is.
Colour SaturatedColour(Random* random);

}  // namespace lodemark
