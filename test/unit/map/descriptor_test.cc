#include "core/map/descriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/map/descriptor_kernels.h"

namespace lodemark {
namespace {

std::vector<std::uint8_t> RandomBytes(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint8_t> bytes(count);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.NextBits() >> 56);
  return bytes;
}

std::uint32_t SquaredByHand(const std::uint8_t* a, const std::uint8_t* b) {
  std::uint32_t sum = 0;
  for (int i = 0; i < 128; ++i) {
    sum += static_cast<std::uint32_t>((a[i] - b[i]) * (a[i] - b[i]));
  }
  return sum;
}

std::uint32_t BitsByHand(const std::uint8_t* a, const std::uint8_t* b) {
  int bits = 0;
  for (int i = 0; i < 32; ++i) bits += std::popcount(static_cast<std::uint8_t>(a[i] ^ b[i]));
  return static_cast<std::uint32_t>(bits);
}

// Those this processor has, by name.
std::vector<std::pair<const char*, const DescriptorKernels*>> AllKernels() {
  std::vector<std::pair<const char*, const DescriptorKernels*>> all;
  all.emplace_back("portable", &PortableKernels());
  if (Avx2Kernels() != nullptr) all.emplace_back("AVX2", Avx2Kernels());
  if (Avx512Kernels() != nullptr) all.emplace_back("AVX-512", Avx512Kernels());
  if (NeonKernels() != nullptr) all.emplace_back("NEON", NeonKernels());
  return all;
}

TEST(Descriptor, DistancesAreThoseCountedByHand) {
  // An odd start, so that nothing relies on alignment.
  const std::vector<std::uint8_t> bytes = RandomBytes(1 + 128 * 40, 1);
  for (const auto& [name, kernels] : AllKernels()) {
    for (std::size_t i = 0; i < 39; ++i) {
      const std::uint8_t* a = bytes.data() + 1 + 128 * i;
      const std::uint8_t* b = a + 128;
      EXPECT_EQ(kernels->squared_distance(a, b), SquaredByHand(a, b)) << name;
      EXPECT_EQ(kernels->hamming_distance(a, b), BitsByHand(a, b)) << name;
    }
  }
  EXPECT_EQ(SquaredDistance(bytes.data(), bytes.data() + 128),
            SquaredByHand(bytes.data(), bytes.data() + 128));
  EXPECT_EQ(HammingDistance(bytes.data(), bytes.data() + 128),
            BitsByHand(bytes.data(), bytes.data() + 128));
}

TEST(Descriptor, DistancesReachTheirLargestValues) {
  const std::vector<std::uint8_t> zeros(128, 0);
  const std::vector<std::uint8_t> full(128, 255);
  for (const auto& [name, kernels] : AllKernels()) {
    EXPECT_EQ(kernels->squared_distance(zeros.data(), full.data()), 128U * 255U * 255U) << name;
    EXPECT_EQ(kernels->squared_distance(full.data(), full.data()), 0U) << name;
    EXPECT_EQ(kernels->hamming_distance(full.data(), zeros.data()), 256U) << name;
  }
}

TEST(Descriptor, ManyDistancesAreThoseOneByOne) {
  const std::vector<std::uint8_t> bytes = RandomBytes(128 * 38, 2);
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    std::vector<std::uint32_t> distances(37);
    DistancesTo(kind, bytes.data(), bytes.data() + 128, 37, distances.data());
    for (std::size_t i = 0; i < 37; ++i) {
      const std::uint8_t* other = bytes.data() + 128 + i * DescriptorBytes(kind);
      EXPECT_EQ(distances[i], kind == DescriptorKind::kOrb ? BitsByHand(bytes.data(), other)
                                                           : SquaredByHand(bytes.data(), other));
    }
  }
}

TEST(DescriptorKernels, TilesGiveTheDistancesOneByOne) {
  constexpr std::size_t kQueries = 27;  // not a multiple of what any kernel takes together
  std::vector<std::uint8_t> queries = RandomBytes(128 * kQueries, 3);
  std::fill_n(queries.begin(), 128, std::uint8_t{255});
  std::vector<std::uint8_t> others = RandomBytes(128 * kTileSize, 4);
  std::fill_n(others.begin(), 128, std::uint8_t{0});
  std::fill_n(others.begin() + 128, 128, std::uint8_t{255});
  std::vector<std::int32_t> terms;
  std::vector<std::uint32_t> limits;
  for (std::size_t i = 0; i < kQueries; ++i) {
    terms.push_back(QueryTerm(queries.data() + 128 * i));
    limits.push_back(SquaredByHand(queries.data() + 128 * i, others.data() + 128 * (i % 13)));
  }
  for (const std::size_t held : {kTileSize, std::size_t{13}}) {
    DescriptorTile tile;
    FillTile(others.data(), held, &tile);
    for (const auto& [name, kernels] : AllKernels()) {
      std::vector<std::uint32_t> distances(kQueries * 20);
      std::vector<std::uint16_t> within(kQueries);
      kernels->tile_distances(tile, {queries.data(), terms.data(), limits.data(), kQueries},
                              {distances.data(), 20, within.data()});
      for (std::size_t i = 0; i < kQueries * kTileSize; ++i) {
        const std::size_t query = i / kTileSize;
        const std::size_t k = i % kTileSize;
        const std::uint32_t expected =
            SquaredByHand(queries.data() + 128 * query, others.data() + 128 * k);
        const bool near = k < held && expected <= limits[query];
        EXPECT_EQ(within[query] >> k & 1, near ? 1 : 0) << name;
        if (k < held) {
          EXPECT_EQ(distances[query * 20 + k], expected) << name;
        }
      }
    }
  }
}

TEST(DescriptorKernels, CodesAreSummedAlikeOnEveryProcessor) {
  constexpr std::size_t kCount = 3 * kCodeBlockSize + 5;
  const std::vector<std::uint8_t> blocks = RandomBytes(4 * kCodeBlockBytes, 5);
  std::vector<std::uint8_t> table = RandomBytes(kCodeTableBytes, 6);
  for (std::uint8_t& entry : table) entry &= kLargestCodeEntry;
  std::vector<std::int32_t> sums;
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::uint8_t* block = blocks.data() + i / 32 * kCodeBlockBytes;
    std::int32_t sum =
        static_cast<std::int16_t>(block[2 * (i % 32)] | block[2 * (i % 32) + 1] << 8);
    for (std::size_t part = 0; part < kCodeParts; ++part) {
      const int pair = block[64 + part / 2 * 32 + CodeBytePosition(i % 32)];
      sum += table[part * 16 + static_cast<std::size_t>(part % 2 == 0 ? pair & 15 : pair >> 4)];
    }
    sums.push_back(std::min(sum, 32767));
  }
  for (const auto& [name, kernels] : AllKernels()) {
    for (const std::int32_t limit : {-50'000, -32'768, -1'000, 4'000, 32'767, 32'768, 50'000}) {
      std::vector<NearCode> near(kCount);
      near.resize(kernels->near_codes(blocks.data(), kCount, table.data(), limit, near.data()));
      std::size_t next = 0;
      for (std::size_t i = 0; i < kCount; ++i) {
        if (sums[i] >= limit) continue;
        ASSERT_LT(next, near.size()) << name;
        EXPECT_EQ(near[next].index, i) << name;
        EXPECT_EQ(near[next].estimate, sums[i]) << name;
        ++next;
      }
      EXPECT_EQ(next, near.size()) << name;
    }
  }
}

}  // namespace
}  // namespace lodemark
