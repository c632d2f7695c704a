#include "core/map/descriptor.h"

#include "core/map/descriptor_kernels.h"

namespace lodemark {
namespace {

const DescriptorKernels& Choose() {
  if (const DescriptorKernels* kernels = Avx512Kernels()) return *kernels;
  if (const DescriptorKernels* kernels = Avx2Kernels()) return *kernels;
  if (const DescriptorKernels* kernels = NeonKernels()) return *kernels;
  return PortableKernels();
}

}  // namespace

const DescriptorKernels& FastestKernels() {
  static const DescriptorKernels& kernels = Choose();
  return kernels;
}

std::uint32_t SquaredDistance(const std::uint8_t* a, const std::uint8_t* b) {
  return FastestKernels().squared_distance(a, b);
}

std::uint32_t HammingDistance(const std::uint8_t* a, const std::uint8_t* b) {
  return FastestKernels().hamming_distance(a, b);
}

void DistancesTo(DescriptorKind kind, const std::uint8_t* from, const std::uint8_t* others,
                 std::size_t count, std::uint32_t* distances) {
  const DescriptorKernels& kernels = FastestKernels();
  if (kind == DescriptorKind::kOrb) {
    kernels.hamming_distances(from, others, count, distances);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    distances[i] = kernels.squared_distance(from, others + 128 * i);
  }
}

}  // namespace lodemark
