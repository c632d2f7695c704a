// Any sequence of broadcast messages. Parity would stop nearly every random one, so that each is
// also pushed with its checks made right.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <span>
#include <variant>
#include <vector>

#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"
#include "core/gnss/navigation_message.h"

namespace {

using lodemark::AndroidMessageType;
using lodemark::MessageVerdict;
using lodemark::NavigationRecord;

void Require(bool law) {
  if (!law) std::abort();
}

void Check(const NavigationRecord& record) {
  if (const auto* kepler = std::get_if<lodemark::KeplerEphemeris>(&record)) {
    Require(lodemark::ImplausibleElement(*kepler).empty());
    Require(std::abs(kepler->toe_gps_ns - kepler->transmitted_gps_ns) < 400'000'000'000'000);
  } else if (const auto* state = std::get_if<lodemark::StateEphemeris>(&record)) {
    Require(lodemark::ImplausibleElement(*state).empty());
    Require(std::isfinite(state->l2_delay_s) && std::isfinite(state->age_days));
  }
}

std::uint32_t Take(std::span<const std::uint8_t>* input, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count && !input->empty(); ++i) {
    value = value << 8 | input->front();
    *input = input->subspan(1);
  }
  return value;
}

void FixGlonass(std::vector<std::uint8_t>* bytes) {
  if (bytes->size() < 11) return;
  // Eight check bits lie in bits 77 to 84 counted from the front; all their values are tried.
  for (unsigned checks = 0; checks < 256; ++checks) {
    for (std::size_t i = 0; i < 8; ++i) {
      const std::size_t at = 77 + i;
      const auto bit = static_cast<std::uint8_t>(0x80 >> at % 8);
      auto& byte = (*bytes)[at / 8];
      byte = static_cast<std::uint8_t>((checks >> i & 1) != 0 ? byte | bit : byte & ~bit);
    }
    lodemark::NavigationMessageDecoder probe;
    std::vector<NavigationRecord> none;
    if (probe.Push(static_cast<int>(AndroidMessageType::kGlonassL1Ca), 1, *bytes, 0, &none) !=
        MessageVerdict::kBadParity) {
      return;
    }
  }
}

void FixGalileo(std::vector<std::uint8_t>* bytes) {
  if (bytes->size() < 29) return;
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < 196; ++i) {
    crc ^= static_cast<std::uint32_t>(lodemark::UnsignedBits(*bytes, i, 1)) << 23;
    crc <<= 1;
    if ((crc & 0x1000000) != 0) crc ^= 0x1864CFB;
  }
  for (std::size_t i = 0; i < 24; ++i) {
    const std::size_t at = 196 + i;
    const auto bit = static_cast<std::uint8_t>(0x80 >> at % 8);
    auto& byte = (*bytes)[at / 8];
    byte = static_cast<std::uint8_t>((crc >> (23 - i) & 1) != 0 ? byte | bit : byte & ~bit);
  }
}

std::uint32_t Bch(std::uint32_t data) {
  std::uint32_t rest = data << 4;
  for (int bit = 14; bit >= 4; --bit) {
    if ((rest >> bit & 1) != 0) rest ^= 0b10011u << (bit - 4);
  }
  return rest & 0xF;
}

void FixBeidou(std::vector<std::uint8_t>* bytes) {
  for (std::size_t word = 0; word + 4 <= bytes->size() && word < 40; word += 4) {
    auto bits = static_cast<std::uint32_t>(lodemark::UnsignedBits(*bytes, 8 * word, 32));
    if (word == 0) {
      bits = (bits & ~0xFu) | Bch(bits >> 4 & 0x7FF);
    } else {
      bits = (bits & ~0xFFu) | Bch(bits >> 19 & 0x7FF) << 4 | Bch(bits >> 8 & 0x7FF);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      (*bytes)[word + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
    }
  }
}

// IS-GPS-200N table 20-XIV with data bits that nothing inverts and parity freed alike.
void FixGps(std::vector<std::uint8_t>* bytes) {
  constexpr std::uint32_t kMasks[6] = {0xEC7CD2, 0x763E69, 0xBB1F34, 0x5D8F9A, 0xAEC7CD, 0x2DEA27};
  bool differ = false;
  for (std::size_t word = 0; word + 4 <= bytes->size() && word < 40; word += 4) {
    auto bits = static_cast<std::uint32_t>(lodemark::UnsignedBits(*bytes, 8 * word, 32));
    const std::uint32_t data = bits >> 6 & 0xFFFFFF;
    bits &= ~0x3Fu;
    for (std::uint32_t i = 0; i < 6; ++i) {
      bool sum = (i == 0 || i == 2 || i == 5) && differ;
      for (std::uint32_t rest = data & kMasks[i]; rest != 0; rest &= rest - 1) sum = !sum;
      bits |= (sum ? 1u : 0u) << (5 - i);
    }
    differ = (bits >> 1 & 1) != (bits & 1);
    for (std::size_t i = 0; i < 4; ++i) {
      (*bytes)[word + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
    }
  }
}

}  // namespace

// Each message: kind, svid, seconds since the one before, length, bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::uint8_t> input(data, size);
  lodemark::NavigationMessageDecoder decoder;
  std::vector<NavigationRecord> records;
  std::int64_t time_gps_ns = static_cast<std::int64_t>(Take(&input, 4)) * 1'000'000'000;
  while (input.size() > 3) {
    const std::uint32_t kind = Take(&input, 1);
    const auto svid = static_cast<std::int32_t>(Take(&input, 1)) - 2;
    time_gps_ns += static_cast<std::int64_t>(Take(&input, 1)) * 1'000'000'000;
    const std::size_t wanted = Take(&input, 1) % 64;
    const std::size_t length = std::min(wanted, input.size());
    std::vector<std::uint8_t> bytes(input.begin(),
                                    input.begin() + static_cast<std::ptrdiff_t>(length));
    input = input.subspan(length);
    constexpr std::int32_t kTypes[] = {0x0101, 0x0301, 0x0401, 0x0501, 0x0601, 0x0102, 0x0502};
    const std::int32_t type = kTypes[kind % std::size(kTypes)];
    if (kind < 128) {
      if (type == 0x0101 || type == 0x0401) FixGps(&bytes);
      if (type == 0x0301) FixGlonass(&bytes);
      if (type == 0x0501 || type == 0x0502) FixBeidou(&bytes);
      if (type == 0x0601) FixGalileo(&bytes);
    }
    decoder.Push(type, svid, bytes, time_gps_ns, &records);
  }
  for (const NavigationRecord& record : records) Check(record);
  return 0;
}
