#include "core/map/descriptor_kernels.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cstring>

#define LODEMARK_AVX2 __attribute__((target("avx2,popcnt")))

namespace lodemark {
namespace {

LODEMARK_AVX2 __m256i Load(const void* from) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(from));
}

LODEMARK_AVX2 std::uint32_t SquaredDistance128(const std::uint8_t* a, const std::uint8_t* b) {
  const __m256i zero = _mm256_setzero_si256();
  __m256i sum = zero;
  for (std::size_t i = 0; i < 128; i += 32) {
    const __m256i x = Load(a + i);
    const __m256i y = Load(b + i);
    const __m256i apart = _mm256_or_si256(_mm256_subs_epu8(x, y), _mm256_subs_epu8(y, x));
    const __m256i low = _mm256_unpacklo_epi8(apart, zero);
    const __m256i high = _mm256_unpackhi_epi8(apart, zero);
    sum = _mm256_add_epi32(sum, _mm256_madd_epi16(low, low));
    sum = _mm256_add_epi32(sum, _mm256_madd_epi16(high, high));
  }
  __m128i half = _mm_add_epi32(_mm256_castsi256_si128(sum), _mm256_extracti128_si256(sum, 1));
  half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0x4e));
  half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0xb1));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(half));
}

LODEMARK_AVX2 std::uint32_t HammingDistance32(const std::uint8_t* a, const std::uint8_t* b) {
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

LODEMARK_AVX2 void HammingDistances(const std::uint8_t* from, const std::uint8_t* others,
                                    std::size_t count, std::uint32_t* distances) {
  for (std::size_t i = 0; i < count; ++i) distances[i] = HammingDistance32(from, others + 32 * i);
}

// Eight descriptors of the tile, from the one at first on, against queries widened to 16 bits.
template <std::size_t kQueries>
LODEMARK_AVX2 void HalfTile(const DescriptorTile& tile, std::size_t first,
                            const std::int16_t* queries, __m256i* dots) {
  __m256i sums[kQueries][2];
  for (auto& sum : sums) sum[0] = sum[1] = _mm256_setzero_si256();
  const std::int8_t* x = tile.values.data() + 4 * first;
  for (std::size_t step = 0; step < 32; ++step, x += 4 * kTileSize) {
    const __m256i bytes = Load(x);
    const __m256i x0 = _mm256_cvtepi8_epi16(_mm256_castsi256_si128(bytes));
    const __m256i x1 = _mm256_cvtepi8_epi16(_mm256_extracti128_si256(bytes, 1));
    for (std::size_t query = 0; query < kQueries; ++query) {
      long long four = 0;
      std::memcpy(&four, queries + 128 * query + 4 * step, 8);
      const __m256i q = _mm256_set1_epi64x(four);
      sums[query][0] = _mm256_add_epi32(sums[query][0], _mm256_madd_epi16(x0, q));
      sums[query][1] = _mm256_add_epi32(sums[query][1], _mm256_madd_epi16(x1, q));
    }
  }
  for (std::size_t query = 0; query < kQueries; ++query) {
    const __m256i paired = _mm256_hadd_epi32(sums[query][0], sums[query][1]);
    dots[query] = _mm256_permute4x64_epi64(paired, 0xd8);
  }
}

template <std::size_t kQueries>
LODEMARK_AVX2 void WholeTile(const DescriptorTile& tile, const TileQueries& queries,
                             const TileAnswers& answers, std::size_t first_query) {
  alignas(32) std::int16_t widened[128 * kQueries];
  const std::uint8_t* descriptors = queries.descriptors + 128 * first_query;
  for (std::size_t i = 0; i < 128 * kQueries; i += 16) {
    const __m128i narrow = _mm_loadu_si128(reinterpret_cast<const __m128i*>(descriptors + i));
    _mm256_store_si256(reinterpret_cast<__m256i*>(widened + i), _mm256_cvtepu8_epi16(narrow));
  }
  std::uint32_t within[kQueries] = {};
  for (std::size_t first = 0; first < kTileSize; first += 8) {
    __m256i dots[kQueries];
    HalfTile<kQueries>(tile, first, widened, dots);
    for (std::size_t i = 0; i < kQueries; ++i) {
      const std::size_t query = first_query + i;
      const __m256i norms = _mm256_add_epi32(Load(tile.squared_norms.data() + first),
                                             _mm256_set1_epi32(queries.terms[query]));
      const __m256i distances = _mm256_sub_epi32(norms, _mm256_add_epi32(dots[i], dots[i]));
      _mm256_storeu_si256(
          reinterpret_cast<__m256i*>(answers.distances + query * answers.stride + first),
          distances);
      const __m256i limit = _mm256_set1_epi32(static_cast<std::int32_t>(queries.limits[query]));
      const __m256i near = _mm256_cmpeq_epi32(_mm256_min_epu32(distances, limit), distances);
      const int mask = _mm256_movemask_ps(_mm256_castsi256_ps(near));
      within[i] |= static_cast<std::uint32_t>(mask) << first;
    }
  }
  for (std::size_t i = 0; i < kQueries; ++i) {
    answers.within[first_query + i] = static_cast<std::uint16_t>(within[i]);
  }
}

LODEMARK_AVX2 void TileDistances(const DescriptorTile& tile, const TileQueries& queries,
                                 const TileAnswers& answers) {
  std::size_t query = 0;
  for (; query + 4 <= queries.count; query += 4) WholeTile<4>(tile, queries, answers, query);
  for (; query < queries.count; ++query) WholeTile<1>(tile, queries, answers, query);
}

LODEMARK_AVX2 std::size_t NearCodes(const std::uint8_t* blocks, std::size_t count,
                                    const std::uint8_t* table, std::int32_t limit, NearCode* near) {
  // An estimate is at most 32767, so a limit above that passes it; one at or below -32768 nothing.
  if (limit <= -32768) return 0;
  const bool all = limit > 32767;
  const __m256i limits = _mm256_set1_epi16(static_cast<std::int16_t>(all ? 32767 : limit));
  const __m256i low_half = _mm256_set1_epi8(15);
  std::size_t found = 0;
  for (std::size_t first = 0; first < count; first += kCodeBlockSize, blocks += kCodeBlockBytes) {
    const std::uint8_t* codes = blocks + 2 * kCodeBlockSize;
    const std::uint8_t* entries = table;
    __m256i both = _mm256_setzero_si256();  // modulo 2^16: even bytes plus 256 times the odd ones
    __m256i odd = _mm256_setzero_si256();
    for (std::size_t part = 0; part < kCodeParts; part += 2) {
      const __m256i pair = Load(codes);
      const __m256i table0 =
          _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(entries)));
      const __m256i table1 = _mm256_broadcastsi128_si256(
          _mm_loadu_si128(reinterpret_cast<const __m128i*>(entries + kCodesPerPart)));
      const __m256i sum0 = _mm256_shuffle_epi8(table0, _mm256_and_si256(pair, low_half));
      const __m256i sum1 =
          _mm256_shuffle_epi8(table1, _mm256_and_si256(_mm256_srli_epi16(pair, 4), low_half));
      const __m256i sum = _mm256_add_epi8(sum0, sum1);
      both = _mm256_add_epi16(both, sum);
      odd = _mm256_add_epi16(odd, _mm256_srli_epi16(sum, 8));
      codes += kCodeBlockSize;
      entries += 2 * kCodesPerPart;
    }
    const __m256i even = _mm256_sub_epi16(both, _mm256_slli_epi16(odd, 8));
    const __m256i estimates[2] = {_mm256_adds_epi16(even, Load(blocks)),
                                  _mm256_adds_epi16(odd, Load(blocks + 32))};
    const __m256i below0 = _mm256_cmpgt_epi16(limits, estimates[0]);
    const __m256i below1 = _mm256_cmpgt_epi16(limits, estimates[1]);
    const __m256i packed = _mm256_permute4x64_epi64(_mm256_packs_epi16(below0, below1), 0xd8);
    std::uint32_t mask = static_cast<std::uint32_t>(_mm256_movemask_epi8(packed));
    if (all) mask = 0xffffffffU;
    const std::size_t left = count - first;
    if (left < kCodeBlockSize) mask &= (1U << left) - 1U;
    if (mask == 0) continue;
    alignas(32) std::int16_t values[kCodeBlockSize];
    std::memcpy(values, estimates, sizeof values);
    for (; mask != 0; mask &= mask - 1U) {
      const std::uint32_t i = static_cast<std::uint32_t>(std::countr_zero(mask));
      near[found++] = {static_cast<std::uint32_t>(first) + i, values[i]};
    }
  }
  return found;
}

}  // namespace

const DescriptorKernels* Avx2Kernels() {
  static constexpr DescriptorKernels kKernels = {SquaredDistance128, HammingDistance32,
                                                 HammingDistances, TileDistances, NearCodes};
  const bool supported = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");
  return supported ? &kKernels : nullptr;
}

}  // namespace lodemark

#else

namespace lodemark {

const DescriptorKernels* Avx2Kernels() { return nullptr; }

}  // namespace lodemark

#endif
