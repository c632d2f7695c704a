#include "core/gnss/navigation_message_beidou_frame.h"

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"

namespace lodemark {
namespace {

constexpr std::size_t kWords = 10;
constexpr std::size_t kWordBits = 30;
constexpr std::uint64_t kPreamble = 0x712;
constexpr std::int64_t kSecondsOfWeek = 604'800;
constexpr std::int64_t kFirstWeek_ns = 1356 * kWeek_ns;  // 2006-01-01 as weeks since 1980

// 15 bits of BCH(15,11,1), generator x^4 + x + 1 (5.1.3).
bool PassesBch(std::uint32_t code) {
  for (int bit = 14; bit >= 4; --bit) {
    if ((code >> bit & 1) != 0) code ^= 0b10011u << (bit - 4);
  }
  return (code & 0xF) == 0;
}

// Word 1: fifteen bits without a code, then one codeword. The others hold two codewords of eleven
// data and four parity bits.
bool PassesParity(std::uint32_t word, bool first) {
  if (first) return PassesBch(word & 0x7FFF);
  return PassesBch((word >> 19 & 0x7FF) << 4 | (word >> 4 & 0xF)) &&
         PassesBch((word >> 8 & 0x7FF) << 4 | (word & 0xF));
}

// Words other than the first are sent with the bits of their two codewords in turn (5.1.3).
// Gives the data of the first, those of the second, then the parities in the same order.
std::uint32_t Deinterleaved(std::uint32_t sent) {
  std::uint32_t codes[2] = {};
  for (unsigned bit = kWordBits; bit-- > 0;) {
    std::uint32_t& code = codes[bit % 2 == 1 ? 0 : 1];
    code = code << 1 | (sent >> bit & 1);
  }
  return codes[0] >> 4 << 19 | codes[1] >> 4 << 8 | (codes[0] & 0xF) << 4 | (codes[1] & 0xF);
}

enum class BitOrder { kDeinterleaved, kAsSent };

// Empty if the BCH code of any word finds an error. bytes: all ten words.
std::optional<BeidouSubframe> WithoutGaps(std::span<const std::uint8_t> bytes, BitOrder order) {
  BeidouSubframe subframe = {};
  for (std::size_t i = 0; i < kWords; ++i) {
    auto word = static_cast<std::uint32_t>(UnsignedBits(bytes, 32 * i + 2, kWordBits));
    if (i > 0 && order == BitOrder::kAsSent) word = Deinterleaved(word);
    if (!PassesParity(word, i == 0)) return std::nullopt;
    for (std::size_t bit = 0; bit < kWordBits; ++bit) {
      const std::size_t at = kWordBits * i + bit;
      const unsigned set = word >> (kWordBits - 1 - bit) & 1;
      subframe[at / 8] = static_cast<std::uint8_t>(subframe[at / 8] | set << (7 - at % 8));
    }
  }
  return subframe;
}

}  // namespace

MessageVerdict ReadBeidouSubframe(std::span<const std::uint8_t> bytes, BeidouSubframe* subframe) {
  if (bytes.size() < 4 * kWords) return MessageVerdict::kMalformed;
  std::optional<BeidouSubframe> read = WithoutGaps(bytes, BitOrder::kDeinterleaved);
  if (!read) read = WithoutGaps(bytes, BitOrder::kAsSent);
  if (!read) return MessageVerdict::kBadParity;
  const std::uint64_t number = BeidouSubframeNumber(*read);
  if (UnsignedBits(*read, 0, 11) != kPreamble || number < 1 || number > 5 ||
      BeidouSecondOfWeek(*read) >= kSecondsOfWeek) {
    return MessageVerdict::kMalformed;
  }
  *subframe = *read;
  return MessageVerdict::kTaken;
}

std::uint64_t BeidouSubframeNumber(const BeidouSubframe& subframe) {
  return UnsignedBits(subframe, 15, 3);
}

std::int64_t BeidouSecondOfWeek(const BeidouSubframe& subframe) {
  return static_cast<std::int64_t>(UnsignedBits(subframe, 18, 8) << 12 |
                                   UnsignedBits(subframe, 30, 12));
}

double BeidouAccuracy(std::uint64_t index) {
  return UserRangeAccuracy(static_cast<int>(index)).value_or(8192.0);
}

std::int64_t BeidouTransmission(std::int64_t week, std::int64_t second_of_week,
                                std::int64_t received_gps_ns) {
  return NearestCongruent(kFirstWeek_ns + week * kWeek_ns + second_of_week * kSecond_ns,
                          8192 * kWeek_ns, ScaleFromGps(received_gps_ns, TimeScale::kBeidou));
}

void BeidouSets::Give(KeplerEphemeris e, const BeidouSetTimes& times,
                      const KlobucharParameters& ionosphere,
                      std::vector<NavigationRecord>* records) {
  e.transmitted_gps_ns = GpsFromScale(times.sent_ns, TimeScale::kBeidou);
  e.toc_gps_ns = GpsFromScale(times.toc_ns, TimeScale::kBeidou);
  e.toe_gps_ns = GpsFromScale(times.toe_ns, TimeScale::kBeidou);
  const bool known = e.toe_gps_ns == given_toe_gps_ns_ && e.toc_gps_ns == given_toc_gps_ns_ &&
                     e.health == given_health_;
  if (known || !ImplausibleElement(e).empty()) return;
  given_toe_gps_ns_ = e.toe_gps_ns;
  given_toc_gps_ns_ = e.toc_gps_ns;
  given_health_ = e.health;
  records->push_back(e);
  records->push_back(IonosphereMessage{e.satellite, e.transmitted_gps_ns, ionosphere});
}

}  // namespace lodemark
