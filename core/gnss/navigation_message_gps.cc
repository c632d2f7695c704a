#include "core/gnss/navigation_message_gps.h"

#include <bit>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"

namespace lodemark {
namespace {

constexpr std::size_t kWords = 10;
constexpr unsigned kPreamble = 0x8B;
constexpr std::uint64_t kIonospherePage = 56;  // the satellite number that names page 18

// IS-GPS-200N table 20-XIV: which of the data bits d1..d24 (d1 highest) each parity bit sums.
constexpr std::array<std::uint32_t, 6> kParityMasks = {0xEC7CD2, 0x763E69, 0xBB1F34,
                                                       0x5D8F9A, 0xAEC7CD, 0x2DEA27};
// And which of the last two bits of the word before: true for the last.
constexpr std::array<bool, 6> kTakesLast = {false, true, false, true, true, false};

std::uint32_t Parity(std::uint32_t data, bool second_last, bool last) {
  std::uint32_t parity = 0;
  for (std::size_t i = 0; i < kParityMasks.size(); ++i) {
    const bool odd = std::popcount(data & kParityMasks[i]) % 2 != 0;
    const bool before = kTakesLast[i] ? last : second_last;
    parity = parity << 1 | (odd != before ? 1u : 0u);
  }
  return parity;
}

enum class Inversion { kAsBroadcast, kDataFreed, kWordFreed };

std::optional<LnavSubframe> Check(const std::array<std::uint32_t, kWords>& words,
                                  Inversion inversion) {
  LnavSubframe subframe = {};
  bool second_last = false;  // words 2 and 10 end in two zeros
  bool last = false;
  for (std::size_t i = 0; i < kWords; ++i) {
    std::uint32_t data = words[i] >> 6 & 0xFFFFFF;
    bool summed_second_last = second_last;
    bool summed_last = last;
    if (inversion == Inversion::kAsBroadcast && last) data ^= 0xFFFFFF;
    if (inversion == Inversion::kWordFreed) {
      // Both bits before were turned alike, so their difference stands; and the parity was turned
      // with the data, which takes the last of them out of its sums.
      summed_second_last = second_last != last;
      summed_last = false;
    }
    if (Parity(data, summed_second_last, summed_last) != (words[i] & 0x3F)) return std::nullopt;
    subframe[i] = data;
    second_last = (words[i] & 2) != 0;
    last = (words[i] & 1) != 0;
  }
  return subframe;
}

// count bits of a word, from the given one, numbered as the ICD does: from 1 to 24.
std::uint64_t Field(const LnavSubframe& subframe, int word, int first, int count) {
  const std::uint32_t data = subframe[static_cast<std::size_t>(word - 1)];
  return data >> (24 - (first - 1) - count) & ((1u << count) - 1);
}

double Signed(const LnavSubframe& subframe, int word, int first, int count) {
  return static_cast<double>(
      TwosComplement(Field(subframe, word, first, count), static_cast<std::size_t>(count)));
}

// Eight bits at 17 of one word and all of the next.
std::uint64_t Long(const LnavSubframe& subframe, int word) {
  return Field(subframe, word, 17, 8) << 24 | Field(subframe, word + 1, 1, 24);
}

double SignedLong(const LnavSubframe& subframe, int word) {
  return static_cast<double>(TwosComplement(Long(subframe, word), 32));
}

std::int64_t Seconds(std::uint64_t seconds) {
  return static_cast<std::int64_t>(seconds) * kSecond_ns;
}

// When the subframe began: its time of week is that of the next one.
std::int64_t SecondOfWeek_ns(const LnavSubframe& subframe) {
  return FloorModulo(Seconds(6 * Field(subframe, 2, 1, 17)) - 6 * kSecond_ns, kWeek_ns);
}

std::int64_t WeekStart(std::uint64_t week, std::uint64_t modulus, std::int64_t near_gps_ns) {
  return NearestCongruent(static_cast<std::int64_t>(week) * kWeek_ns,
                          static_cast<std::int64_t>(modulus) * kWeek_ns, near_gps_ns);
}

LnavSubframe WithoutTime(LnavSubframe subframe) {
  subframe[0] = 0;
  subframe[1] = 0;
  return subframe;
}

// Figure 20-1 sheet 1, table 20-I.
void ReadClock(const LnavSubframe& s, std::int64_t received_gps_ns, KeplerEphemeris* e) {
  const std::int64_t week_ns =
      WeekStart(Field(s, 3, 1, 10), 1024, received_gps_ns - SecondOfWeek_ns(s));
  e->transmitted_gps_ns = week_ns + SecondOfWeek_ns(s);
  e->accuracy_m = UserRangeAccuracy(static_cast<int>(Field(s, 3, 13, 4))).value_or(8192.0);
  e->health = static_cast<std::int32_t>(Field(s, 3, 17, 6));
  e->healthy = IsHealthy(e->satellite.system, e->type, e->health);
  e->issue_of_clock = static_cast<std::int32_t>(Field(s, 3, 23, 2) << 8 | Field(s, 8, 1, 8));
  const double delay = Signed(s, 7, 17, 8);
  // QZSS: 1000 0000 is "not available".
  if (e->satellite.system == System::kGps || delay != -128.0) {
    e->group_delays.tgd_s = delay * 0x1p-31;
  }
  e->toc_gps_ns =
      NearestCongruent(Seconds(16 * Field(s, 8, 9, 16)), kWeek_ns, e->transmitted_gps_ns);
  e->clock_drift_rate_sps2 = Signed(s, 9, 1, 8) * 0x1p-55;
  e->clock_drift_sps = Signed(s, 9, 9, 16) * 0x1p-43;
  e->clock_bias_s = Signed(s, 10, 1, 22) * 0x1p-31;
}

// Figure 20-1 sheets 2 and 3, table 20-III.
void ReadOrbit(const LnavSubframe& s2, const LnavSubframe& s3, KeplerEphemeris* e) {
  e->issue_of_data = static_cast<std::int32_t>(Field(s2, 3, 1, 8));
  e->crs_m = Signed(s2, 3, 9, 16) * 0x1p-5;
  e->mean_motion_difference_radps = Signed(s2, 4, 1, 16) * 0x1p-43 * kPi;
  e->mean_anomaly_rad = SignedLong(s2, 4) * 0x1p-31 * kPi;
  e->cuc_rad = Signed(s2, 6, 1, 16) * 0x1p-29;
  e->eccentricity = static_cast<double>(Long(s2, 6)) * 0x1p-33;
  e->cus_rad = Signed(s2, 8, 1, 16) * 0x1p-29;
  const double root_of_axis = static_cast<double>(Long(s2, 8)) * 0x1p-19;
  e->semi_major_axis_m = root_of_axis * root_of_axis;
  e->toe_gps_ns =
      NearestCongruent(Seconds(16 * Field(s2, 10, 1, 16)), kWeek_ns, e->transmitted_gps_ns);
  if (e->satellite.system == System::kGps) {
    e->fit_interval_s = GpsFitInterval(Field(s2, 10, 17, 1) != 0, e->issue_of_clock);
  }
  e->cic_rad = Signed(s3, 3, 1, 16) * 0x1p-29;
  e->ascending_node_rad = SignedLong(s3, 3) * 0x1p-31 * kPi;
  e->cis_rad = Signed(s3, 5, 1, 16) * 0x1p-29;
  e->inclination_rad = SignedLong(s3, 5) * 0x1p-31 * kPi;
  e->crc_m = Signed(s3, 7, 1, 16) * 0x1p-5;
  e->argument_of_perigee_rad = SignedLong(s3, 7) * 0x1p-31 * kPi;
  e->ascending_node_rate_radps = Signed(s3, 9, 1, 24) * 0x1p-43 * kPi;
  e->inclination_rate_radps = Signed(s3, 10, 9, 14) * 0x1p-43 * kPi;
}

}  // namespace

std::optional<LnavSubframe> CheckLnavSubframe(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4 * kWords) return std::nullopt;
  std::array<std::uint32_t, kWords> words = {};
  for (std::size_t i = 0; i < kWords; ++i) {
    words[i] = static_cast<std::uint32_t>(UnsignedBits(bytes, 32 * i, 32)) & 0x3FFFFFFF;
  }
  for (const Inversion inversion :
       {Inversion::kWordFreed, Inversion::kDataFreed, Inversion::kAsBroadcast}) {
    if (const auto subframe = Check(words, inversion)) return subframe;
  }
  return std::nullopt;
}

MessageVerdict LnavAssembly::Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                                  std::int64_t received_gps_ns,
                                  std::vector<NavigationRecord>* records) {
  if (bytes.size() < 4 * kWords) return MessageVerdict::kMalformed;
  const std::optional<LnavSubframe> subframe = CheckLnavSubframe(bytes);
  if (!subframe) return MessageVerdict::kBadParity;
  if (Field(*subframe, 1, 1, 8) != kPreamble) return MessageVerdict::kMalformed;
  const std::uint64_t id = Field(*subframe, 2, 20, 3);
  if (id >= 1 && id <= 3) {
    subframes_[id - 1] = *subframe;
    GiveEphemeris(satellite, received_gps_ns, records);
    return MessageVerdict::kTaken;
  }
  // QZSS repeats GPS's page 18 with its own coefficients under another number; they are not taken.
  const bool ionosphere =
      id == 4 && satellite.system == System::kGps && Field(*subframe, 3, 3, 6) == kIonospherePage;
  if (!ionosphere) return id == 4 || id == 5 ? MessageVerdict::kUnused : MessageVerdict::kMalformed;
  GiveIonosphereAndUtc(satellite, *subframe, received_gps_ns, records);
  return MessageVerdict::kTaken;
}

// The three belong together if the issue of the orbit is that of the clock's lower eight bits
// (20.3.4.4).
void LnavAssembly::GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                                 std::vector<NavigationRecord>* records) {
  if (!subframes_[0] || !subframes_[1] || !subframes_[2]) return;
  const LnavSubframe& s1 = *subframes_[0];
  const LnavSubframe& s2 = *subframes_[1];
  const LnavSubframe& s3 = *subframes_[2];
  const std::uint64_t issue = Field(s2, 3, 1, 8);
  if (issue != Field(s3, 10, 1, 8)) return;
  if (satellite.system == System::kGps && issue != Field(s1, 8, 1, 8)) return;
  const std::array<LnavSubframe, 3> set = {WithoutTime(s1), WithoutTime(s2), WithoutTime(s3)};
  if (set == given_) return;

  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = MessageType::kLnav;
  ReadClock(s1, received_gps_ns, &e);
  ReadOrbit(s2, s3, &e);
  if (!ImplausibleElement(e).empty()) return;
  given_ = set;
  records->push_back(e);
}

// 20.3.3.5.1.6 and 20.3.3.5.1.7, tables 20-IX and 20-X.
void LnavAssembly::GiveIonosphereAndUtc(SatelliteId satellite, const LnavSubframe& s,
                                        std::int64_t received_gps_ns,
                                        std::vector<NavigationRecord>* records) {
  if (WithoutTime(s) == given_page_) return;
  given_page_ = WithoutTime(s);
  const std::int64_t sent_gps_ns = NearestCongruent(SecondOfWeek_ns(s), kWeek_ns, received_gps_ns);

  KlobucharParameters model;
  model.alpha = {Signed(s, 3, 9, 8) * 0x1p-30, Signed(s, 3, 17, 8) * 0x1p-27,
                 Signed(s, 4, 1, 8) * 0x1p-24, Signed(s, 4, 9, 8) * 0x1p-24};
  model.beta = {Signed(s, 4, 17, 8) * 0x1p11, Signed(s, 5, 1, 8) * 0x1p14,
                Signed(s, 5, 9, 8) * 0x1p16, Signed(s, 5, 17, 8) * 0x1p16};
  records->push_back(IonosphereMessage{satellite, sent_gps_ns, model});

  TimeOffsetMessage offset;
  offset.satellite = satellite;
  offset.label = {'G', 'P', 'U', 'T'};
  offset.a1_sps = Signed(s, 6, 1, 24) * 0x1p-50;
  const std::uint64_t a0 = Field(s, 7, 1, 24) << 8 | Field(s, 8, 1, 8);
  offset.a0_s = static_cast<double>(TwosComplement(a0, 32)) * 0x1p-30;
  offset.reference_gps_ns =
      WeekStart(Field(s, 8, 17, 8), 256, sent_gps_ns) + Seconds(4096 * Field(s, 8, 9, 8));
  records->push_back(offset);

  // The new count holds from the end of a day of a week, both counted from 1 and modulo 256.
  const std::int64_t change_gps_ns = WeekStart(Field(s, 9, 9, 8), 256, sent_gps_ns) +
                                     static_cast<std::int64_t>(Field(s, 9, 17, 8)) * kDay_ns;
  const double leap_s = sent_gps_ns >= change_gps_ns ? Signed(s, 10, 1, 8) : Signed(s, 9, 1, 8);
  records->push_back(LeapSecondMessage{static_cast<std::int32_t>(leap_s)});
}

}  // namespace lodemark
