#include "core/map/descriptor_clusters.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "core/map/descriptor_kernels.h"
#include "core/map/descriptor_tables.h"

namespace lodemark {
namespace {

constexpr int kIterations = 10;
constexpr std::uint32_t kFarthest = std::numeric_limits<std::uint32_t>::max();

// Many at a time, so that a tile of centres is read once for all of them.
constexpr std::size_t kTogether = 128;

// What a cell's members add up to: bytes, or how many have each bit.
class CellSums {
 public:
  CellSums(DescriptorKind kind, std::size_t cells)
      : kind_(kind),
        dimensions_(kind == DescriptorKind::kOrb ? 256 : 128),
        sums_(cells * dimensions_),
        counts_(cells) {}

  void Add(std::size_t cell, const std::uint8_t* descriptor) {
    ++counts_[cell];
    std::uint64_t* sum = sums_.data() + cell * dimensions_;
    if (kind_ == DescriptorKind::kOrb) {
      for (std::size_t i = 0; i < 256; ++i) sum[i] += descriptor[i / 8] >> (i % 8) & 1U;
    } else {
      for (std::size_t i = 0; i < 128; ++i) sum[i] += descriptor[i];
    }
  }

  // The cell must have members.
  void Centre(std::size_t cell, std::uint8_t* centre) const {
    const std::uint64_t count = counts_[cell];
    const std::uint64_t* sum = sums_.data() + cell * dimensions_;
    if (kind_ == DescriptorKind::kOrb) {
      std::fill_n(centre, 32, std::uint8_t{0});
      for (std::size_t i = 0; i < 256; ++i) {
        if (2 * sum[i] > count) centre[i / 8] |= static_cast<std::uint8_t>(1U << (i % 8));
      }
    } else {
      for (std::size_t i = 0; i < 128; ++i) {
        centre[i] = static_cast<std::uint8_t>((2 * sum[i] + count) / (2 * count));
      }
    }
  }

  std::vector<std::uint64_t>& counts() { return counts_; }

 private:
  DescriptorKind kind_;
  std::size_t dimensions_;
  std::vector<std::uint64_t> sums_;
  std::vector<std::uint64_t> counts_;
};

// Drawn without repeating a place, by the first steps of a shuffle.
std::vector<std::size_t> Draw(std::size_t from, std::size_t count, Random& random) {
  std::vector<std::size_t> places(from);
  std::iota(places.begin(), places.end(), std::size_t{0});
  for (std::size_t i = 0; i < count; ++i) std::swap(places[i], places[i + random.Index(from - i)]);
  places.resize(count);
  return places;
}

}  // namespace

void NearestByTiles(std::span<const std::uint8_t> descriptors,
                    std::span<const DescriptorTile> tiles, std::uint32_t* nearest) {
  const DescriptorKernels& kernels = FastestKernels();
  const std::size_t count = descriptors.size() / 128;
  std::int32_t terms[kTogether];
  std::uint32_t limits[kTogether];
  std::uint32_t distances[kTogether * kTileSize];
  std::uint16_t within[kTogether];
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t here = std::min(kTogether, count - first);
    const std::uint8_t* queries = descriptors.data() + 128 * first;
    for (std::size_t i = 0; i < here; ++i) terms[i] = QueryTerm(queries + 128 * i);
    std::fill_n(limits, here, kFarthest);
    std::fill_n(nearest + first, here, 0U);
    for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
      kernels.tile_distances(tiles[tile], {queries, terms, limits, here},
                             {distances, kTileSize, within});
      for (std::size_t i = 0; i < here; ++i) {
        for (unsigned left = within[i]; left != 0; left &= left - 1U) {
          const unsigned at = static_cast<unsigned>(std::countr_zero(left));
          const std::uint32_t distance = distances[i * kTileSize + at];
          if (distance >= limits[i]) continue;
          limits[i] = distance;
          nearest[first + i] = static_cast<std::uint32_t>(tile * kTileSize + at);
        }
      }
    }
  }
}

void NearestByBits(std::span<const std::uint8_t> descriptors, std::span<const std::uint8_t> centres,
                   std::uint32_t* nearest) {
  const DescriptorKernels& kernels = FastestKernels();
  std::vector<std::uint32_t> distances(centres.size() / 32);
  for (std::size_t i = 0; i < descriptors.size() / 32; ++i) {
    kernels.hamming_distances(descriptors.data() + 32 * i, centres.data(), distances.size(),
                              distances.data());
    nearest[i] = static_cast<std::uint32_t>(std::min_element(distances.begin(), distances.end()) -
                                            distances.begin());
  }
}

std::vector<std::uint32_t> NearestCentres(DescriptorKind kind,
                                          std::span<const std::uint8_t> descriptors,
                                          std::span<const std::uint8_t> centres) {
  std::vector<std::uint32_t> nearest(descriptors.size() / DescriptorBytes(kind));
  if (kind == DescriptorKind::kOrb) {
    NearestByBits(descriptors, centres, nearest.data());
  } else {
    NearestByTiles(descriptors, TilesOf(centres), nearest.data());
  }
  return nearest;
}

std::vector<std::uint8_t> FindCentres(DescriptorKind kind,
                                      std::span<const std::uint8_t> descriptors, std::size_t count,
                                      Random& random) {
  const std::size_t bytes = DescriptorBytes(kind);
  const std::size_t size = descriptors.size() / bytes;
  std::vector<std::uint8_t> centres(count * bytes);
  const std::vector<std::size_t> drawn = Draw(size, count, random);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(descriptors.data() + drawn[i] * bytes, bytes, centres.data() + i * bytes);
  }
  if (count == size) return centres;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const std::vector<std::uint32_t> cells = NearestCentres(kind, descriptors, centres);
    CellSums sums(kind, count);
    for (std::size_t i = 0; i < size; ++i) sums.Add(cells[i], descriptors.data() + i * bytes);
    std::vector<std::uint64_t>& members = sums.counts();
    for (std::size_t cell = 0; cell < count; ++cell) {
      if (members[cell] > 0) sums.Centre(cell, centres.data() + cell * bytes);
    }
    for (std::size_t cell = 0; cell < count; ++cell) {
      if (members[cell] > 0) continue;
      const std::size_t place = random.Index(size);
      std::copy_n(descriptors.data() + place * bytes, bytes, centres.data() + cell * bytes);
    }
  }
  return centres;
}

}  // namespace lodemark
