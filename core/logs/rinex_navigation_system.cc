#include "core/logs/rinex_navigation_system.h"

#include <algorithm>
#include <cmath>

#include "core/geo/time.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

enum class IonosphereKind : std::uint8_t { kNone, kKlobuchar, kGalileo, kBdgim };

// RINEX 4.00 table 27 and tables A35 to A38.
IonosphereKind KindOf(System system, std::string_view name) {
  switch (system) {
    case System::kGps:
    case System::kQzss:
      return name == "LNAV" || name == "CNVX" ? IonosphereKind::kKlobuchar : IonosphereKind::kNone;
    case System::kNavic:
      return name == "LNAV" ? IonosphereKind::kKlobuchar : IonosphereKind::kNone;
    case System::kBeidou:
      if (name == "D1D2") return IonosphereKind::kKlobuchar;
      return name == "CNVX" ? IonosphereKind::kBdgim : IonosphereKind::kNone;
    case System::kGalileo:
      return name == "IFNV" ? IonosphereKind::kGalileo : IonosphereKind::kNone;
    case System::kGlonass:
    case System::kSbas:
      break;
  }
  return IonosphereKind::kNone;
}

// Three numbers follow the epoch, four stand in each line after it.
NavigationPlace Following(int index) {
  const int place = index + 1;
  return {static_cast<std::int8_t>(place / 4),
          static_cast<std::int8_t>(place < 4 ? index : place % 4)};
}

bool AllWithin(const double* values, std::size_t count, double limit) {
  return std::all_of(values, values + count, [=](double v) { return std::abs(v) <= limit; });
}

}  // namespace

bool IsIonosphereMessage(System system, std::string_view message_name) {
  return KindOf(system, message_name) != IonosphereKind::kNone;
}

// IS-GPS-200N table 20-X: eight bits each; BeiDou's reach twice as far.
bool IsPlausible(const KlobucharParameters& parameters) {
  return AllWithin(parameters.alpha.data(), parameters.alpha.size(), 1e-3) &&
         AllWithin(parameters.beta.data(), parameters.beta.size(), 1e8);
}

// OS SIS ICD 2.1 table 78: 11 bits of 2^-2 and of 2^-8, 14 bits of 2^-15.
bool IsPlausible(const GalileoIonosphereParameters& parameters) {
  return parameters.a[0] >= 0.0 && AllWithin(parameters.a.data(), parameters.a.size(), 512.0);
}

std::optional<NavigationFault> ReadTimeOffset(NavigationText* text, SatelliteId satellite,
                                              std::int64_t time_ns, TimeOffsetMessage* message) {
  *message = TimeOffsetMessage();
  message->satellite = satellite;
  message->reference_gps_ns = GpsFromScale(time_ns, EphemerisTimeScale(satellite.system));
  const std::string_view label = TrimSpaces(text->Raw({0, 0}));
  if (label.size() != message->label.size()) return NavigationFault{{0, 0}, "time offset code"};
  std::copy(label.begin(), label.end(), message->label.begin());
  message->a0_s = text->NumberOrZero({1, 1});
  message->a1_sps = text->NumberOrZero({1, 2});
  message->a2_sps2 = text->NumberOrZero({1, 3});
  if (text->malformed()) return NavigationFault{*text->malformed(), {}};
  if (!(std::abs(message->a0_s) < 1.0)) return NavigationFault{{1, 1}, "time offset"};
  return std::nullopt;
}

std::optional<NavigationFault> ReadEarthOrientation(NavigationText* text, SatelliteId satellite,
                                                    std::int64_t time_ns,
                                                    EarthOrientationMessage* message) {
  *message = EarthOrientationMessage();
  message->satellite = satellite;
  message->reference_gps_ns = GpsFromScale(time_ns, EphemerisTimeScale(satellite.system));
  for (std::int8_t i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const auto field = static_cast<std::int8_t>(i + 1);
    message->x_arcsec[index] = text->NumberOrZero({0, i});
    message->y_arcsec[index] = text->NumberOrZero({1, field});
    message->dut1_s[index] = text->NumberOrZero({2, field});
  }
  if (text->malformed()) return NavigationFault{*text->malformed(), {}};
  // The pole stays within 0.6 arcseconds of the origin, UT1 within 0.9 s of UTC.
  if (!AllWithin(message->x_arcsec.data(), 3, 2.0)) return NavigationFault{{0, 0}, "pole"};
  if (!AllWithin(message->y_arcsec.data(), 3, 2.0)) return NavigationFault{{1, 1}, "pole"};
  if (!AllWithin(message->dut1_s.data(), 3, 100.0)) return NavigationFault{{2, 1}, "UT1"};
  return std::nullopt;
}

std::optional<NavigationFault> ReadIonosphere(NavigationText* text, SatelliteId satellite,
                                              std::string_view message_name, std::int64_t time_ns,
                                              IonosphereMessage* message) {
  *message = IonosphereMessage();
  message->satellite = satellite;
  message->transmitted_gps_ns = GpsFromScale(time_ns, EphemerisTimeScale(satellite.system));
  bool plausible = true;
  switch (KindOf(satellite.system, message_name)) {
    case IonosphereKind::kKlobuchar: {
      KlobucharParameters model;
      model.system = satellite.system;
      for (int i = 0; i < 4; ++i) {
        model.alpha[static_cast<std::size_t>(i)] = text->NumberOrZero(Following(i));
        model.beta[static_cast<std::size_t>(i)] = text->NumberOrZero(Following(i + 4));
      }
      model.region = text->IntegerOrZero(Following(8));
      plausible = IsPlausible(model);
      message->model = model;
      break;
    }
    case IonosphereKind::kGalileo: {
      GalileoIonosphereParameters model;
      for (int i = 0; i < 3; ++i) {
        model.a[static_cast<std::size_t>(i)] = text->NumberOrZero(Following(i));
      }
      model.disturbance_flags = text->IntegerOrZero(Following(3));
      plausible = IsPlausible(model);
      message->model = model;
      break;
    }
    case IonosphereKind::kBdgim: {
      BdgimParameters model;
      for (int i = 0; i < 9; ++i) {
        model.alpha[static_cast<std::size_t>(i)] = text->NumberOrZero(Following(i));
      }
      // BDS-SIS-ICD-B1C 1.0 table 7-13: at most 10 bits of 2^-3.
      plausible = AllWithin(model.alpha.data(), model.alpha.size(), 128.0);
      message->model = model;
      break;
    }
    case IonosphereKind::kNone:
      return NavigationFault{{0, 0}, "message"};
  }
  if (text->malformed()) return NavigationFault{*text->malformed(), {}};
  if (!plausible) return NavigationFault{{0, 0}, "ionosphere coefficient"};
  return std::nullopt;
}

}  // namespace lodemark
