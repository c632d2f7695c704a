#include "core/logs/rinex_navigation_state.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"

namespace lodemark {
namespace {

constexpr double kKilometre_m = 1000.0;

// RINEX 3.05 table A10: these stand at 0.999999999999E+09 where unknown.
constexpr double kUnknown = 0.99e9;

struct ElementPlace {
  std::string_view element;
  NavigationPlace place;
};
constexpr std::array<ElementPlace, 5> kElementPlaces = {{{"clock bias", {0, 0}},
                                                         {"frequency bias", {0, 1}},
                                                         {"position", {1, 0}},
                                                         {"velocity", {1, 1}},
                                                         {"acceleration", {1, 2}}}};

NavigationPlace PlaceOf(std::string_view element) {
  const auto* found = std::find_if(kElementPlaces.begin(), kElementPlaces.end(),
                                   [&](const ElementPlace& p) { return p.element == element; });
  return found == kElementPlaces.end() ? NavigationPlace{0, 0} : found->place;
}

// Some receivers write the channel as an unsigned byte.
std::int8_t ChannelFromNumber(std::int32_t number) {
  if (number > 128) number -= 256;
  if (number < -7 || number > 13) return kUnknownGlonassChannel;
  return static_cast<std::int8_t>(number);
}

std::optional<std::int32_t> KnownInteger(NavigationText* text, NavigationPlace place) {
  const std::optional<double> value = text->Number(place);
  if (!value || std::abs(*value) > kUnknown) return std::nullopt;
  return text->IntegerOrZero(place);
}

void ReadGlonass(NavigationText* text, StateEphemeris* e) {
  e->type = MessageType::kFdma;
  e->glonass_channel = ChannelFromNumber(text->IntegerOrZero({2, 3}));
  e->age_days = text->NumberOrZero({3, 3});
  const double l2_delay_s = text->NumberOrZero({4, 1});
  e->l2_delay_s = std::abs(l2_delay_s) < 1e-6 ? l2_delay_s : 0.0;
  if (const auto index = KnownInteger(text, {4, 2})) {
    e->accuracy_m = GlonassAccuracy(*index).value_or(0.0);
  }
  // Bit 2 of the health flags is l(3) of string 3.
  const std::int32_t flags = KnownInteger(text, {4, 3}).value_or(0);
  e->healthy = IsHealthy(System::kGlonass, e->type, e->health) && (flags & 0x4) == 0;
}

void ReadSbas(NavigationText* text, StateEphemeris* e) {
  constexpr double kNotMonitored_m = 32'767.0;
  e->type = MessageType::kSbas;
  e->accuracy_m = std::max(text->NumberOrZero({2, 3}), 0.0);
  e->healthy = IsHealthy(System::kSbas, e->type, e->health) && e->accuracy_m < kNotMonitored_m;
}

}  // namespace

std::optional<NavigationFault> ReadState(NavigationText* text, SatelliteId satellite,
                                         std::int64_t toe_ns, StateEphemeris* e) {
  const TimeScale scale = EphemerisTimeScale(satellite.system);
  *e = StateEphemeris();
  e->satellite = satellite;
  e->toe_gps_ns = GpsFromScale(toe_ns, scale);
  e->clock_bias_s = text->NumberOrZero({0, 0});
  e->frequency_bias = text->NumberOrZero({0, 1});
  // GLONASS counts it from the start of the day (RINEX 2) or week (3 and 4), SBAS from the start
  // of the week; it lies near the reference time.
  const std::optional<double> frame_s = text->Number({0, 2});
  if (frame_s && std::abs(*frame_s) <= 2 * 604'800.0) {
    const std::int64_t sent_ns = NearestCongruent(std::llround(*frame_s * 1e9), kDay_ns, toe_ns);
    e->transmitted_gps_ns = GpsFromScale(sent_ns, scale);
  }
  for (std::int8_t axis = 0; axis < 3; ++axis) {
    const auto line = static_cast<std::int8_t>(axis + 1);
    e->position_in_ecef[axis] = kKilometre_m * text->NumberOrZero({line, 0});
    e->velocity_in_ecef[axis] = kKilometre_m * text->NumberOrZero({line, 1});
    e->acceleration_in_ecef[axis] = kKilometre_m * text->NumberOrZero({line, 2});
  }
  e->health = text->IntegerOrZero({1, 3});
  if (satellite.system == System::kGlonass) {
    ReadGlonass(text, e);
  } else {
    ReadSbas(text, e);
  }
  if (text->malformed()) return NavigationFault{*text->malformed(), {}};
  const std::string_view element = ImplausibleElement(*e);
  if (!element.empty()) return NavigationFault{PlaceOf(element), element};
  return std::nullopt;
}

}  // namespace lodemark
