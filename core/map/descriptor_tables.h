// What a DescriptorQuantizer knows, and the layout of a packed list; only map includes this.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/map/descriptor_index.h"
#include "core/map/descriptor_kernels.h"

namespace lodemark {

// Squared distances are estimated in units of this.
constexpr std::int32_t kEstimateUnit = 512;

// A descriptor less the centre of its cell is spelt as 32 parts of four bytes, each of which is
// replaced by the nearest of sixteen.
struct DescriptorCodebook {
  static constexpr std::size_t kPartBytes = 4;

  // values[part][code][4]
  std::array<std::int8_t, kCodeParts * kCodesPerPart * kPartBytes> values = {};

  const std::int8_t* Word(std::size_t part, std::size_t code) const {
    return values.data() + (part * kCodesPerPart + code) * kPartBytes;
  }
};

struct DescriptorQuantizer::Tables {
  DescriptorKind kind = DescriptorKind::kRootSift;
  std::size_t lists = 1;
  std::vector<std::uint8_t> centres;  // descriptors, one for each list
  bool coded = false;                 // whether lists hold codes
  DescriptorCodebook codebook;

  // Made from the above.
  std::vector<DescriptorTile> tiles;  // of the centres, if not binary

  const std::uint8_t* Centre(std::size_t list) const {
    return centres.data() + list * DescriptorBytes(kind);
  }
};

// A block: magic "LMDL", version, kind, whether it has codes, 0, the number n of descriptors (four
// bytes), four bytes 0; then n landmark ids and n image ids of four bytes, n directions and n
// distances of two, n descriptors, and the codes of whole blocks of 32. Least significant byte
// first.
constexpr std::size_t kListHeaderBytes = 16;
constexpr std::size_t kOriginBytes = 12;

constexpr std::uint64_t CodeBytes(std::uint64_t count) {
  return (count + kCodeBlockSize - 1) / kCodeBlockSize * kCodeBlockBytes;
}

inline void StoreBytes(std::uint32_t value, int bytes, std::uint8_t* to) {
  for (int i = 0; i < bytes; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

inline std::uint32_t LoadU32(const std::uint8_t* from) {
  return static_cast<std::uint32_t>(from[0]) | static_cast<std::uint32_t>(from[1]) << 8 |
         static_cast<std::uint32_t>(from[2]) << 16 | static_cast<std::uint32_t>(from[3]) << 24;
}

inline std::uint32_t LoadU16(const std::uint8_t* from) {
  return static_cast<std::uint32_t>(from[0]) | static_cast<std::uint32_t>(from[1]) << 8;
}

std::vector<DescriptorTile> TilesOf(std::span<const std::uint8_t> descriptors);

}  // namespace lodemark
