// Calls on the C interface out of a fuzzer's input.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "lodemark/lodemark.h"

namespace lodemark::test {

inline void Require(bool condition) {
  if (!condition) std::abort();
}

inline lodemark_status Seen(lodemark_status status) {
  Require(status > LODEMARK_ERROR_INTERNAL && status <= LODEMARK_NO_POSITION);
  if (status < 0) Require(std::strlen(lodemark_last_error()) > 0);
  return status;
}

// Reads values off the input; zeros once it is used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }

  template <typename T>
  T Take() {
    T value = {};
    const std::size_t taken = sizeof(T) < size_ ? sizeof(T) : size_;
    std::memcpy(&value, data_, taken);
    data_ += taken;
    size_ -= taken;
    return value;
  }

  // At most the given number of bytes.
  std::string TakeText(std::size_t wanted) {
    const std::size_t taken = wanted < size_ ? wanted : size_;
    std::string text(reinterpret_cast<const char*>(data_), taken);
    data_ += taken;
    size_ -= taken;
    return text;
  }

  // Overwrites up to three stretches of a struct, and perhaps its size: with one that a caller may
  // state without lying about the memory behind it.
  template <typename T>
  void Disturb(T* value) {
    const int stretches = Take<std::uint8_t>() % 4;
    for (int i = 0; i < stretches; ++i) {
      const std::size_t at = Take<std::uint16_t>() % (sizeof(T) / 4) * 4;
      const std::size_t length = at + 8 <= sizeof(T) ? 8 : 4;
      const auto stretch = Take<std::array<std::uint8_t, 8>>();
      std::memcpy(reinterpret_cast<unsigned char*>(value) + at, stretch.data(), length);
    }
    const std::uint8_t size = stretches > 0 ? Take<std::uint8_t>() : std::uint8_t{0};
    value->struct_size =
        size < 240 ? static_cast<std::uint32_t>(sizeof(T)) : static_cast<std::uint32_t>(size % 16);
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof value;
  return value;
}

}  // namespace lodemark::test
