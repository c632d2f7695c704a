// Which features of a photograph are kept when there are more than can be used.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vision/features.h"

namespace lodemark {

// The most distinct ones of every part of the image: of each cell of a grid the best first, so that
// a bush does not take what the house beside it needs. Gives indices, at most `most` of them, in
// the order larger response, then smaller y, x, angle, size; the order given in matters not.
std::vector<std::uint32_t> SpreadOverImage(std::span<const Keypoint> keypoints, int width_px,
                                           int height_px, int most);

}  // namespace lodemark
