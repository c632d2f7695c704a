#include "core/map/descriptor_kernels.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <cstring>

#define LODEMARK_AVX512 __attribute__((target("avx512f,avx512bw,avx512vl,avx512vnni")))

namespace lodemark {
namespace {

template <std::size_t kQueries>
LODEMARK_AVX512 void WholeTile(const DescriptorTile& tile, const TileQueries& queries,
                               const TileAnswers& answers, std::size_t first_query) {
  __m512i dots[kQueries];
  for (__m512i& dot : dots) dot = _mm512_setzero_si512();
  const std::uint8_t* q = queries.descriptors + 128 * first_query;
#pragma GCC unroll 32
  for (std::size_t step = 0; step < 32; ++step) {
    const __m512i x = _mm512_load_si512(tile.values.data() + step * 4 * kTileSize);
    for (std::size_t i = 0; i < kQueries; ++i) {
      std::int32_t four = 0;
      std::memcpy(&four, q + 128 * i + 4 * step, 4);
      dots[i] = _mm512_dpbusd_epi32(dots[i], _mm512_set1_epi32(four), x);
    }
  }
  const __m512i norms = _mm512_load_si512(tile.squared_norms.data());
  for (std::size_t i = 0; i < kQueries; ++i) {
    const std::size_t query = first_query + i;
    const __m512i sum = _mm512_add_epi32(norms, _mm512_set1_epi32(queries.terms[query]));
    const __m512i distances = _mm512_sub_epi32(sum, _mm512_add_epi32(dots[i], dots[i]));
    _mm512_storeu_si512(answers.distances + query * answers.stride, distances);
    const __m512i limit = _mm512_set1_epi32(static_cast<std::int32_t>(queries.limits[query]));
    answers.within[query] = _mm512_cmple_epu32_mask(distances, limit);
  }
}

LODEMARK_AVX512 void TileDistances(const DescriptorTile& tile, const TileQueries& queries,
                                   const TileAnswers& answers) {
  std::size_t query = 0;
  for (; query + 16 <= queries.count; query += 16) WholeTile<16>(tile, queries, answers, query);
  for (; query + 4 <= queries.count; query += 4) WholeTile<4>(tile, queries, answers, query);
  for (; query < queries.count; ++query) WholeTile<1>(tile, queries, answers, query);
}

DescriptorKernels WithTiles() {
  DescriptorKernels kernels = PortableKernels();
  if (const DescriptorKernels* avx2 = Avx2Kernels()) kernels = *avx2;
  kernels.tile_distances = TileDistances;
  return kernels;
}

}  // namespace

const DescriptorKernels* Avx512Kernels() {
  static const DescriptorKernels kernels = WithTiles();
  const bool supported = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vnni");
  return supported ? &kernels : nullptr;
}

}  // namespace lodemark

#else

namespace lodemark {

const DescriptorKernels* Avx512Kernels() { return nullptr; }

}  // namespace lodemark

#endif
