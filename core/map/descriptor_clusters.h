// Sorts descriptors into cells around centres, and finds such centres.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/map/descriptor.h"
#include "core/map/descriptor_kernels.h"

namespace lodemark {

// For each descriptor the nearest centre; of equals the first. By tiles of centres for bytes, by
// the centres themselves for bits.
void NearestByTiles(std::span<const std::uint8_t> descriptors,
                    std::span<const DescriptorTile> tiles, std::uint32_t* nearest);
void NearestByBits(std::span<const std::uint8_t> descriptors, std::span<const std::uint8_t> centres,
                   std::uint32_t* nearest);
std::vector<std::uint32_t> NearestCentres(DescriptorKind kind,
                                          std::span<const std::uint8_t> descriptors,
                                          std::span<const std::uint8_t> centres);

// Lloyd's iteration in integers: a centre is the rounded mean of its members, or of bits what the
// majority has. Starts from descriptors drawn at random; a centre that loses all its members moves
// to a descriptor drawn anew. Needs at least one descriptor, and no more centres than descriptors.
std::vector<std::uint8_t> FindCentres(DescriptorKind kind,
                                      std::span<const std::uint8_t> descriptors, std::size_t count,
                                      Random& random);

}  // namespace lodemark
