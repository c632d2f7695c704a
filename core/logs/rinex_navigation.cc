#include "core/logs/rinex_navigation.h"

#include <optional>
#include <string_view>
#include <utility>

#include "core/gnss/broadcast_rules.h"
#include "core/logs/parse_number.h"
#include "core/logs/rinex_navigation_header.h"
#include "core/logs/rinex_navigation_kepler.h"
#include "core/logs/rinex_navigation_state.h"
#include "core/logs/rinex_navigation_system.h"
#include "core/logs/rinex_navigation_text.h"

namespace lodemark {
namespace {

using Sink = std::function<void(const NavigationRecord&)>;

constexpr int kIndent2 = 3;
constexpr int kIndent3 = 4;

bool IsBlankLine(std::string_view line) { return TrimSpaces(line).empty(); }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsDigitOrBlank(char c) { return IsDigit(c) || c == ' '; }

// "12 19  4 28": a satellite number and a blank.
bool StartsRecord2(std::string_view line) {
  return line.size() > 22 && IsDigitOrBlank(line[0]) && IsDigit(line[1]) && line[2] == ' ' &&
         IsDigit(line[4]);
}

// "G07 2019 04 28"
bool StartsRecord3(std::string_view line) {
  return line.size() > 23 && line[0] >= 'A' && line[0] <= 'Z' && IsDigitOrBlank(line[1]) &&
         IsDigit(line[2]) && line[3] == ' ' && IsDigit(line[7]) && line[8] == ' ';
}

bool ContinuesRecord(std::string_view line, int indent) {
  return IsBlankLine(Columns(line, 0, static_cast<std::size_t>(indent)));
}

// A satellite, or a system with a blank number ("E  ", whose number is then 0).
std::optional<SatelliteId> Sender(std::string_view name) {
  if (name.empty()) return std::nullopt;
  if (const auto satellite = SatelliteFromName(name)) return satellite;
  const std::optional<System> system = SystemFromLetter(name[0]);
  if (!system || !IsBlankLine(name.substr(1))) return std::nullopt;
  return SatelliteId{*system, 0};
}

class Reader {
 public:
  Reader(LineReader* lines, const Sink& sink, ReadReport* report)
      : lines_(*lines), sink_(sink), report_(*report) {}

  Status Read() {
    std::string_view line;
    if (!lines_.Next(&line)) {
      if (!lines_.status()) return lines_.status();
      return Error{ErrorCode::kBadData, lines_.name() + ": the file is empty"};
    }
    if (Status header = header_.Read(line, &lines_, sink_, &report_); !header) return header;
    while (lines_.Next(&line)) {
      if (RinexNavigationHeader::IsVersionLine(line)) {  // files strung together
        Finish();
        if (Status header = header_.Read(line, &lines_, sink_, &report_); !header) return header;
        continue;
      }
      Take(line);
    }
    Finish();
    return lines_.status();
  }

 private:
  enum class Place : std::uint8_t { kOutside, kInRecord, kLost };

  void Take(std::string_view line) {
    const int version = header_.major_version();
    const bool starts = version == 2   ? StartsRecord2(line)
                        : version == 3 ? StartsRecord3(line)
                                       : !line.empty() && line[0] == '>';
    if (starts) {
      Finish();
      place_ = Place::kInRecord;
      start_line_ = lines_.line_number();
      text_.Start(version == 2 ? kIndent2 : kIndent3);
      if (version >= 4) {
        heading_.assign(line.substr(0, 64));
      } else {
        text_.Append(lines_.line_number(), line);
      }
      return;
    }
    if (version < 4 && !ContinuesRecord(line, version == 2 ? kIndent2 : kIndent3)) {
      Finish();
      place_ = Place::kLost;  // until the next record starts
      Skip(lines_.line_number(), 0, "the line neither starts nor continues a record");
      return;
    }
    if (place_ == Place::kInRecord) {
      text_.Append(lines_.line_number(), line);
    } else if (place_ == Place::kOutside && !IsBlankLine(line)) {
      place_ = Place::kLost;
      Skip(lines_.line_number(), 0, "the line belongs to no record");
    }
  }

  void Finish() {
    if (std::exchange(place_, Place::kOutside) != Place::kInRecord) return;
    if (header_.major_version() >= 4) {
      Finish4();
      return;
    }
    SatelliteId satellite;
    if (header_.major_version() == 2) {
      if (!Satellite2(&satellite)) return;
    } else {
      const std::string_view name = Columns(text_.line(0), 0, 3);
      if (!SystemFromLetter(name[0])) {
        ++report_.rows_unknown;
        return;
      }
      const std::optional<SatelliteId> named = text_.Satellite();
      if (!named) {
        Skip(start_line_, 2, "'" + std::string(name) + "' is not a satellite");
        return;
      }
      satellite = *named;
    }
    ReadEphemeris(satellite, {});
  }

  bool Satellite2(SatelliteId* satellite) {
    const auto number = ParseInteger(Columns(text_.line(0), 0, 2));
    if (!number || *number < 1 || *number > LargestSatelliteNumber(header_.system())) {
      Skip(start_line_, 1, "not a satellite number of this system");
      return false;
    }
    *satellite = {header_.system(), static_cast<std::uint8_t>(*number)};
    return true;
  }

  // "> EPH G01 LNAV"
  void Finish4() {
    const std::string_view heading = heading_;
    const std::string_view kind = TrimSpaces(Columns(heading, 2, 3));
    const std::string_view message = TrimSpaces(Columns(heading, 10, 4));
    const std::optional<SatelliteId> sender = Sender(Columns(heading, 6, 3));
    const bool known = kind == "EPH" || kind == "STO" || kind == "EOP" || kind == "ION";
    if (!known) {
      ++report_.rows_unknown;
    } else if (!sender) {
      Skip(start_line_, 7, "the record names no satellite or system");
    } else if (kind != "EPH") {
      ReadSystemRecord(kind, *sender, message);
    } else if (text_.Satellite() != sender) {
      Skip(text_.line_number(0), 1, "the satellite is not the one in the record's heading");
    } else {
      ReadEphemeris(*sender, message);
    }
  }

  void ReadEphemeris(SatelliteId satellite, std::string_view message) {
    const std::optional<std::int64_t> epoch_ns = text_.Epoch();
    if (!epoch_ns) {
      Skip(text_.line_number(0), 4, "the epoch is no date");
      return;
    }
    if (satellite.system == System::kGlonass || satellite.system == System::kSbas) {
      ReadStateEphemeris(satellite, *epoch_ns, message);
    } else {
      ReadKeplerEphemeris(satellite, *epoch_ns, message);
    }
  }

  void ReadStateEphemeris(SatelliteId satellite, std::int64_t epoch_ns, std::string_view message) {
    const bool glonass = satellite.system == System::kGlonass;
    if (!message.empty() && message != (glonass ? "FDMA" : "SBAS")) {
      ++report_.rows_unknown;
      return;
    }
    if (!HasLines(kStateLines)) return;
    StateEphemeris ephemeris;
    const auto fault = ReadState(&text_, satellite, epoch_ns, &ephemeris);
    Give(fault, ephemeris, glonass ? kGlonassMostLines : kStateLines);
  }

  void ReadKeplerEphemeris(SatelliteId satellite, std::int64_t epoch_ns, std::string_view message) {
    const KeplerLayout* layout = message.empty()
                                     ? FindKeplerLayout(satellite.system, UsualMessage(satellite))
                                     : FindKeplerLayout(satellite.system, message);
    if (layout == nullptr) {
      ++report_.rows_unknown;
      return;
    }
    if (!HasLines(layout->least_lines)) return;
    KeplerEphemeris ephemeris;
    const auto fault =
        ReadKepler(&text_, *layout, satellite, epoch_ns, !message.empty(), &ephemeris);
    Give(fault, ephemeris, layout->usual_lines);
  }

  // Of RINEX 2 and 3, which name no message. Galileo's is found out from the record.
  static MessageType UsualMessage(SatelliteId satellite) {
    if (satellite.system == System::kGalileo) return MessageType::kInav;
    if (satellite.system != System::kBeidou) return MessageType::kLnav;
    return IsBeidouGeostationary(satellite) ? MessageType::kD2 : MessageType::kD1;
  }

  void ReadSystemRecord(std::string_view kind, SatelliteId sender, std::string_view message) {
    if (kind == "ION" && !IsIonosphereMessage(sender.system, message)) {
      ++report_.rows_unknown;
      return;
    }
    const std::optional<std::int64_t> epoch_ns = text_.Epoch();
    if (!epoch_ns) {
      Skip(text_.lines() > 0 ? text_.line_number(0) : start_line_, 5, "the epoch is no date");
    } else if (kind == "STO") {
      TimeOffsetMessage offset;
      const auto fault = ReadTimeOffset(&text_, sender, *epoch_ns, &offset);
      Give(fault, offset, 2);
    } else if (kind == "EOP") {
      EarthOrientationMessage orientation;
      const auto fault = ReadEarthOrientation(&text_, sender, *epoch_ns, &orientation);
      Give(fault, orientation, 3);
    } else {
      IonosphereMessage ionosphere;
      const auto fault = ReadIonosphere(&text_, sender, message, *epoch_ns, &ionosphere);
      Give(fault, ionosphere, 3);
    }
  }

  bool HasLines(int least) {
    if (text_.lines() >= least) return true;
    Skip(start_line_, 0,
         "the record ends after " + std::to_string(text_.lines()) + " lines of " +
             std::to_string(least));
    return false;
  }

  void Give(const std::optional<NavigationFault>& fault, const NavigationRecord& record,
            int usual_lines) {
    if (fault) {
      const std::string value(TrimSpaces(text_.Raw(fault->place)));
      Skip(text_.line_number(fault->place.line), text_.Column(fault->place),
           fault->element.empty()
               ? "'" + value + "' is not a number"
               : "'" + value + "' is no possible " + std::string(fault->element));
      return;
    }
    ++report_.rows_read;
    sink_(record);
    for (int i = usual_lines; i < text_.lines(); ++i) {
      if (IsBlankLine(text_.line(i))) continue;
      Skip(text_.line_number(i), 0, "the line is more than the record before it holds");
      break;
    }
  }

  void Skip(std::int64_t line, std::int32_t column, const std::string& reason) {
    report_.Skip(line, column, reason);
  }

  LineReader& lines_;
  const Sink& sink_;
  ReadReport& report_;
  RinexNavigationHeader header_;
  NavigationText text_;
  std::string heading_;  // of a RINEX 4 record
  std::int64_t start_line_ = 0;
  Place place_ = Place::kOutside;
};

}  // namespace

Status ReadRinexNavigation(LineReader* lines, const Sink& sink, ReadReport* report) {
  report->file = lines->name();
  return Reader(lines, sink, report).Read();
}

Status ReadRinexNavigation(const std::string& path, const Sink& sink, ReadReport* report) {
  report->file = path;
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return ReadRinexNavigation(&lines.value(), sink, report);
}

}  // namespace lodemark
