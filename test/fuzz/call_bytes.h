// Calls on the C interface out of a fuzzer's input.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "lodemark/lodemark.h"
#include "test/fuzz/bytes.h"

namespace lodemark::test {

inline lodemark_status Seen(lodemark_status status) {
  Require(status > LODEMARK_ERROR_INTERNAL && status <= LODEMARK_NO_POSITION);
  if (status < 0) Require(std::strlen(lodemark_last_error()) > 0);
  return status;
}

// Overwrites up to three stretches of a struct, and perhaps its size: with one that a caller may
// state without lying about the memory behind it.
template <typename T>
void Disturb(Bytes* bytes, T* value) {
  const int stretches = bytes->Take<std::uint8_t>() % 4;
  for (int i = 0; i < stretches; ++i) {
    const std::size_t at = bytes->Take<std::uint16_t>() % (sizeof(T) / 4) * 4;
    const std::size_t length = at + 8 <= sizeof(T) ? 8 : 4;
    const auto stretch = bytes->Take<std::array<std::uint8_t, 8>>();
    std::memcpy(reinterpret_cast<unsigned char*>(value) + at, stretch.data(), length);
  }
  const std::uint8_t size = stretches > 0 ? bytes->Take<std::uint8_t>() : std::uint8_t{0};
  value->struct_size =
      size < 240 ? static_cast<std::uint32_t>(sizeof(T)) : static_cast<std::uint32_t>(size % 16);
}

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof value;
  return value;
}

}  // namespace lodemark::test
