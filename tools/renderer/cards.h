// Flat pictures with transparent surroundings: trees and passers-by.
#pragma once

#include "tools/renderer/canvas.h"
#include "tools/renderer/scene.h"

namespace lodemark {

// As wide as 0.8 of its height; in winter without leaves. Alpha is how much of it is there.
Canvas PaintTree(double height_m, std::uint64_t seed, const Daylight& day, double texel_m);

// 0.8 m wide, 1.85 m high.
Canvas PaintPerson(std::uint64_t seed, double texel_m);

}  // namespace lodemark
