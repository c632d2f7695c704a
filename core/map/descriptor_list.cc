#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "core/map/descriptor_codes.h"
#include "core/map/descriptor_index.h"
#include "core/map/descriptor_tables.h"

namespace lodemark {
namespace {

constexpr std::uint8_t kMagic[4] = {'L', 'M', 'D', 'L'};
constexpr std::uint8_t kVersion = 1;

// Directions are folded onto an octahedron and that onto a square (Cigolle et al. 2014, "A survey
// of efficient representations for independent unit vectors", section 3.3), each side in 254 steps.
constexpr float kHalfSide = 127.0F;
constexpr std::uint32_t kNoDirection = 0xffff;

// Distances by their logarithm, from a centimetre to a thousand kilometres.
constexpr double kLeastDistance_m = 0.01;
constexpr double kDistanceOctaves = 8.0 * std::numbers::ln10 / std::numbers::ln2;
constexpr double kDistanceSteps = 65534.0;
constexpr std::uint32_t kNoDistance = 0;

float SignOf(float value) { return value < 0.0F ? -1.0F : 1.0F; }

std::uint32_t PackDirection(const Eigen::Vector3f& direction) {
  const float sum = direction.cwiseAbs().sum();
  if (!(sum > 1e-6F) || !std::isfinite(sum)) return kNoDirection;
  const Eigen::Vector3f folded = direction / sum;
  float u = folded.x();
  float v = folded.y();
  if (folded.z() < 0.0F) {
    u = (1.0F - std::abs(folded.y())) * SignOf(folded.x());
    v = (1.0F - std::abs(folded.x())) * SignOf(folded.y());
  }
  const auto step = [](float side) {
    return static_cast<std::uint32_t>(
        std::clamp(std::round((side + 1.0F) * kHalfSide), 0.0F, 2.0F * kHalfSide));
  };
  return step(u) | step(v) << 8;
}

Eigen::Vector3f UnpackDirection(std::uint32_t packed) {
  if (packed == kNoDirection) return Eigen::Vector3f::Zero();
  const float u = static_cast<float>(packed & 255U) / kHalfSide - 1.0F;
  const float v = static_cast<float>(packed >> 8) / kHalfSide - 1.0F;
  const float z = 1.0F - std::abs(u) - std::abs(v);
  if (z >= 0.0F) return Eigen::Vector3f(u, v, z).normalized();
  const float x = (1.0F - std::abs(v)) * SignOf(u);
  const float y = (1.0F - std::abs(u)) * SignOf(v);
  return Eigen::Vector3f(x, y, z).normalized();
}

std::uint32_t PackDistance(float distance_m) {
  if (!(distance_m > 0.0F) || !std::isfinite(distance_m)) return kNoDistance;
  const double octaves = std::log2(static_cast<double>(distance_m) / kLeastDistance_m);
  const double steps = std::round(octaves / kDistanceOctaves * kDistanceSteps);
  return static_cast<std::uint32_t>(1.0 + std::clamp(steps, 0.0, kDistanceSteps));
}

float UnpackDistance(std::uint32_t packed) {
  if (packed == kNoDistance) return 0.0F;
  const double octaves = (packed - 1.0) / kDistanceSteps * kDistanceOctaves;
  return static_cast<float>(kLeastDistance_m * std::exp2(octaves));
}

Error Damaged(std::string what) {
  return {ErrorCode::kBadData, "descriptor list: " + std::move(what)};
}

}  // namespace

std::vector<std::uint8_t> DescriptorQuantizer::PackList(
    int list, std::span<const DescriptorOrigin> origins,
    std::span<const std::uint8_t> descriptors) const {
  const Tables& tables = *tables_;
  const std::size_t count = origins.size();
  const std::size_t bytes_each = DescriptorBytes(tables.kind);
  std::vector<std::uint8_t> bytes(kListHeaderBytes + count * (kOriginBytes + bytes_each));
  std::memcpy(bytes.data(), kMagic, sizeof kMagic);
  bytes[4] = kVersion;
  bytes[5] = static_cast<std::uint8_t>(tables.kind);
  bytes[6] = tables.coded ? 1 : 0;
  StoreBytes(static_cast<std::uint32_t>(count), 4, bytes.data() + 8);

  std::uint8_t* landmarks = bytes.data() + kListHeaderBytes;
  std::uint8_t* images = landmarks + 4 * count;
  std::uint8_t* directions = images + 4 * count;
  std::uint8_t* distances = directions + 2 * count;
  for (std::size_t i = 0; i < count; ++i) {
    StoreBytes(origins[i].landmark_id, 4, landmarks + 4 * i);
    StoreBytes(origins[i].image_id, 4, images + 4 * i);
    StoreBytes(PackDirection(origins[i].direction_to_camera), 2, directions + 2 * i);
    StoreBytes(PackDistance(origins[i].distance_m), 2, distances + 2 * i);
  }
  std::copy_n(descriptors.data(), count * bytes_each, distances + 2 * count);
  if (tables.coded) {
    const std::vector<std::uint8_t> codes =
        CodesOf(tables.codebook, tables.Centre(static_cast<std::size_t>(list)), descriptors);
    bytes.insert(bytes.end(), codes.begin(), codes.end());
  }
  return bytes;
}

Result<DescriptorListView> DescriptorListView::Parse(DescriptorKind kind,
                                                     std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kListHeaderBytes || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    return Damaged("is none");
  }
  if (bytes[4] != kVersion) return Damaged("version " + std::to_string(bytes[4]) + ", not 1");
  if (bytes[5] != static_cast<std::uint8_t>(kind)) return Damaged("of another kind of descriptor");
  const bool coded = bytes[6] == 1;
  if (bytes[6] > 1 || bytes[7] != 0 || LoadU32(bytes.data() + 12) != 0) {
    return Damaged("header has bits of no meaning");
  }
  if (coded && kind != DescriptorKind::kRootSift)
    return Damaged("binary descriptors have no codes");

  const std::uint64_t count = LoadU32(bytes.data() + 8);
  const std::uint64_t bytes_each = DescriptorBytes(kind);
  const std::uint64_t plain = kListHeaderBytes + count * (kOriginBytes + bytes_each);
  const std::uint64_t whole = plain + (coded ? CodeBytes(count) : 0);
  if (bytes.size() != whole) {
    return Damaged(std::to_string(bytes.size()) + " bytes, where " + std::to_string(count) +
                   " descriptors take " + std::to_string(whole));
  }
  DescriptorListView view;
  view.kind_ = kind;
  view.size_ = static_cast<std::size_t>(count);
  view.origins_ = bytes.data() + kListHeaderBytes;
  view.descriptors_ = view.origins_ + count * kOriginBytes;
  if (coded) view.codes_ = bytes.data() + plain;
  return view;
}

DescriptorOrigin DescriptorListView::origin(std::size_t i) const {
  DescriptorOrigin origin;
  origin.landmark_id = LoadU32(origins_ + 4 * i);
  origin.image_id = LoadU32(origins_ + 4 * (size_ + i));
  origin.direction_to_camera = UnpackDirection(LoadU16(origins_ + 8 * size_ + 2 * i));
  origin.distance_m = UnpackDistance(LoadU16(origins_ + 10 * size_ + 2 * i));
  return origin;
}

std::uint32_t DescriptorListView::landmark_id(std::size_t i) const {
  return LoadU32(origins_ + 4 * i);
}

const std::uint8_t* DescriptorListView::descriptor(std::size_t i) const {
  return descriptors_ + i * DescriptorBytes(kind_);
}

}  // namespace lodemark
