// A smaller map that serves nearly as well: the landmarks that matter.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/mapping/map_content.h"

namespace lodemark {

// Keeps a share of the landmarks, 0 .. 1, at least one; their descriptors; all images. Greedy cover
// in the manner of Li, Snavely, Huttenlocher (2010), "Location recognition using prioritized
// feature matching": every database image, and every part of it, is to keep enough landmarks, and
// the often seen come first. Descriptors without an image count by what they share with their
// landmark's neighbours in space. Deterministic.
void KeepBestLandmarks(double share, MapContent* content);

// The order in which landmarks are chosen: indices into content.landmarks.
std::vector<std::uint32_t> RankLandmarks(const MapContent& content, std::size_t count);

}  // namespace lodemark
