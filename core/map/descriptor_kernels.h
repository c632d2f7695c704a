// The inner loops on descriptors, written once for each kind of processor. All of them are integer
// arithmetic and give the same numbers; only map includes this.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lodemark {

constexpr std::size_t kTileSize = 16;

// Sixteen 128-byte descriptors, less 128 and interleaved by fours: values[step][descriptor][4].
struct alignas(64) DescriptorTile {
  std::array<std::int8_t, 128 * kTileSize> values;
  std::array<std::int32_t, kTileSize> squared_norms;  // of the descriptors as they were
};

// Many queries against one tile: |x|^2 + |q|^2 - 2 x.q, where x.q is summed up as (x - 128).q.
struct TileQueries {
  const std::uint8_t* descriptors = nullptr;  // one after another
  const std::int32_t* terms = nullptr;        // of each query, by QueryTerm
  const std::uint32_t* limits = nullptr;
  std::size_t count = 0;
};

// distances[query * stride + i] is from the query to descriptor i of the tile. Bit i of
// within[query] says whether it is at most the query's limit.
struct TileAnswers {
  std::uint32_t* distances = nullptr;
  std::size_t stride = kTileSize;
  std::uint16_t* within = nullptr;
};

// Codes of 32 descriptors: their terms, then for each pair of the 32 parts 32 bytes, the code of
// the even part in the low half. Descriptor i lies in byte 2 i, or 2 (i - 16) + 1 from the 16th on.
constexpr std::size_t kCodeBlockSize = 32;
constexpr std::size_t kCodeParts = 32;
constexpr std::size_t kCodesPerPart = 16;
constexpr std::size_t kCodeBlockBytes = 2 * kCodeBlockSize + kCodeBlockSize * kCodeParts / 2;
constexpr std::size_t kCodeTableBytes = kCodeParts * kCodesPerPart;
constexpr std::int32_t kLargestCodeEntry = 127;  // so that two fit a byte

constexpr std::size_t CodeBytePosition(std::size_t i) { return i < 16 ? 2 * i : 2 * (i - 16) + 1; }

struct NearCode {
  std::uint32_t index = 0;
  std::int32_t estimate = 0;  // term plus the table's entries, held within 16 bits
};

struct DescriptorKernels {
  std::uint32_t (*squared_distance)(const std::uint8_t* a, const std::uint8_t* b);
  std::uint32_t (*hamming_distance)(const std::uint8_t* a, const std::uint8_t* b);
  void (*hamming_distances)(const std::uint8_t* from, const std::uint8_t* others, std::size_t count,
                            std::uint32_t* distances);
  void (*tile_distances)(const DescriptorTile& tile, const TileQueries& queries,
                         const TileAnswers& answers);
  // The descriptors of count whose estimate lies below the limit, in order; returns their number.
  // near has room for count of them.
  std::size_t (*near_codes)(const std::uint8_t* blocks, std::size_t count,
                            const std::uint8_t* table, std::int32_t limit, NearCode* near);
};

const DescriptorKernels& PortableKernels();
// Null on processors that lack them.
const DescriptorKernels* Avx2Kernels();
const DescriptorKernels* Avx512Kernels();  // with VNNI
const DescriptorKernels* NeonKernels();
const DescriptorKernels& FastestKernels();

std::int32_t QueryTerm(const std::uint8_t* descriptor);

// A tile of up to sixteen descriptors that lie one after another; the others are further away from
// everything than any descriptor can be.
void FillTile(const std::uint8_t* descriptors, std::size_t count, DescriptorTile* tile);

}  // namespace lodemark
