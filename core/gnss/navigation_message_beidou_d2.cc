#include "core/gnss/navigation_message_beidou_d2.h"

#include <algorithm>
#include <initializer_list>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"

namespace lodemark {
namespace {

// A frame has one page of subframe 1; its subframes share the frame's second of the week (5.3.2).
constexpr std::int64_t kFrame_s = 3;

// Bits of a field within one word of one page; pages and bits as the ICD numbers them, from 1.
struct Part {
  std::size_t page;
  std::size_t first;
  std::size_t count;
};

struct Joined {
  std::uint64_t bits = 0;
  std::size_t count = 0;
};

Joined Join(const D2Assembly::Pages& pages, std::initializer_list<Part> parts) {
  Joined field;
  for (const Part& part : parts) {
    field.bits =
        field.bits << part.count | UnsignedBits(*pages[part.page - 1], part.first - 1, part.count);
    field.count += part.count;
  }
  return field;
}

double Unsigned(const D2Assembly::Pages& pages, std::initializer_list<Part> parts) {
  return static_cast<double>(Join(pages, parts).bits);
}

double Signed(const D2Assembly::Pages& pages, std::initializer_list<Part> parts) {
  const Joined field = Join(pages, parts);
  return static_cast<double>(TwosComplement(field.bits, field.count));
}

std::int64_t TimeOfWeek(const D2Assembly::Pages& pages, std::initializer_list<Part> parts,
                        std::int64_t near_ns) {
  const auto units = static_cast<std::int64_t>(Join(pages, parts).bits);
  return NearestCongruent(units * 8 * kSecond_ns, kWeek_ns, near_ns);
}

// Figures 5-14-1, 5-14-3 and 5-14-4.
void ReadClock(const D2Assembly::Pages& p, std::int64_t near_ns, std::int64_t* toc_ns,
               KeplerEphemeris* e) {
  e->health = static_cast<std::int32_t>(Join(p, {{1, 47, 1}}).bits);
  e->healthy = IsHealthy(System::kBeidou, e->type, e->health);
  e->issue_of_clock = static_cast<std::int32_t>(Join(p, {{1, 48, 5}}).bits);
  e->accuracy_m = BeidouAccuracy(Join(p, {{1, 61, 4}}).bits);
  *toc_ns = TimeOfWeek(p, {{1, 78, 5}, {1, 91, 12}}, near_ns);
  e->group_delays.tgd1_s = Signed(p, {{1, 103, 10}}) * 1e-10;
  e->group_delays.tgd2_s = Signed(p, {{1, 121, 10}}) * 1e-10;
  e->clock_bias_s = Signed(p, {{3, 101, 12}, {3, 121, 12}}) * 0x1p-33;
  e->clock_drift_sps = Signed(p, {{3, 133, 4}, {4, 47, 6}, {4, 61, 12}}) * 0x1p-50;
  e->clock_drift_rate_sps2 = Signed(p, {{4, 73, 10}, {4, 91, 1}}) * 0x1p-66;
  e->issue_of_data = static_cast<std::int32_t>(Join(p, {{4, 92, 5}}).bits);
}

// Figures 5-14-4 to 5-14-10.
void ReadOrbit(const D2Assembly::Pages& p, std::int64_t near_ns, std::int64_t* toe_ns,
               KeplerEphemeris* e) {
  e->mean_motion_difference_radps = Signed(p, {{4, 97, 16}}) * 0x1p-43 * kPi;
  e->cuc_rad = Signed(p, {{4, 121, 14}, {5, 47, 4}}) * 0x1p-31;
  e->mean_anomaly_rad = Signed(p, {{5, 51, 2}, {5, 61, 22}, {5, 91, 8}}) * 0x1p-31 * kPi;
  e->cus_rad = Signed(p, {{5, 99, 14}, {5, 121, 4}}) * 0x1p-31;
  e->eccentricity = Unsigned(p, {{5, 125, 10}, {6, 47, 6}, {6, 61, 16}}) * 0x1p-33;
  const double root_of_axis = Unsigned(p, {{6, 77, 6}, {6, 91, 22}, {6, 121, 4}}) * 0x1p-19;
  e->semi_major_axis_m = root_of_axis * root_of_axis;
  e->cic_rad = Signed(p, {{6, 125, 10}, {7, 47, 6}, {7, 61, 2}}) * 0x1p-31;
  e->cis_rad = Signed(p, {{7, 63, 18}}) * 0x1p-31;
  *toe_ns = TimeOfWeek(p, {{7, 81, 2}, {7, 91, 15}}, near_ns);
  e->inclination_rad =
      Signed(p, {{7, 106, 7}, {7, 121, 14}, {8, 47, 6}, {8, 61, 5}}) * 0x1p-31 * kPi;
  e->crc_m = Signed(p, {{8, 66, 17}, {8, 91, 1}}) * 0x1p-6;
  e->crs_m = Signed(p, {{8, 92, 18}}) * 0x1p-6;
  e->ascending_node_rate_radps = Signed(p, {{8, 110, 3}, {8, 121, 16}, {9, 47, 5}}) * 0x1p-43 * kPi;
  e->ascending_node_rad = Signed(p, {{9, 52, 1}, {9, 61, 22}, {9, 91, 9}}) * 0x1p-31 * kPi;
  e->argument_of_perigee_rad = Signed(p, {{9, 100, 13}, {9, 121, 14}, {10, 47, 5}}) * 0x1p-31 * kPi;
  e->inclination_rate_radps = Signed(p, {{10, 52, 1}, {10, 61, 13}}) * 0x1p-43 * kPi;
}

// Figure 5-14-2.
KlobucharParameters ReadIonosphere(const D2Assembly::Pages& p) {
  KlobucharParameters model;
  model.system = System::kBeidou;
  model.alpha = {Signed(p, {{2, 47, 6}, {2, 61, 2}}) * 0x1p-30, Signed(p, {{2, 63, 8}}) * 0x1p-27,
                 Signed(p, {{2, 71, 8}}) * 0x1p-24, Signed(p, {{2, 79, 4}, {2, 91, 4}}) * 0x1p-24};
  model.beta = {Signed(p, {{2, 95, 8}}) * 0x1p11, Signed(p, {{2, 103, 8}}) * 0x1p14,
                Signed(p, {{2, 111, 2}, {2, 121, 6}}) * 0x1p16, Signed(p, {{2, 127, 8}}) * 0x1p16};
  return model;
}

}  // namespace

MessageVerdict D2Assembly::Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                                std::int64_t received_gps_ns,
                                std::vector<NavigationRecord>* records) {
  BeidouSubframe subframe;
  const MessageVerdict verdict = ReadBeidouSubframe(bytes, &subframe);
  if (verdict != MessageVerdict::kTaken) return verdict;
  if (BeidouSubframeNumber(subframe) > 1) return MessageVerdict::kUnused;
  const std::uint64_t page = UnsignedBits(subframe, 42, 4);
  if (page < 1 || page > kPages) return MessageVerdict::kMalformed;
  pages_[page - 1] = subframe;
  if (IsComplete()) GiveEphemeris(satellite, received_gps_ns, records);
  return MessageVerdict::kTaken;
}

// Only the first page and the fourth carry an issue: ten that were sent one after the other are a
// set.
bool D2Assembly::IsComplete() const {
  if (!std::all_of(pages_.begin(), pages_.end(),
                   [](const auto& page) { return page.has_value(); })) {
    return false;
  }
  const std::int64_t sent_s = BeidouSecondOfWeek(*pages_[0]);
  for (std::size_t i = 1; i < kPages; ++i) {
    const std::int64_t later_s = FloorModulo(BeidouSecondOfWeek(*pages_[i]) - sent_s, 604'800);
    if (later_s != static_cast<std::int64_t>(i) * kFrame_s) return false;
  }
  return true;
}

void D2Assembly::GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                               std::vector<NavigationRecord>* records) {
  const auto week = static_cast<std::int64_t>(Join(pages_, {{1, 65, 13}}).bits);
  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = MessageType::kD2;
  BeidouSetTimes times;
  times.sent_ns = BeidouTransmission(week, BeidouSecondOfWeek(*pages_[0]), received_gps_ns);
  ReadClock(pages_, times.sent_ns, &times.toc_ns, &e);
  ReadOrbit(pages_, times.sent_ns, &times.toe_ns, &e);
  sets_.Give(e, times, ReadIonosphere(pages_), records);
}

}  // namespace lodemark
