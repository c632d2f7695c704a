#include "core/gnss/navigation_message_galileo.h"

#include <algorithm>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"

namespace lodemark {
namespace {

constexpr std::size_t kPageBytes = 29;
constexpr std::size_t kHalfBits = 114;
constexpr std::size_t kCheckedBits = kHalfBits + 82;  // up to the checksum in the odd half

// CRC-24Q (5.1.9.4), over bits that need not fill bytes.
std::uint32_t Crc24q(std::span<const std::uint8_t> bytes, std::size_t bits) {
  constexpr std::uint32_t kPolynomial = 0x1864CFB;
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < bits; ++i) {
    crc ^= static_cast<std::uint32_t>(UnsignedBits(bytes, i, 1)) << 23;
    crc <<= 1;
    if ((crc & 0x1000000) != 0) crc ^= kPolynomial;
  }
  return crc & 0xFFFFFF;
}

std::uint64_t Field(const InavWord& word, std::size_t first, std::size_t count) {
  return UnsignedBits(word, first, count);
}

double Signed(const InavWord& word, std::size_t first, std::size_t count) {
  return static_cast<double>(TwosComplement(Field(word, first, count), count));
}

std::int64_t Minutes(std::uint64_t minutes) {
  return static_cast<std::int64_t>(minutes) * 60 * kSecond_ns;
}

std::uint64_t IssueOf(const InavWord& word) { return Field(word, 6, 10); }

// Word 5 ends in the time of week and spare bits.
InavWord WithoutTime(InavWord word) {
  constexpr std::size_t kTimeBegins = 73;
  if (Field(word, 0, 6) != 5) return word;
  word[kTimeBegins / 8] &= static_cast<std::uint8_t>(0xFF << (8 - kTimeBegins % 8));
  std::fill(word.begin() + kTimeBegins / 8 + 1, word.end(), std::uint8_t{0});
  return word;
}

// Table 39 to 43: the five word types of the ephemeris.
void ReadOrbit(const std::array<InavWord, 5>& w, KeplerEphemeris* e) {
  const InavWord& w1 = w[0];
  const InavWord& w2 = w[1];
  const InavWord& w3 = w[2];
  const InavWord& w4 = w[3];
  e->issue_of_data = static_cast<std::int32_t>(IssueOf(w1));
  e->issue_of_clock = e->issue_of_data;
  e->toe_gps_ns = NearestCongruent(Minutes(Field(w1, 16, 14)), kWeek_ns, e->transmitted_gps_ns);
  e->mean_anomaly_rad = Signed(w1, 30, 32) * 0x1p-31 * kPi;
  e->eccentricity = static_cast<double>(Field(w1, 62, 32)) * 0x1p-33;
  const double root_of_axis = static_cast<double>(Field(w1, 94, 32)) * 0x1p-19;
  e->semi_major_axis_m = root_of_axis * root_of_axis;
  e->ascending_node_rad = Signed(w2, 16, 32) * 0x1p-31 * kPi;
  e->inclination_rad = Signed(w2, 48, 32) * 0x1p-31 * kPi;
  e->argument_of_perigee_rad = Signed(w2, 80, 32) * 0x1p-31 * kPi;
  e->inclination_rate_radps = Signed(w2, 112, 14) * 0x1p-43 * kPi;
  e->ascending_node_rate_radps = Signed(w3, 16, 24) * 0x1p-43 * kPi;
  e->mean_motion_difference_radps = Signed(w3, 40, 16) * 0x1p-43 * kPi;
  e->cuc_rad = Signed(w3, 56, 16) * 0x1p-29;
  e->cus_rad = Signed(w3, 72, 16) * 0x1p-29;
  e->crc_m = Signed(w3, 88, 16) * 0x1p-5;
  e->crs_m = Signed(w3, 104, 16) * 0x1p-5;
  const std::optional<double> accuracy_m =
      GalileoSignalAccuracy(static_cast<int>(Field(w3, 120, 8)));
  e->accuracy_m = accuracy_m.value_or(0.0);
  e->healthy = e->healthy && accuracy_m.has_value();
  e->cic_rad = Signed(w4, 22, 16) * 0x1p-29;
  e->cis_rad = Signed(w4, 38, 16) * 0x1p-29;
  e->toc_gps_ns = NearestCongruent(Minutes(Field(w4, 54, 14)), kWeek_ns, e->transmitted_gps_ns);
  e->clock_bias_s = Signed(w4, 68, 31) * 0x1p-34;
  e->clock_drift_sps = Signed(w4, 99, 21) * 0x1p-46;
  e->clock_drift_rate_sps2 = Signed(w4, 120, 6) * 0x1p-59;
}

void ReadStatus(const InavWord& w5, KeplerEphemeris* e) {
  e->group_delays.bgd_e5a_e1_s = Signed(w5, 47, 10) * 0x1p-32;
  e->group_delays.bgd_e5b_e1_s = Signed(w5, 57, 10) * 0x1p-32;
  const std::uint64_t e5b_health = Field(w5, 67, 2);
  const std::uint64_t e1_health = Field(w5, 69, 2);
  const std::uint64_t e5b_data = Field(w5, 71, 1);
  const std::uint64_t e1_data = Field(w5, 72, 1);
  // As RINEX arranges them: see IsHealthy.
  e->health = static_cast<std::int32_t>(e1_data | e1_health << 1 | e5b_data << 6 | e5b_health << 7);
  e->healthy = IsHealthy(System::kGalileo, MessageType::kInav, e->health);
}

// Galileo's week 0 is GPS week 1024.
std::int64_t TimeOf(const InavWord& w5, std::int64_t received_gps_ns) {
  const auto second_ns = static_cast<std::int64_t>(Field(w5, 85, 20)) * kSecond_ns;
  const auto week_ns = static_cast<std::int64_t>(Field(w5, 73, 12) + 1024) * kWeek_ns;
  return NearestCongruent(week_ns + second_ns, 4096 * kWeek_ns, received_gps_ns);
}

}  // namespace

std::optional<InavWord> CheckInavPage(std::span<const std::uint8_t> bytes,
                                      MessageVerdict* verdict) {
  *verdict = MessageVerdict::kMalformed;
  if (bytes.size() < kPageBytes) return std::nullopt;
  if (UnsignedBits(bytes, 0, 1) != 0 || UnsignedBits(bytes, kHalfBits, 1) != 1) {
    return std::nullopt;
  }
  *verdict = MessageVerdict::kBadParity;
  if (Crc24q(bytes, kCheckedBits) != UnsignedBits(bytes, kCheckedBits, 24)) return std::nullopt;
  *verdict = MessageVerdict::kUnused;  // an alert page
  if (UnsignedBits(bytes, 1, 1) != 0) return std::nullopt;
  *verdict = MessageVerdict::kTaken;
  InavWord word = {};
  for (std::size_t i = 0; i < word.size(); ++i) {
    const std::size_t first = i < 14 ? 2 + 8 * i : kHalfBits + 2 + 8 * (i - 14);
    word[i] = static_cast<std::uint8_t>(UnsignedBits(bytes, first, 8));
  }
  return word;
}

MessageVerdict InavAssembly::Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                                  std::int64_t received_gps_ns,
                                  std::vector<NavigationRecord>* records) {
  MessageVerdict verdict = MessageVerdict::kMalformed;
  const std::optional<InavWord> word = CheckInavPage(bytes, &verdict);
  if (!word) return verdict;
  const std::uint64_t type = Field(*word, 0, 6);
  if (type < 1 || type > 5) return MessageVerdict::kUnused;
  if (type == 4 && Field(*word, 16, 6) != satellite.number) return MessageVerdict::kMalformed;
  words_[type - 1] = *word;
  if (type == 5 && WithoutTime(*word) != given_ionosphere_) {
    given_ionosphere_ = WithoutTime(*word);
    GalileoIonosphereParameters model;
    model.a = {static_cast<double>(Field(*word, 6, 11)) * 0x1p-2, Signed(*word, 17, 11) * 0x1p-8,
               Signed(*word, 28, 14) * 0x1p-15};
    model.disturbance_flags = static_cast<std::int32_t>(Field(*word, 42, 5));
    records->push_back(IonosphereMessage{satellite, TimeOf(*word, received_gps_ns), model});
  }
  GiveEphemeris(satellite, received_gps_ns, records);
  return MessageVerdict::kTaken;
}

// Words 1 to 4 carry the issue of their set; word 5 belongs to whatever is sent.
void InavAssembly::GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                                 std::vector<NavigationRecord>* records) {
  std::array<InavWord, 5> set = {};
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!words_[i]) return;
    if (i < 4 && IssueOf(*words_[i]) != IssueOf(*words_[0])) return;
    set[i] = WithoutTime(*words_[i]);
  }
  if (set == given_) return;
  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = MessageType::kInav;
  e.transmitted_gps_ns = TimeOf(*words_[4], received_gps_ns);
  ReadStatus(set[4], &e);
  ReadOrbit(set, &e);
  if (!ImplausibleElement(e).empty()) return;
  given_ = set;
  records->push_back(e);
}

}  // namespace lodemark
