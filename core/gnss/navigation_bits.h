// Fields of navigation messages, cut out of bit strings that begin with the most significant bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lodemark {

// count bits (1 to 64) from the given one, numbered from 0. Bits past the end are zero.
inline std::uint64_t UnsignedBits(std::span<const std::uint8_t> bytes, std::size_t first,
                                  std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    const unsigned byte = i / 8 < bytes.size() ? bytes[i / 8] : 0u;
    value = value << 1 | (byte >> (7 - i % 8) & 1u);
  }
  return value;
}

// A two's complement number of count bits (1 to 63).
inline std::int64_t TwosComplement(std::uint64_t bits, std::size_t count) {
  const std::uint64_t sign = std::uint64_t{1} << (count - 1);
  return static_cast<std::int64_t>(bits ^ sign) - static_cast<std::int64_t>(sign);
}

// A number of count bits (2 to 63) whose highest is the sign, as GLONASS writes them.
inline std::int64_t SignAndMagnitude(std::uint64_t bits, std::size_t count) {
  const std::uint64_t sign = std::uint64_t{1} << (count - 1);
  const auto magnitude = static_cast<std::int64_t>(bits & (sign - 1));
  return (bits & sign) != 0 ? -magnitude : magnitude;
}

}  // namespace lodemark
