#include "core/logs/rinex_navigation_kepler.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"

namespace lodemark {
namespace {

struct ElementPlace {
  std::string_view element;  // as ImplausibleElement names it
  NavigationPlace place;
};

constexpr std::array<ElementPlace, 21> kElementPlaces = {{{"clock bias", {0, 0}},
                                                          {"clock drift", {0, 1}},
                                                          {"clock drift rate", {0, 2}},
                                                          {"semi-major axis rate", {1, 0}},
                                                          {"crs", {1, 1}},
                                                          {"mean motion difference", {1, 2}},
                                                          {"mean anomaly", {1, 3}},
                                                          {"cuc", {2, 0}},
                                                          {"eccentricity", {2, 1}},
                                                          {"cus", {2, 2}},
                                                          {"semi-major axis", {2, 3}},
                                                          {"time of ephemeris", {3, 0}},
                                                          {"cic", {3, 1}},
                                                          {"ascending node", {3, 2}},
                                                          {"cis", {3, 3}},
                                                          {"inclination", {4, 0}},
                                                          {"crc", {4, 1}},
                                                          {"argument of perigee", {4, 2}},
                                                          {"ascending node rate", {4, 3}},
                                                          {"inclination rate", {5, 0}},
                                                          {"mean motion difference rate", {5, 1}}}};

NavigationPlace PlaceOf(std::string_view element) {
  const auto* found = std::find_if(kElementPlaces.begin(), kElementPlaces.end(),
                                   [&](const ElementPlace& p) { return p.element == element; });
  return found == kElementPlaces.end() ? NavigationPlace{0, 0} : found->place;
}

// RINEX 3.02 table A8, "Data sources". Bits 8 and 9 say whose clock it is, which is what matters;
// bits 0 to 2 where the message was received.
MessageType GalileoMessage(std::int32_t sources) {
  if ((sources & 0x200) != 0) return MessageType::kInav;
  if ((sources & 0x100) != 0) return MessageType::kFnav;
  const bool from_e5a_only = (sources & 0x2) != 0 && (sources & 0x5) == 0;
  return from_e5a_only ? MessageType::kFnav : MessageType::kInav;
}

void ReadElements(NavigationText* text, KeplerEphemeris* e) {
  e->clock_bias_s = text->NumberOrZero({0, 0});
  e->clock_drift_sps = text->NumberOrZero({0, 1});
  e->clock_drift_rate_sps2 = text->NumberOrZero({0, 2});
  e->crs_m = text->NumberOrZero({1, 1});
  e->mean_motion_difference_radps = text->NumberOrZero({1, 2});
  e->mean_anomaly_rad = text->NumberOrZero({1, 3});
  e->cuc_rad = text->NumberOrZero({2, 0});
  e->eccentricity = text->NumberOrZero({2, 1});
  e->cus_rad = text->NumberOrZero({2, 2});
  const double root_of_axis = text->NumberOrZero({2, 3});
  e->semi_major_axis_m = root_of_axis * root_of_axis;
  e->cic_rad = text->NumberOrZero({3, 1});
  e->ascending_node_rad = text->NumberOrZero({3, 2});
  e->cis_rad = text->NumberOrZero({3, 3});
  e->inclination_rad = text->NumberOrZero({4, 0});
  e->crc_m = text->NumberOrZero({4, 1});
  e->argument_of_perigee_rad = text->NumberOrZero({4, 2});
  e->ascending_node_rate_radps = text->NumberOrZero({4, 3});
  e->inclination_rate_radps = text->NumberOrZero({5, 0});
}

// The second of week nearest to a time known already; the week number beside it is counted in ways
// that differ between writers and is not needed. Empty for the 0.9999E9 of an unknown time.
std::optional<std::int64_t> TimeOfWeek(double second_of_week, std::int64_t near_ns) {
  constexpr double kTwoWeeks_s = 2 * 604'800.0;
  if (!(std::abs(second_of_week) <= kTwoWeeks_s)) return std::nullopt;
  return NearestCongruent(std::llround(second_of_week * 1e9), kWeek_ns, near_ns);
}

double FitInterval(double hours, std::int32_t issue_of_clock) {
  constexpr double kLongest_h = 150.0;
  // Older writers give the flag in place of hours.
  if (hours == 1.0) return GpsFitInterval(true, issue_of_clock);
  return hours > 1.0 && hours <= kLongest_h ? hours * 3600.0 : 0.0;
}

// Composite accuracy with the satellite at its worst elevation (IS-GPS-200N 30.3.3.2.4).
double CnavAccuracy(int elevation_index, int fixed_index) {
  const std::optional<double> elevation_m = UserRangeAccuracy(elevation_index);
  const std::optional<double> fixed_m = UserRangeAccuracy(fixed_index);
  return std::hypot(elevation_m.value_or(0.0), fixed_m.value_or(0.0));
}

// Binary 1000...0 in 13 bits of 2^-35 s: not available (IS-GPS-200N 30.3.3.3.1.1).
bool IsDelayAvailable(double delay_s) { return std::abs(delay_s) < 4096 * 0x1p-35; }

void ReadDelays(NavigationText* text, const KeplerLayout& layout, GroupDelays* delays) {
  const bool cnav = layout.type == MessageType::kCnav || layout.type == MessageType::kCnav2;
  for (const GroupDelayPlace& entry : layout.delays) {
    if (entry.delay == nullptr) continue;
    const std::optional<double> delay_s = text->Number(entry.place);
    if (!delay_s || std::abs(*delay_s) > 1e-5) continue;
    if (cnav && !IsDelayAvailable(*delay_s)) continue;
    delays->*entry.delay = delay_s;
  }
}

// BDS-SIS-ICD-B1C 1.0 table 7-23: data (bit 2) and signal (bit 1) integrity of each three bits.
bool IsIntegral(std::int32_t flags) { return (flags & 066) == 0; }

}  // namespace

TimeScale EphemerisTimeScale(System system) {
  switch (system) {
    case System::kBeidou:
      return TimeScale::kBeidou;
    case System::kGlonass:
      return TimeScale::kUtc;
    case System::kGps:
    case System::kGalileo:
    case System::kQzss:
    case System::kNavic:
    case System::kSbas:
      break;
  }
  return TimeScale::kGps;
}

std::optional<NavigationFault> ReadKepler(NavigationText* text, const KeplerLayout& layout,
                                          SatelliteId satellite, std::int64_t toc_ns, bool named,
                                          KeplerEphemeris* e) {
  const TimeScale scale = EphemerisTimeScale(satellite.system);
  *e = KeplerEphemeris();
  e->satellite = satellite;
  e->type = layout.type;
  e->toc_gps_ns = GpsFromScale(toc_ns, scale);
  e->toe_gps_ns = e->toc_gps_ns;
  ReadElements(text, e);
  if (layout.time_of_ephemeris.exists()) {
    const auto toe_ns = TimeOfWeek(text->NumberOrZero(layout.time_of_ephemeris), toc_ns);
    if (!toe_ns) return NavigationFault{layout.time_of_ephemeris, "time of ephemeris"};
    e->toe_gps_ns = GpsFromScale(*toe_ns, scale);
  }
  if (const std::optional<double> second_of_week = text->Number(layout.transmitted)) {
    const auto transmitted_ns = TimeOfWeek(*second_of_week, toc_ns);
    if (transmitted_ns) e->transmitted_gps_ns = GpsFromScale(*transmitted_ns, scale);
  }
  e->issue_of_data = text->IntegerOrZero(layout.issue_of_data);
  e->issue_of_clock = text->IntegerOrZero(layout.issue_of_clock);
  e->semi_major_axis_rate_mps = text->NumberOrZero(layout.semi_major_axis_rate);
  e->mean_motion_difference_rate_radps2 = text->NumberOrZero(layout.mean_motion_rate);
  ReadDelays(text, layout, &e->group_delays);

  if (layout.data_sources.exists()) {
    const std::int32_t sources = text->IntegerOrZero(layout.data_sources);
    if (!named) e->type = GalileoMessage(sources);
    // F/NAV itself has no E5b delay; writers put zero in its place.
    if (e->type == MessageType::kFnav && (sources & 0x5) == 0) {
      e->group_delays.bgd_e5b_e1_s.reset();
    }
  }
  const double accuracy_m = text->NumberOrZero(layout.accuracy);
  e->accuracy_m = std::max(accuracy_m, 0.0);
  if (layout.accuracy_index.exists()) {
    e->accuracy_m = CnavAccuracy(text->IntegerOrZero(layout.accuracy_index),
                                 text->IntegerOrZero(layout.accuracy_index_fixed));
  }
  e->fit_interval_s = FitInterval(text->NumberOrZero(layout.fit_interval), e->issue_of_clock);
  e->health = text->IntegerOrZero(layout.health);
  e->healthy = IsHealthy(satellite.system, e->type, e->health) &&
               IsIntegral(text->IntegerOrZero(layout.integrity));
  // Galileo: minus one stands for "no accuracy prediction available".
  if (satellite.system == System::kGalileo && accuracy_m < 0.0) e->healthy = false;

  if (text->malformed()) return NavigationFault{*text->malformed(), {}};
  const std::string_view element = ImplausibleElement(*e);
  if (!element.empty()) return NavigationFault{PlaceOf(element), element};
  return std::nullopt;
}

}  // namespace lodemark
