#include "core/map/descriptor_kernels.h"

#if defined(__aarch64__) && defined(__ARM_NEON)

#include <arm_neon.h>

#include <algorithm>

namespace lodemark {
namespace {

std::uint32_t SquaredDistance128(const std::uint8_t* a, const std::uint8_t* b) {
  uint32x4_t sum = vdupq_n_u32(0);
  for (std::size_t i = 0; i < 128; i += 16) {
    const uint8x16_t apart = vabdq_u8(vld1q_u8(a + i), vld1q_u8(b + i));
    sum = vpadalq_u16(sum, vmull_u8(vget_low_u8(apart), vget_low_u8(apart)));
    sum = vpadalq_u16(sum, vmull_u8(vget_high_u8(apart), vget_high_u8(apart)));
  }
  return vaddvq_u32(sum);
}

std::uint32_t HammingDistance32(const std::uint8_t* a, const std::uint8_t* b) {
  const uint8x16_t low = vcntq_u8(veorq_u8(vld1q_u8(a), vld1q_u8(b)));
  const uint8x16_t high = vcntq_u8(veorq_u8(vld1q_u8(a + 16), vld1q_u8(b + 16)));
  return vaddlvq_u8(vaddq_u8(low, high));
}

void HammingDistances(const std::uint8_t* from, const std::uint8_t* others, std::size_t count,
                      std::uint32_t* distances) {
  for (std::size_t i = 0; i < count; ++i) distances[i] = HammingDistance32(from, others + 32 * i);
}

// Four descriptors of the tile, from the one at first on, against kQueries queries. The tile's
// values get their 128 back, so that the products are unsigned; they fit 16 bits.
template <std::size_t kQueries>
void QuarterTile(const DescriptorTile& tile, std::size_t first, const std::uint8_t* queries,
                 uint32x4_t* dots) {
  uint32x4_t low[kQueries];
  uint32x4_t high[kQueries];
  for (std::size_t i = 0; i < kQueries; ++i) low[i] = high[i] = vdupq_n_u32(0);
  const std::int8_t* values = tile.values.data() + 4 * first;
  for (std::size_t step = 0; step < 32; ++step, values += 4 * kTileSize) {
    const uint8x16_t x = veorq_u8(vreinterpretq_u8_s8(vld1q_s8(values)), vdupq_n_u8(128));
    for (std::size_t i = 0; i < kQueries; ++i) {
      std::uint32_t four = 0;
      __builtin_memcpy(&four, queries + 128 * i + 4 * step, 4);
      const uint8x8_t q = vreinterpret_u8_u32(vdup_n_u32(four));
      low[i] = vpadalq_u16(low[i], vmull_u8(vget_low_u8(x), q));
      high[i] = vpadalq_u16(high[i], vmull_u8(vget_high_u8(x), q));
    }
  }
  for (std::size_t i = 0; i < kQueries; ++i) dots[i] = vpaddq_u32(low[i], high[i]);
}

template <std::size_t kQueries>
void WholeTile(const DescriptorTile& tile, const TileQueries& queries, const TileAnswers& answers,
               std::size_t first_query) {
  const std::uint8_t* descriptors = queries.descriptors + 128 * first_query;
  // terms hold |q|^2 - 256 sum(q) for the shifted tile; here the sum is not wanted.
  std::uint32_t squared_norms[kQueries];
  std::uint32_t within[kQueries] = {};
  for (std::size_t i = 0; i < kQueries; ++i) {
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < 128; k += 16)
      sum += vaddlvq_u8(vld1q_u8(descriptors + 128 * i + k));
    squared_norms[i] = static_cast<std::uint32_t>(queries.terms[first_query + i]) + 256 * sum;
  }
  for (std::size_t first = 0; first < kTileSize; first += 4) {
    uint32x4_t dots[kQueries];
    QuarterTile<kQueries>(tile, first, descriptors, dots);
    const uint32x4_t norms = vreinterpretq_u32_s32(vld1q_s32(tile.squared_norms.data() + first));
    for (std::size_t i = 0; i < kQueries; ++i) {
      const std::size_t query = first_query + i;
      const uint32x4_t sum = vaddq_u32(norms, vdupq_n_u32(squared_norms[i]));
      const uint32x4_t distances = vsubq_u32(sum, vshlq_n_u32(dots[i], 1));
      vst1q_u32(answers.distances + query * answers.stride + first, distances);
      const uint32x4_t near = vcleq_u32(distances, vdupq_n_u32(queries.limits[query]));
      const std::uint32_t bit_values[4] = {1, 2, 4, 8};
      within[i] |= vaddvq_u32(vandq_u32(near, vld1q_u32(bit_values))) << first;
    }
  }
  for (std::size_t i = 0; i < kQueries; ++i) {
    answers.within[first_query + i] = static_cast<std::uint16_t>(within[i]);
  }
}

void TileDistances(const DescriptorTile& tile, const TileQueries& queries,
                   const TileAnswers& answers) {
  std::size_t query = 0;
  for (; query + 4 <= queries.count; query += 4) WholeTile<4>(tile, queries, answers, query);
  for (; query < queries.count; ++query) WholeTile<1>(tile, queries, answers, query);
}

// Sixteen bytes of one pair of parts; even bytes belong to descriptors 0..15 of the block.
struct CodeSums {
  uint16x8_t even;
  uint16x8_t odd;

  void Add(uint8x16_t codes, uint8x16_t table0, uint8x16_t table1) {
    const uint8x16_t sum = vaddq_u8(vqtbl1q_u8(table0, vandq_u8(codes, vdupq_n_u8(15))),
                                    vqtbl1q_u8(table1, vshrq_n_u8(codes, 4)));
    const uint16x8_t pairs = vreinterpretq_u16_u8(sum);
    even = vaddq_u16(even, vandq_u16(pairs, vdupq_n_u16(255)));
    odd = vaddq_u16(odd, vshrq_n_u16(pairs, 8));
  }
};

std::size_t NearCodes(const std::uint8_t* blocks, std::size_t count, const std::uint8_t* table,
                      std::int32_t limit, NearCode* near) {
  std::size_t found = 0;
  for (std::size_t first = 0; first < count; first += kCodeBlockSize, blocks += kCodeBlockBytes) {
    const std::uint8_t* codes = blocks + 2 * kCodeBlockSize;
    CodeSums sums[2];
    for (CodeSums& sum : sums) sum.even = sum.odd = vdupq_n_u16(0);
    for (std::size_t part = 0; part < kCodeParts; part += 2, codes += kCodeBlockSize) {
      const uint8x16_t table0 = vld1q_u8(table + part * kCodesPerPart);
      const uint8x16_t table1 = vld1q_u8(table + (part + 1) * kCodesPerPart);
      sums[0].Add(vld1q_u8(codes), table0, table1);
      sums[1].Add(vld1q_u8(codes + 16), table0, table1);
    }
    std::int16_t estimates[kCodeBlockSize];
    std::int16_t lowest = 32767;
    for (std::size_t i = 0; i < 4; ++i) {
      const uint16x8_t sum = i < 2 ? sums[i].even : sums[i - 2].odd;
      const int16x8_t terms = vreinterpretq_s16_u8(vld1q_u8(blocks + 16 * i));
      const int16x8_t estimate = vqaddq_s16(vreinterpretq_s16_u16(sum), terms);
      vst1q_s16(estimates + 8 * i, estimate);
      lowest = std::min(lowest, vminvq_s16(estimate));
    }
    if (lowest >= limit) continue;
    const std::size_t here = std::min(count - first, kCodeBlockSize);
    for (std::size_t i = 0; i < here; ++i) {
      if (estimates[i] < limit)
        near[found++] = {static_cast<std::uint32_t>(first + i), estimates[i]};
    }
  }
  return found;
}

}  // namespace

const DescriptorKernels* NeonKernels() {
  static constexpr DescriptorKernels kKernels = {SquaredDistance128, HammingDistance32,
                                                 HammingDistances, TileDistances, NearCodes};
  return &kKernels;
}

}  // namespace lodemark

#else

namespace lodemark {

const DescriptorKernels* NeonKernels() { return nullptr; }

}  // namespace lodemark

#endif
