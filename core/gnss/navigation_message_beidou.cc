#include "core/gnss/navigation_message_beidou.h"

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"

namespace lodemark {
namespace {

// Subframes follow each other every six seconds.
constexpr std::int64_t kSubframe_s = 6;

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

// Figure 5-8.
void ReadClock(const BeidouSubframe& s, std::int64_t near_ns, std::int64_t* toc_ns,
               KeplerEphemeris* e) {
  e->health = static_cast<std::int32_t>(Field(s, {43, 1}));
  e->healthy = IsHealthy(System::kBeidou, e->type, e->health);
  e->issue_of_clock = static_cast<std::int32_t>(Field(s, {44, 5}));
  e->accuracy_m = BeidouAccuracy(Field(s, {49, 4}));
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

MessageVerdict D1Assembly::Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                                std::int64_t received_gps_ns,
                                std::vector<NavigationRecord>* records) {
  BeidouSubframe subframe;
  const MessageVerdict verdict = ReadBeidouSubframe(bytes, &subframe);
  if (verdict != MessageVerdict::kTaken) return verdict;
  const std::uint64_t id = BeidouSubframeNumber(subframe);
  if (id > 3) return MessageVerdict::kUnused;
  subframes_[id - 1] = subframe;
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
  const std::int64_t sent_s = BeidouSecondOfWeek(s1);
  const auto follows = [&](const BeidouSubframe& s, std::int64_t place) {
    return FloorModulo(BeidouSecondOfWeek(s) - sent_s, 604'800) == place * kSubframe_s;
  };
  if (!follows(s2, 1) || !follows(s3, 2)) return;

  const auto week = static_cast<std::int64_t>(Field(s1, {61, 13}));
  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = MessageType::kD1;
  BeidouSetTimes times;
  times.sent_ns = BeidouTransmission(week, sent_s, received_gps_ns);
  ReadClock(s1, times.sent_ns, &times.toc_ns, &e);
  ReadOrbit(s2, s3, times.sent_ns, &times.toe_ns, &e);
  sets_.Give(e, times, ReadIonosphere(s1), records);
}

}  // namespace lodemark
