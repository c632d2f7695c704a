#include "core/logs/rinex_navigation_header.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/parse_number.h"
#include "core/logs/rinex_navigation_system.h"
#include "core/logs/rinex_navigation_text.h"

namespace lodemark {
namespace {

constexpr std::string_view kVersionLabel = "RINEX VERSION / TYPE";

std::string_view LabelOf(std::string_view line) { return TrimSpaces(Columns(line, 60, 20)); }

// Where width columns hold one number. A blank counts as zero.
std::optional<double> NumberAt(std::string_view line, std::size_t first, std::size_t width) {
  const std::string_view text = TrimSpaces(Columns(line, first, width));
  return text.empty() ? 0.0 : ParseDouble(text);
}

std::optional<std::array<double, 4>> FourNumbers(std::string_view line, std::size_t first) {
  std::array<double, 4> numbers = {};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<double> number = NumberAt(line, first + 12 * i, 12);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

// Type letters of RINEX 2 files, the customary ones beyond 2.12 included.
std::optional<System> SystemOfFile2(char letter) {
  switch (letter) {
    case 'N':
      return System::kGps;
    case 'G':
      return System::kGlonass;
    case 'H':
      return System::kSbas;
    case 'L':
    case 'E':
      return System::kGalileo;
    case 'J':
    case 'Q':
      return System::kQzss;
    case 'C':
    case 'B':
      return System::kBeidou;
    default:
      return std::nullopt;
  }
}

// RINEX 3.04 table A5, and GPGA as 3.00 wrote GAGP. The first system is the one that sends it.
std::optional<System> SystemOfOffset(std::string_view label) {
  const std::string_view from = label.substr(0, 2);
  if (label == "GPGA" || from == "GA") return System::kGalileo;
  if (from == "GP") return System::kGps;
  if (from == "GL") return System::kGlonass;
  if (from == "BD") return System::kBeidou;
  if (from == "QZ") return System::kQzss;
  if (from == "IR") return System::kNavic;
  if (from == "SB") return System::kSbas;
  return std::nullopt;
}

// Zero where the writer gave neither.
std::optional<std::int64_t> ReferenceTime(System system, double week, double second_of_week) {
  if (week == 0.0 && second_of_week == 0.0) return 0;
  if (!(week >= 0.0 && week <= 6000.0 && std::abs(second_of_week) <= 2 * 604'800.0)) {
    return std::nullopt;
  }
  auto whole_week = static_cast<std::int64_t>(week);
  // BeiDou counts from 2006-01-01, which is GPS week 1356; Galileo and NavIC sent nothing before
  // GPS week 1024, so a smaller number is their own, counted from 1999-08-22.
  if (system == System::kBeidou) whole_week += 1356;
  const bool own_count = system == System::kGalileo || system == System::kNavic;
  if (own_count && whole_week < 1280) whole_week += 1024;
  const std::int64_t time_ns = whole_week * kWeek_ns + std::llround(second_of_week * 1e9);
  return GpsFromScale(time_ns, system == System::kBeidou ? TimeScale::kBeidou : TimeScale::kGps);
}

void SetLabel(std::string_view label, TimeOffsetMessage* message) {
  std::copy_n(label.begin(), std::min(label.size(), message->label.size()), message->label.begin());
}

}  // namespace

bool RinexNavigationHeader::IsVersionLine(std::string_view line) {
  return LabelOf(line) == kVersionLabel;
}

Status RinexNavigationHeader::ReadVersion(std::string_view line, const std::string& file) {
  if (!IsVersionLine(line)) {
    return Error{ErrorCode::kBadData,
                 file + ":1: not a RINEX file: no RINEX VERSION / TYPE in columns 61 to 80"};
  }
  const std::optional<double> version = ParseDouble(Columns(line, 0, 9));
  if (!version || !(*version >= 1.99 && *version < 5.0)) {
    return Error{ErrorCode::kUnsupported,
                 file + ":1: RINEX version is not 2, 3 or 4; convert the file first"};
  }
  major_version_ = static_cast<int>(*version + 0.001);
  const char type = line.size() > 20 ? line[20] : ' ';
  const std::optional<System> system = SystemOfFile2(type);
  if (type == 'O' || !system || (major_version_ >= 3 && type != 'N')) {
    return Error{ErrorCode::kBadData, file + ":1: a RINEX file, but of type '" +
                                          std::string(1, type) + "' and not navigation"};
  }
  system_ = *system;
  // RINEX 3 and 4: only a hint for whose leap seconds these are.
  if (major_version_ >= 3) {
    system_ = SystemFromLetter(line.size() > 40 ? line[40] : 'M').value_or(System::kGps);
  }
  return Status();
}

Status RinexNavigationHeader::Read(std::string_view version_line, LineReader* lines,
                                   const Sink& sink, ReadReport* report) {
  klobuchar_ = {};
  const Status version = ReadVersion(version_line, lines->name());
  if (!version) return version;
  std::string_view line;
  while (lines->Next(&line)) {
    if (LabelOf(line) == "END OF HEADER") return Status();
    ReadLine(line, lines->line_number(), sink, report);
  }
  if (!lines->status()) return lines->status();
  return Error{ErrorCode::kBadData, lines->name() + ": the header has no END OF HEADER"};
}

void RinexNavigationHeader::ReadLine(std::string_view line, std::int64_t line_number,
                                     const Sink& sink, ReadReport* report) {
  const std::string_view label = LabelOf(line);
  bool good = true;
  if (label == "IONOSPHERIC CORR") {
    good = ReadIonosphere(line, sink);
  } else if (label == "ION ALPHA") {
    good = AddHalf(system_, true, line, 2, sink);
  } else if (label == "ION BETA") {
    good = AddHalf(system_, false, line, 2, sink);
  } else if (label == "TIME SYSTEM CORR") {
    good = ReadTimeOffset(line, sink);
  } else if (label == "DELTA-UTC: A0,A1,T,W" || label == "DELTA UTC: A0,A1,T,W") {
    good = ReadOffset2(line, "GPUT", sink);
  } else if (label == "D-UTC A0,A1,T,W,S,U") {
    good = ReadOffset2(line, "SBUT", sink);
  } else if (label == "CORR TO SYSTEM TIME") {
    good = ReadGlonassOffset2(line, sink);
  } else if (label == "LEAP SECONDS") {
    good = ReadLeapSeconds(line, sink);
  }
  if (!good) {
    report->Skip(line_number, 0, "header: no sensible numbers for " + std::string(label));
  }
}

bool RinexNavigationHeader::AddHalf(System system, bool alpha, std::string_view line,
                                    std::size_t first, const Sink& sink) {
  const auto numbers = FourNumbers(line, first);
  if (!numbers) return false;
  Halves& halves = klobuchar_[static_cast<std::size_t>(system)];
  (alpha ? halves.alpha : halves.beta) = numbers;
  if (!halves.alpha || !halves.beta) return true;
  KlobucharParameters model;
  model.system = system;
  model.alpha = *halves.alpha;
  model.beta = *halves.beta;
  halves = Halves();
  if (!IsPlausible(model)) return false;
  IonosphereMessage message;
  message.satellite = {system, 0};
  message.model = model;
  sink(message);
  return true;
}

bool RinexNavigationHeader::ReadIonosphere(std::string_view line, const Sink& sink) {
  const std::string_view name = TrimSpaces(Columns(line, 0, 4));
  if (name == "GAL") {
    const auto numbers = FourNumbers(line, 5);
    if (!numbers) return false;
    GalileoIonosphereParameters model;
    std::copy_n(numbers->begin(), 3, model.a.begin());
    if (!IsPlausible(model)) return false;
    IonosphereMessage message;
    message.satellite = {System::kGalileo, 0};
    message.model = model;
    sink(message);
    return true;
  }
  if (name.size() != 4 || (name[3] != 'A' && name[3] != 'B')) return false;
  const std::string_view system = name.substr(0, 3);
  const bool alpha = name[3] == 'A';
  if (system == "GPS") return AddHalf(System::kGps, alpha, line, 5, sink);
  if (system == "BDS") return AddHalf(System::kBeidou, alpha, line, 5, sink);
  if (system == "QZS") return AddHalf(System::kQzss, alpha, line, 5, sink);
  if (system == "IRN") return AddHalf(System::kNavic, alpha, line, 5, sink);
  return false;
}

bool RinexNavigationHeader::ReadTimeOffset(std::string_view line, const Sink& sink) {
  const std::string_view label = Columns(line, 0, 4);
  if (label.size() != 4) return false;
  const std::optional<System> system = SystemOfOffset(label);
  const auto a0_s = NumberAt(line, 5, 17);
  const auto a1_sps = NumberAt(line, 22, 16);
  const auto second_of_week = NumberAt(line, 38, 7);
  const auto week = NumberAt(line, 45, 5);
  if (!system || !a0_s || !a1_sps || !second_of_week || !week) return false;
  const auto reference_ns = ReferenceTime(*system, *week, *second_of_week);
  if (!reference_ns || !(std::abs(*a0_s) < 1.0)) return false;
  TimeOffsetMessage message;
  message.satellite = {*system, 0};
  SetLabel(label, &message);
  message.reference_gps_ns = *reference_ns;
  message.a0_s = *a0_s;
  message.a1_sps = *a1_sps;
  sink(message);
  return true;
}

// RINEX 2.11 tables A4 and A17.
bool RinexNavigationHeader::ReadOffset2(std::string_view line, std::string_view label,
                                        const Sink& sink) {
  const bool sbas = label == "SBUT";
  const auto a0_s = NumberAt(line, sbas ? 0 : 3, 19);
  const auto a1_sps = NumberAt(line, sbas ? 19 : 22, 19);
  const auto second_of_week = NumberAt(line, sbas ? 38 : 41, sbas ? 7 : 9);
  const auto week = NumberAt(line, sbas ? 45 : 50, sbas ? 5 : 9);
  if (!a0_s || !a1_sps || !second_of_week || !week) return false;
  const auto reference_ns = ReferenceTime(System::kGps, *week, *second_of_week);
  if (!reference_ns || !(std::abs(*a0_s) < 1.0)) return false;
  TimeOffsetMessage message;
  message.satellite = {sbas ? System::kSbas : System::kGps, 0};
  SetLabel(label, &message);
  message.reference_gps_ns = *reference_ns;
  message.a0_s = *a0_s;
  message.a1_sps = *a1_sps;
  sink(message);
  return true;
}

// RINEX 2.11 table A10: the day it holds from, and -TauC.
bool RinexNavigationHeader::ReadGlonassOffset2(std::string_view line, const Sink& sink) {
  const auto year = NumberAt(line, 0, 6);
  const auto month = NumberAt(line, 6, 6);
  const auto day = NumberAt(line, 12, 6);
  const auto a0_s = NumberAt(line, 21, 19);
  if (!year || !month || !day || !a0_s || !(std::abs(*a0_s) < 1.0)) return false;
  const auto small = [](double value) { return value >= 0.0 && value <= 9999.0; };
  if (!small(*year) || !small(*month) || !small(*day)) return false;
  CalendarTime calendar;
  calendar.year = static_cast<int>(*year);
  calendar.month = static_cast<int>(*month);
  calendar.day = static_cast<int>(*day);
  const auto reference_ns = NanosecondsFromCalendar(calendar);
  if (!reference_ns) return false;
  TimeOffsetMessage message;
  message.satellite = {System::kGlonass, 0};
  SetLabel("GLUT", &message);
  message.reference_gps_ns = GpsFromScale(*reference_ns, TimeScale::kUtc);
  message.a0_s = *a0_s;
  sink(message);
  return true;
}

bool RinexNavigationHeader::ReadLeapSeconds(std::string_view line, const Sink& sink) {
  const std::optional<std::int64_t> seconds = ParseInteger(Columns(line, 0, 6));
  if (!seconds || *seconds < 0 || *seconds > 99) return false;
  LeapSecondMessage message;
  message.leap_seconds = static_cast<std::int32_t>(*seconds);
  // BeiDou's own count began 14 s later; some receivers write it into BeiDou files unlabelled, and
  // no BeiDou file dates from before GPS's count reached 14.
  const bool labelled = TrimSpaces(Columns(line, 24, 3)) == "BDS";
  if (labelled || (system_ == System::kBeidou && message.leap_seconds < 14)) {
    message.leap_seconds += 14;
  }
  sink(message);
  return true;
}

}  // namespace lodemark
