#include "core/logs/rinex_navigation_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/logs/rinex_navigation_kepler.h"

namespace lodemark {
namespace {

constexpr double kKilometre_m = 1000.0;
constexpr double kUnknownTime = 0.9999e9;
constexpr std::int64_t kBeidouFirstWeek = 1356;

// Fortran's D format: width columns, decimals after the point. No locale comes in.
void AppendNumber(double value, int width, int decimals, std::string* text) {
  constexpr double kLeast = 1e-99;  // a third digit of the exponent has no room
  if (!(std::abs(value) >= kLeast)) value = 0.0;
  std::array<char, 40> digits = {};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::scientific, decimals);
  std::string number(digits.data(), error == std::errc() ? end : digits.data());
  std::replace(number.begin(), number.end(), 'e', 'D');
  const auto columns = static_cast<std::size_t>(width);
  text->append(columns - std::min(columns, number.size()), ' ');
  text->append(number);
}

void AppendInteger(std::int64_t value, std::size_t width, char fill, std::string* text) {
  const std::string digits = std::to_string(value);
  text->append(width - std::min(width, digits.size()), fill);
  text->append(digits);
}

void AppendHeaderLine(std::string content, std::string_view label, std::string* text) {
  content.resize(60, ' ');
  text->append(content).append(label).append("\n");
}

// "G07 2023 01 08 02 00 00" and three numbers.
void AppendEpochLine(SatelliteId satellite, std::int64_t time_ns, std::array<double, 3> numbers,
                     std::string* text) {
  const CalendarTime c = CalendarFromNanoseconds(time_ns);
  text->append(SatelliteName(satellite));
  text->push_back(' ');
  AppendInteger(c.year, 4, '0', text);
  for (const int part : {c.month, c.day, c.hour, c.minute, static_cast<int>(c.second)}) {
    text->push_back(' ');
    AppendInteger(part, 2, '0', text);
  }
  for (const double number : numbers) AppendNumber(number, 19, 12, text);
  text->push_back('\n');
}

void AppendOrbitLine(std::array<double, 4> numbers, std::string* text) {
  text->append(4, ' ');
  for (const double number : numbers) AppendNumber(number, 19, 12, text);
  text->push_back('\n');
}

// Week and second of week as RINEX 3.04 counts them: BeiDou's from 2006, the others' with GPS.
struct WeekTime {
  std::int64_t week = 0;
  double second = 0.0;
};

WeekTime WeekOf(std::int64_t time_gps_ns, System system) {
  const std::int64_t time_ns = ScaleFromGps(time_gps_ns, EphemerisTimeScale(system));
  const std::int64_t of_week_ns = FloorModulo(time_ns, kWeek_ns);
  WeekTime time;
  time.week = (time_ns - of_week_ns) / kWeek_ns;
  if (system == System::kBeidou) time.week -= kBeidouFirstWeek;
  time.second = 1e-9 * static_cast<double>(of_week_ns);
  return time;
}

// Referred to the week of toe, so that a set sent before the week began has a negative time.
double TransmissionSecond(const KeplerEphemeris& e, const WeekTime& toe) {
  if (e.transmitted_gps_ns == 0) return kUnknownTime;
  return toe.second + 1e-9 * static_cast<double>(e.transmitted_gps_ns - e.toe_gps_ns);
}

struct MessageFields {
  double issue = 0.0;
  double sources = 0.0;  // beside the week: Galileo's data sources
  double accuracy_m = 0.0;
  std::array<double, 2> delays_s = {};  // or delay and issue of clock
  double last = 0.0;                    // beside the time of transmission
};

double GalileoSources(const KeplerEphemeris& e) {
  constexpr int kInav = 0x205;     // E1-B, E5b-I, clock for E5b and E1
  constexpr int kFnav = 0x102;     // E5a-I, clock for E5a and E1
  constexpr int kInavToo = 0x005;  // both E5b delay and E5a's clock: a merged set
  if (e.type == MessageType::kInav) return kInav;
  return e.group_delays.bgd_e5b_e1_s ? kFnav | kInavToo : kFnav;
}

MessageFields FieldsOf(const KeplerEphemeris& e) {
  MessageFields fields;
  const GroupDelays& delays = e.group_delays;
  fields.issue = e.issue_of_data;
  fields.accuracy_m = e.accuracy_m;
  switch (e.satellite.system) {
    case System::kGalileo: {
      fields.sources = GalileoSources(e);
      const bool unpredicted =
          e.accuracy_m == 0.0 && !e.healthy && IsHealthy(e.satellite.system, e.type, e.health);
      if (unpredicted) fields.accuracy_m = -1.0;
      fields.delays_s = {delays.bgd_e5a_e1_s.value_or(0.0), delays.bgd_e5b_e1_s.value_or(0.0)};
      break;
    }
    case System::kBeidou:
      fields.delays_s = {delays.tgd1_s.value_or(0.0), delays.tgd2_s.value_or(0.0)};
      fields.last = e.issue_of_clock;
      break;
    case System::kGps:
      fields.delays_s = {delays.tgd_s.value_or(0.0), static_cast<double>(e.issue_of_clock)};
      fields.last = e.fit_interval_s / 3600.0;
      break;
    case System::kQzss:
      fields.delays_s = {delays.tgd_s.value_or(0.0), static_cast<double>(e.issue_of_clock)};
      break;
    case System::kNavic:
      fields.delays_s = {delays.tgd_s.value_or(0.0), 0.0};
      break;
    case System::kGlonass:
    case System::kSbas:
      break;
  }
  return fields;
}

bool HasPlace(MessageType type) {
  return type == MessageType::kLnav || type == MessageType::kInav || type == MessageType::kFnav ||
         type == MessageType::kD1 || type == MessageType::kD2;
}

void AppendKepler(const KeplerEphemeris& e, std::string* text) {
  const System system = e.satellite.system;
  const WeekTime toe = WeekOf(e.toe_gps_ns, system);
  const MessageFields fields = FieldsOf(e);
  AppendEpochLine(e.satellite, ScaleFromGps(e.toc_gps_ns, EphemerisTimeScale(system)),
                  {e.clock_bias_s, e.clock_drift_sps, e.clock_drift_rate_sps2}, text);
  AppendOrbitLine({fields.issue, e.crs_m, e.mean_motion_difference_radps, e.mean_anomaly_rad},
                  text);
  AppendOrbitLine({e.cuc_rad, e.eccentricity, e.cus_rad, std::sqrt(e.semi_major_axis_m)}, text);
  AppendOrbitLine({toe.second, e.cic_rad, e.ascending_node_rad, e.cis_rad}, text);
  AppendOrbitLine(
      {e.inclination_rad, e.crc_m, e.argument_of_perigee_rad, e.ascending_node_rate_radps}, text);
  AppendOrbitLine({e.inclination_rate_radps, fields.sources, static_cast<double>(toe.week), 0.0},
                  text);
  AppendOrbitLine(
      {fields.accuracy_m, static_cast<double>(e.health), fields.delays_s[0], fields.delays_s[1]},
      text);
  AppendOrbitLine({TransmissionSecond(e, toe), fields.last, 0.0, 0.0}, text);
}

void AppendState(const StateEphemeris& e, std::string* text) {
  const bool glonass = e.satellite.system == System::kGlonass;
  const TimeScale scale = EphemerisTimeScale(e.satellite.system);
  double sent_s = kUnknownTime;
  if (e.transmitted_gps_ns != 0) {
    const std::int64_t sent_ns = ScaleFromGps(e.transmitted_gps_ns, scale);
    sent_s = 1e-9 * static_cast<double>(FloorModulo(sent_ns, kWeek_ns));
  }
  double health = e.health;
  if (!e.healthy && IsHealthy(e.satellite.system, e.type, e.health) && glonass) health = 1.0;
  const double channel = e.glonass_channel == kUnknownGlonassChannel ? 0.0 : e.glonass_channel;
  const std::array<double, 3> last = {health, glonass ? channel : e.accuracy_m,
                                      glonass ? e.age_days : 0.0};
  AppendEpochLine(e.satellite, ScaleFromGps(e.toe_gps_ns, scale),
                  {e.clock_bias_s, e.frequency_bias, sent_s}, text);
  for (int axis = 0; axis < 3; ++axis) {
    AppendOrbitLine(
        {e.position_in_ecef[axis] / kKilometre_m, e.velocity_in_ecef[axis] / kKilometre_m,
         e.acceleration_in_ecef[axis] / kKilometre_m, last[static_cast<std::size_t>(axis)]},
        text);
  }
}

// The last of each kind that the header has a line for.
struct HeaderContent {
  std::map<System, KlobucharParameters> klobuchar;
  std::optional<GalileoIonosphereParameters> galileo;
  std::map<std::string, TimeOffsetMessage> offsets;
  std::optional<LeapSecondMessage> leap_seconds;
  std::map<System, bool> systems;  // that send an ephemeris

  // False if there is no line for it.
  bool Take(const IonosphereMessage& message) {
    if (const auto* model = std::get_if<KlobucharParameters>(&message.model)) {
      if (model->region != 0) return false;
      klobuchar[model->system] = *model;
      return true;
    }
    if (const auto* model = std::get_if<GalileoIonosphereParameters>(&message.model)) {
      galileo = *model;
      return true;
    }
    return false;
  }

  bool Take(const TimeOffsetMessage& message) {
    constexpr std::array<std::string_view, 11> kLabels = {
        "GPUT", "GLUT", "GAUT", "BDUT", "QZUT", "IRUT", "SBUT", "GLGP", "GAGP", "QZGP", "IRGP"};
    const std::string label(message.label.data(), message.label.size());
    if (std::find(kLabels.begin(), kLabels.end(), label) == kLabels.end()) return false;
    offsets[label] = message;
    return true;
  }
};

void AppendFour(std::string name, const std::array<double, 4>& numbers, std::string* text) {
  name.resize(5, ' ');
  for (const double number : numbers) AppendNumber(number, 12, 4, &name);
  AppendHeaderLine(name, "IONOSPHERIC CORR", text);
}

std::string_view IonosphereName(System system) {
  switch (system) {
    case System::kGps:
      return "GPS";
    case System::kBeidou:
      return "BDS";
    case System::kQzss:
      return "QZS";
    case System::kNavic:
      return "IRN";
    case System::kGalileo:
    case System::kGlonass:
    case System::kSbas:
      break;
  }
  return {};
}

void AppendOffset(const std::string& label, const TimeOffsetMessage& offset, std::string* text) {
  std::string line = label + " ";
  AppendNumber(offset.a0_s, 17, 10, &line);
  AppendNumber(offset.a1_sps, 16, 9, &line);
  WeekTime reference;
  if (offset.reference_gps_ns != 0) {
    const bool beidou = label.starts_with("BD");
    reference = WeekOf(offset.reference_gps_ns, beidou ? System::kBeidou : System::kGps);
  }
  AppendInteger(std::llround(reference.second), 7, ' ', &line);
  AppendInteger(reference.week, 5, ' ', &line);
  AppendHeaderLine(line, "TIME SYSTEM CORR", text);
}

std::string_view FileType(const HeaderContent& content) {
  constexpr std::array<std::string_view, kSystemCount> kTypes = {
      "G: GPS", "R: GLONASS", "E: GALILEO", "C: BDS", "J: QZSS", "I: IRNSS", "S: SBAS"};
  if (content.systems.size() != 1) return "M: MIXED";
  return kTypes[static_cast<std::size_t>(content.systems.begin()->first)];
}

std::string HeaderText(const HeaderContent& content, const RinexNavigationWriterOptions& options) {
  std::string text;
  std::string version = "     3.04           N: GNSS NAV DATA";
  version.resize(40, ' ');
  AppendHeaderLine(version.append(FileType(content)), "RINEX VERSION / TYPE", &text);
  std::string origin = options.program.substr(0, 20);
  origin.resize(20, ' ');
  origin += options.run_by.substr(0, 20);
  origin.resize(40, ' ');
  AppendHeaderLine(origin + options.date.substr(0, 20), "PGM / RUN BY / DATE", &text);
  for (const auto& [system, model] : content.klobuchar) {
    const std::string name(IonosphereName(system));
    if (name.empty()) continue;
    AppendFour(name + "A", model.alpha, &text);
    AppendFour(name + "B", model.beta, &text);
  }
  if (content.galileo) {
    const std::array<double, 3>& a = content.galileo->a;
    AppendFour("GAL", {a[0], a[1], a[2], 0.0}, &text);
  }
  for (const auto& [label, offset] : content.offsets) AppendOffset(label, offset, &text);
  if (content.leap_seconds) {
    std::string line;
    AppendInteger(content.leap_seconds->leap_seconds, 6, ' ', &line);
    AppendHeaderLine(line, "LEAP SECONDS", &text);
  }
  AppendHeaderLine("", "END OF HEADER", &text);
  return text;
}

}  // namespace

RinexNavigationFile WriteRinexNavigation(std::span<const NavigationRecord> records,
                                         const RinexNavigationWriterOptions& options) {
  RinexNavigationFile file;
  HeaderContent header;
  std::string body;
  for (const NavigationRecord& record : records) {
    bool has_place = true;
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) {
      has_place = HasPlace(kepler->type);
      if (has_place) {
        header.systems[kepler->satellite.system] = true;
        AppendKepler(*kepler, &body);
      }
    } else if (const auto* state = std::get_if<StateEphemeris>(&record)) {
      header.systems[state->satellite.system] = true;
      AppendState(*state, &body);
    } else if (const auto* ionosphere = std::get_if<IonosphereMessage>(&record)) {
      has_place = header.Take(*ionosphere);
    } else if (const auto* offset = std::get_if<TimeOffsetMessage>(&record)) {
      has_place = header.Take(*offset);
    } else if (const auto* leap = std::get_if<LeapSecondMessage>(&record)) {
      header.leap_seconds = *leap;
    } else {
      has_place = false;
    }
    ++(has_place ? file.records_written : file.records_left_out);
  }
  file.text = HeaderText(header, options) + body;
  return file;
}

}  // namespace lodemark
