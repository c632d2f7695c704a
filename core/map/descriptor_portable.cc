#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "core/map/descriptor_kernels.h"

namespace lodemark {
namespace {

std::uint32_t SquaredDistance128(const std::uint8_t* a, const std::uint8_t* b) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < 128; ++i) {
    const std::int32_t difference = a[i] - b[i];
    sum += difference * difference;
  }
  return static_cast<std::uint32_t>(sum);
}

std::uint32_t HammingDistance32(const std::uint8_t* a, const std::uint8_t* b) {
  int bits = 0;
  for (std::size_t i = 0; i < 32; i += 8) {
    std::uint64_t word_a = 0;
    std::uint64_t word_b = 0;
    std::memcpy(&word_a, a + i, 8);
    std::memcpy(&word_b, b + i, 8);
    bits += std::popcount(word_a ^ word_b);
  }
  return static_cast<std::uint32_t>(bits);
}

void HammingDistances(const std::uint8_t* from, const std::uint8_t* others, std::size_t count,
                      std::uint32_t* distances) {
  for (std::size_t i = 0; i < count; ++i) distances[i] = HammingDistance32(from, others + 32 * i);
}

void TileDistances(const DescriptorTile& tile, const TileQueries& queries,
                   const TileAnswers& answers) {
  for (std::size_t query = 0; query < queries.count; ++query) {
    const std::uint8_t* q = queries.descriptors + 128 * query;
    std::int32_t dots[kTileSize] = {};
    const std::int8_t* x = tile.values.data();
    for (std::size_t step = 0; step < 32; ++step, x += 4 * kTileSize) {
      for (std::size_t i = 0; i < kTileSize; ++i) {
        for (std::size_t k = 0; k < 4; ++k) dots[i] += x[4 * i + k] * q[4 * step + k];
      }
    }
    unsigned within = 0;
    std::uint32_t* distances = answers.distances + query * answers.stride;
    for (std::size_t i = 0; i < kTileSize; ++i) {
      distances[i] =
          static_cast<std::uint32_t>(tile.squared_norms[i] + queries.terms[query] - 2 * dots[i]);
      if (distances[i] <= queries.limits[query]) within |= 1U << i;
    }
    answers.within[query] = static_cast<std::uint16_t>(within);
  }
}

std::size_t NearCodes(const std::uint8_t* blocks, std::size_t count, const std::uint8_t* table,
                      std::int32_t limit, NearCode* near) {
  constexpr std::int32_t kLowest = std::numeric_limits<std::int16_t>::min();
  constexpr std::int32_t kHighest = std::numeric_limits<std::int16_t>::max();
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* block = blocks + i / kCodeBlockSize * kCodeBlockBytes;
    const std::size_t within = i % kCodeBlockSize;
    const int term = block[2 * within] | block[2 * within + 1] << 8;
    const std::uint8_t* codes = block + 2 * kCodeBlockSize + CodeBytePosition(within);
    std::int32_t estimate = static_cast<std::int16_t>(term);
    for (std::size_t part = 0; part < kCodeParts; part += 2, codes += kCodeBlockSize) {
      estimate += table[part * kCodesPerPart + (*codes & 15U)];
      estimate += table[(part + 1) * kCodesPerPart + (*codes >> 4U)];
    }
    estimate = std::clamp(estimate, kLowest, kHighest);
    if (estimate < limit) near[found++] = {static_cast<std::uint32_t>(i), estimate};
  }
  return found;
}

}  // namespace

const DescriptorKernels& PortableKernels() {
  static constexpr DescriptorKernels kKernels = {SquaredDistance128, HammingDistance32,
                                                 HammingDistances, TileDistances, NearCodes};
  return kKernels;
}

std::int32_t QueryTerm(const std::uint8_t* descriptor) {
  std::int32_t term = 0;
  for (std::size_t i = 0; i < 128; ++i) term += descriptor[i] * (descriptor[i] - 256);
  return term;
}

void FillTile(const std::uint8_t* descriptors, std::size_t count, DescriptorTile* tile) {
  constexpr std::int32_t kFar = 1 << 30;  // the largest squared distance is below 2^23
  tile->values.fill(0);
  tile->squared_norms.fill(kFar);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* x = descriptors + 128 * i;
    std::int32_t squared_norm = 0;
    for (std::size_t k = 0; k < 128; ++k) {
      tile->values[k / 4 * (4 * kTileSize) + 4 * i + k % 4] = static_cast<std::int8_t>(x[k] - 128);
      squared_norm += x[k] * x[k];
    }
    tile->squared_norms[i] = squared_norm;
  }
}

}  // namespace lodemark
