// What a feature looks like, as bytes that can be compared.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lodemark {

enum class DescriptorKind : std::uint8_t {
  kRootSift = 1,  // 128 bytes: square roots of the L1-normalised histogram, times 512, rounded
  kOrb = 2,       // 32 bytes, compared bit by bit
};

constexpr std::size_t DescriptorBytes(DescriptorKind kind) {
  return kind == DescriptorKind::kOrb ? 32 : 128;
}

// How one descriptor of a landmark came about.
struct DescriptorOrigin {
  std::uint32_t landmark_id = 0;
  std::uint32_t image_id = 0;
  // From the landmark to the camera that saw it: unit vector in the map's east-north-up, and
  // metres. Zero where nobody noted it.
  Eigen::Vector3f direction_to_camera = Eigen::Vector3f::Zero();
  float distance_m = 0.0F;
};

// Squared Euclidean distance of two 128-byte descriptors.
std::uint32_t SquaredDistance(const std::uint8_t* a, const std::uint8_t* b);

// Number of different bits of two 32-byte descriptors.
std::uint32_t HammingDistance(const std::uint8_t* a, const std::uint8_t* b);

// From one descriptor to count others that lie one after another; the same numbers on every
// processor, by AVX2 or NEON where there is one.
void DistancesTo(DescriptorKind kind, const std::uint8_t* from, const std::uint8_t* others,
                 std::size_t count, std::uint32_t* distances);

}  // namespace lodemark
