#include "core/gnss/navigation_message_beidou.h"

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"

namespace lodemark {
namespace {

constexpr std::size_t kWords = 10;
constexpr std::size_t kWordBits = 30;
constexpr std::uint64_t kPreamble = 0x712;
constexpr std::int64_t kFirstWeek_ns = 1356 * kWeek_ns;  // 2006-01-01 as weeks since 1980

// Subframes follow each other every six seconds.
constexpr std::int64_t kSubframe_s = 6;

// 15 bits of BCH(15,11,1), generator x^4 + x + 1 (5.1.3).
bool PassesBch(std::uint32_t code) {
  for (int bit = 14; bit >= 4; --bit) {
    if ((code >> bit & 1) != 0) code ^= 0b10011u << (bit - 4);
  }
  return (code & 0xF) == 0;
}

// Word 1: fifteen bits without a code, then one codeword. The others: two codewords, bit by bit in
// turn.
bool PassesParity(std::uint32_t word, bool first) {
  if (first) return PassesBch(word & 0x7FFF);
  std::uint32_t even = 0;
  std::uint32_t odd = 0;
  for (int bit = kWordBits - 1; bit > 0; bit -= 2) {
    even = even << 1 | (word >> bit & 1);
    odd = odd << 1 | (word >> (bit - 1) & 1);
  }
  return PassesBch(even) && PassesBch(odd);
}

// A field in two parts, as parity divides it; the second may be empty. First bits as in the ICD.
struct Place {
  std::size_t first;
  std::size_t count;
  std::size_t second_first = 1;
  std::size_t second_count = 0;
};

std::uint64_t Field(const BeidouSubframe& s, const Place& place) {
  return UnsignedBits(s, place.first - 1, place.count) << place.second_count |
         UnsignedBits(s, place.second_first - 1, place.second_count);
}

double Signed(const BeidouSubframe& s, const Place& place) {
  return static_cast<double>(TwosComplement(Field(s, place), place.count + place.second_count));
}

std::int64_t SecondOfWeek(const BeidouSubframe& s) {
  return static_cast<std::int64_t>(Field(s, {19, 8, 31, 12}));
}

// Table 5-8: nominal accuracy of the index, which follows GPS's.
double Accuracy(std::uint64_t index) {
  return UserRangeAccuracy(static_cast<int>(index)).value_or(8192.0);
}

// Figure 5-8.
void ReadClock(const BeidouSubframe& s, std::int64_t near_ns, std::int64_t* toc_ns,
               KeplerEphemeris* e) {
  e->health = static_cast<std::int32_t>(Field(s, {43, 1}));
  e->healthy = IsHealthy(System::kBeidou, e->type, e->health);
  e->issue_of_clock = static_cast<std::int32_t>(Field(s, {44, 5}));
  e->accuracy_m = Accuracy(Field(s, {49, 4}));
  *toc_ns = NearestCongruent(static_cast<std::int64_t>(Field(s, {74, 9, 91, 8})) * 8 * kSecond_ns,
                             kWeek_ns, near_ns);
  e->group_delays.tgd1_s = Signed(s, {99, 10}) * 1e-10;
  e->group_delays.tgd2_s = Signed(s, {109, 4, 121, 6}) * 1e-10;
  e->clock_drift_rate_sps2 = Signed(s, {215, 11}) * 0x1p-66;
  e->clock_bias_s = Signed(s, {226, 7, 241, 17}) * 0x1p-33;
  e->clock_drift_sps = Signed(s, {258, 5, 271, 17}) * 0x1p-50;
  e->issue_of_data = static_cast<std::int32_t>(Field(s, {288, 5}));
}

// Figures 5-9 and 5-10. The time of ephemeris is divided between the two.
void ReadOrbit(const BeidouSubframe& s2, const BeidouSubframe& s3, std::int64_t near_ns,
               std::int64_t* toe_ns, KeplerEphemeris* e) {
  e->mean_motion_difference_radps = Signed(s2, {43, 10, 61, 6}) * 0x1p-43 * kPi;
  e->cuc_rad = Signed(s2, {67, 16, 91, 2}) * 0x1p-31;
  e->mean_anomaly_rad = Signed(s2, {93, 20, 121, 12}) * 0x1p-31 * kPi;
  e->eccentricity = static_cast<double>(Field(s2, {133, 10, 151, 22})) * 0x1p-33;
  e->cus_rad = Signed(s2, {181, 18}) * 0x1p-31;
  e->crc_m = Signed(s2, {199, 4, 211, 14}) * 0x1p-6;
  e->crs_m = Signed(s2, {225, 8, 241, 10}) * 0x1p-6;
  const double root_of_axis = static_cast<double>(Field(s2, {251, 12, 271, 20})) * 0x1p-19;
  e->semi_major_axis_m = root_of_axis * root_of_axis;
  const std::uint64_t toe = Field(s2, {291, 2}) << 15 | Field(s3, {43, 10, 61, 5});
  *toe_ns = NearestCongruent(static_cast<std::int64_t>(toe) * 8 * kSecond_ns, kWeek_ns, near_ns);
  e->inclination_rad = Signed(s3, {66, 17, 91, 15}) * 0x1p-31 * kPi;
  e->cic_rad = Signed(s3, {106, 7, 121, 11}) * 0x1p-31;
  e->ascending_node_rate_radps = Signed(s3, {132, 11, 151, 13}) * 0x1p-43 * kPi;
  e->cis_rad = Signed(s3, {164, 9, 181, 9}) * 0x1p-31;
  e->inclination_rate_radps = Signed(s3, {190, 13, 211, 1}) * 0x1p-43 * kPi;
  e->ascending_node_rad = Signed(s3, {212, 21, 241, 11}) * 0x1p-31 * kPi;
  e->argument_of_perigee_rad = Signed(s3, {252, 11, 271, 21}) * 0x1p-31 * kPi;
}

KlobucharParameters ReadIonosphere(const BeidouSubframe& s) {
  KlobucharParameters model;
  model.system = System::kBeidou;
  model.alpha = {Signed(s, {127, 8}) * 0x1p-30, Signed(s, {135, 8}) * 0x1p-27,
                 Signed(s, {151, 8}) * 0x1p-24, Signed(s, {159, 8}) * 0x1p-24};
  model.beta = {Signed(s, {167, 6, 181, 2}) * 0x1p11, Signed(s, {183, 8}) * 0x1p14,
                Signed(s, {191, 8}) * 0x1p16, Signed(s, {199, 4, 211, 4}) * 0x1p16};
  return model;
}

}  // namespace

std::optional<BeidouSubframe> CheckBeidouSubframe(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4 * kWords) return std::nullopt;
  BeidouSubframe subframe = {};
  for (std::size_t i = 0; i < kWords; ++i) {
    const auto word = static_cast<std::uint32_t>(UnsignedBits(bytes, 32 * i + 2, kWordBits));
    if (!PassesParity(word, i == 0)) return std::nullopt;
    for (std::size_t bit = 0; bit < kWordBits; ++bit) {
      const std::size_t at = kWordBits * i + bit;
      const unsigned set = word >> (kWordBits - 1 - bit) & 1;
      subframe[at / 8] = static_cast<std::uint8_t>(subframe[at / 8] | set << (7 - at % 8));
    }
  }
  return subframe;
}

MessageVerdict D1Assembly::Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                                std::int64_t received_gps_ns,
                                std::vector<NavigationRecord>* records) {
  if (bytes.size() < 4 * kWords) return MessageVerdict::kMalformed;
  const std::optional<BeidouSubframe> subframe = CheckBeidouSubframe(bytes);
  if (!subframe) return MessageVerdict::kBadParity;
  if (Field(*subframe, {1, 11}) != kPreamble) return MessageVerdict::kMalformed;
  const std::uint64_t id = Field(*subframe, {16, 3});
  if (id < 1 || id > 5 || SecondOfWeek(*subframe) >= 604'800) return MessageVerdict::kMalformed;
  if (id > 3) return MessageVerdict::kUnused;
  subframes_[id - 1] = *subframe;
  GiveEphemeris(satellite, received_gps_ns, records);
  return MessageVerdict::kTaken;
}

// Subframes 2 and 3 carry no issue: only three that were sent one after the other are a set.
void D1Assembly::GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                               std::vector<NavigationRecord>* records) {
  if (!subframes_[0] || !subframes_[1] || !subframes_[2]) return;
  const BeidouSubframe& s1 = *subframes_[0];
  const BeidouSubframe& s2 = *subframes_[1];
  const BeidouSubframe& s3 = *subframes_[2];
  const std::int64_t sent_s = SecondOfWeek(s1);
  const auto follows = [&](const BeidouSubframe& s, std::int64_t place) {
    return FloorModulo(SecondOfWeek(s) - sent_s, 604'800) == place * kSubframe_s;
  };
  if (!follows(s2, 1) || !follows(s3, 2)) return;

  const auto week = static_cast<std::int64_t>(Field(s1, {61, 13}));
  const std::int64_t near_ns = ScaleFromGps(received_gps_ns, TimeScale::kBeidou);
  const std::int64_t sent_ns = NearestCongruent(
      kFirstWeek_ns + week * kWeek_ns + sent_s * kSecond_ns, 8192 * kWeek_ns, near_ns);
  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = MessageType::kD1;
  e.transmitted_gps_ns = GpsFromScale(sent_ns, TimeScale::kBeidou);
  std::int64_t toc_ns = 0;
  std::int64_t toe_ns = 0;
  ReadClock(s1, sent_ns, &toc_ns, &e);
  ReadOrbit(s2, s3, sent_ns, &toe_ns, &e);
  e.toc_gps_ns = GpsFromScale(toc_ns, TimeScale::kBeidou);
  e.toe_gps_ns = GpsFromScale(toe_ns, TimeScale::kBeidou);
  const bool known = e.toe_gps_ns == given_toe_gps_ns_ && e.toc_gps_ns == given_toc_gps_ns_ &&
                     e.health == given_health_;
  if (known || !ImplausibleElement(e).empty()) return;
  given_toe_gps_ns_ = e.toe_gps_ns;
  given_toc_gps_ns_ = e.toc_gps_ns;
  given_health_ = e.health;
  records->push_back(e);
  records->push_back(IonosphereMessage{satellite, e.transmitted_gps_ns, ReadIonosphere(s1)});
}

}  // namespace lodemark
