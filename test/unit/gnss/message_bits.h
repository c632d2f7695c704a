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

// Words other than the first have eleven data bits, eleven more, and the parities of either.
inline Bits WithBeidouParity(Bits s) {
  const auto take = [&](std::size_t first) {
    std::int64_t value = 0;
    for (std::size_t i = 0; i < 11; ++i) value = value << 1 | (s[first + i] ? 1 : 0);
    return value;
  };
  s.Set(27, 4, Bch(take(16)));
  for (std::size_t word = 30; word < 300; word += 30) {
    s.Set(word + 23, 4, Bch(take(word + 1)));
    s.Set(word + 27, 4, Bch(take(word + 12)));
  }
  return s;
}

inline Bytes BeidouBytes(const Bits& s) { return WithBeidouParity(s).ToWords(); }

// As satellites send it: the bits of both codewords of a word in turn.
inline Bytes BeidouBytesAsSent(const Bits& s) {
  const Bits from = WithBeidouParity(s);
  Bits to = from;
  for (std::size_t word = 30; word < 300; word += 30) {
    for (std::size_t i = 0; i < 15; ++i) {
      const bool parity = i >= 11;
      const std::size_t first = parity ? 23 + (i - 11) : 1 + i;
      const std::size_t second = parity ? 27 + (i - 11) : 12 + i;
      to.Set(word + 1 + 2 * i, 1, from[word + first] ? 1 : 0);
      to.Set(word + 2 + 2 * i, 1, from[word + second] ? 1 : 0);
    }
  }
  return to.ToWords();
}

}  // namespace lodemark::test
