#include "tools/renderer/colour.h"

#include <cmath>
#include <cstddef>

namespace lodemark {
namespace {

constexpr int kSteps = 1 << 14;  // the curve's steepest part, 12.92 * 255 a unit, takes 5 a byte

float Decoded(float level) {
  return level <= 0.04045F ? level / 12.92F : std::pow((level + 0.055F) / 1.055F, 2.4F);
}

float Encoded(float light) {
  return light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1.0F / 2.4F) - 0.055F;
}

std::array<std::uint8_t, kSteps + 1> EncodingTable() {
  std::array<std::uint8_t, kSteps + 1> table = {};
  for (int i = 0; i <= kSteps; ++i) {
    const float level = Encoded(static_cast<float>(i) / kSteps);
    table[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0F * level));
  }
  return table;
}

std::array<float, 256> DecodingTable() {
  std::array<float, 256> table = {};
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = Decoded(static_cast<float>(i) / 255.0F);
  }
  return table;
}

const std::array<std::uint8_t, kSteps + 1> kEncoding = EncodingTable();
const std::array<float, 256> kDecoding = DecodingTable();

}  // namespace

std::uint8_t ByteFromLight(float light) {
  const float step = std::clamp(light, 0.0F, 1.0F) * kSteps + 0.5F;
  return kEncoding[static_cast<std::size_t>(step)];
}

const std::array<float, 256>& LightOfBytes() { return kDecoding; }

}  // namespace lodemark
