// Values out of a fuzzer's input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <source_location>
#include <string>

namespace lodemark::test {

inline void Require(bool condition,
                    const std::source_location& where = std::source_location::current()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%u: what must hold does not\n", where.file_name(),
               static_cast<unsigned>(where.line()));
  std::abort();
}

// Reads values off the input; zeros once it is used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }
  std::size_t left() const { return size_; }

  template <typename T>
  T Take() {
    T value = {};
    const std::size_t taken = sizeof(T) < size_ ? sizeof(T) : size_;
    // The input may be null where nothing is left of it.
    if (taken > 0) std::memcpy(&value, data_, taken);
    data_ += taken;
    size_ -= taken;
    return value;
  }

  // At most the given number of bytes.
  std::string TakeText(std::size_t wanted) {
    const std::size_t taken = wanted < size_ ? wanted : size_;
    std::string text;
    if (taken > 0) text.assign(reinterpret_cast<const char*>(data_), taken);
    data_ += taken;
    size_ -= taken;
    return text;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace lodemark::test
