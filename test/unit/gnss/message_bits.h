// Encoders for the tests of navigation messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lodemark::test {

using Bytes = std::vector<std::uint8_t>;

// Bits numbered from 1, as the interface documents do.
class Bits {
 public:
  explicit Bits(std::size_t count) : bits_(count) {}

  void Set(std::size_t first, std::size_t count, std::int64_t value) {
    for (std::size_t i = 0; i < count; ++i) {
      bits_[first - 1 + i] = (value >> (count - 1 - i) & 1) != 0;
    }
  }
  bool operator[](std::size_t number) const { return bits_[number - 1]; }
  void Flip(std::size_t number) { bits_[number - 1] = !bits_[number - 1]; }
  std::size_t size() const { return bits_.size(); }

  Bytes ToBytes() const {
    Bytes bytes((bits_.size() + 7) / 8);
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      if (bits_[i]) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 0x80 >> i % 8);
    }
    return bytes;
  }

  // Thirty bits in each four bytes, at their end.
  Bytes ToWords() const {
    Bits words(bits_.size() / 30 * 32);
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      words.bits_[i / 30 * 32 + 2 + i % 30] = bits_[i];
    }
    return words.ToBytes();
  }

 private:
  std::vector<bool> bits_;
};

// BeiDou's BCH code: each eleven bits get the remainder of their division by x^4 + x + 1.
inline std::int64_t Bch(std::int64_t data) {
  std::int64_t rest = data << 4;
  for (int bit = 14; bit >= 4; --bit) {
    if ((rest >> bit & 1) != 0) rest ^= std::int64_t{0b10011} << (bit - 4);
  }
  return rest;
}

inline Bytes BeidouBytes(Bits s) {
  const auto take = [&](std::size_t first, std::size_t step) {
    std::int64_t value = 0;
    for (std::size_t i = 0; i < 11; ++i) value = value << 1 | (s[first + step * i] ? 1 : 0);
    return value;
  };
  s.Set(27, 4, Bch(take(16, 1)));
  for (std::size_t word = 30; word < 300; word += 30) {
    const std::int64_t odd = Bch(take(word + 1, 2));
    const std::int64_t even = Bch(take(word + 2, 2));
    for (std::size_t i = 0; i < 4; ++i) {
      s.Set(word + 23 + 2 * i, 1, odd >> (3 - i));
      s.Set(word + 24 + 2 * i, 1, even >> (3 - i));
    }
  }
  return s.ToWords();
}

}  // namespace lodemark::test
