// Numbers in UBX messages, which are little-endian ("UBX data types").
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lodemark {

// The bytes must reach from the given one to the end of the number.
inline std::uint64_t UnsignedAt(std::span<const std::uint8_t> bytes, std::size_t first,
                                std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i > 0; --i) value = value << 8 | bytes[first + i - 1];
  return value;
}

inline unsigned Unsigned16At(std::span<const std::uint8_t> bytes, std::size_t first) {
  return static_cast<unsigned>(UnsignedAt(bytes, first, 2));
}

inline std::uint32_t Unsigned32At(std::span<const std::uint8_t> bytes, std::size_t first) {
  return static_cast<std::uint32_t>(UnsignedAt(bytes, first, 4));
}

inline double DoubleAt(std::span<const std::uint8_t> bytes, std::size_t first) {
  return std::bit_cast<double>(UnsignedAt(bytes, first, 8));
}

inline float FloatAt(std::span<const std::uint8_t> bytes, std::size_t first) {
  return std::bit_cast<float>(Unsigned32At(bytes, first));
}

}  // namespace lodemark
