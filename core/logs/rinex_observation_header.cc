#include "core/logs/rinex_observation_header.h"

#include <algorithm>
#include <cmath>

#include "core/geo/time.h"
#include "core/logs/parse_number.h"
#include "core/logs/rinex_fields.h"

namespace lodemark {
namespace {

constexpr std::size_t kTypesPerLine = 13;
constexpr std::size_t kRinex2TypesPerLine = 9;
constexpr std::size_t kScaledTypesPerLine = 12;
constexpr std::size_t kLabelColumn = 60;
constexpr int kBeidouBehindGps_s = 14;

// From the middle of the Earth; beyond geostationary orbit nobody measures.
constexpr double kNearest_m = 6.0e6;
constexpr double kFarthest_m = 5.0e7;
constexpr double kLongestAntennaDelta_m = 1000.0;
constexpr double kLongestInterval_s = 86'400.0;

std::size_t Index(System system) { return static_cast<std::size_t>(system); }

System SystemFromIndex(std::size_t index) { return static_cast<System>(index); }

// The clock of a file that names none (RINEX 3.04 table A2, TIME OF FIRST OBS).
TimeScale DefaultTimeScale(System system) {
  switch (system) {
    case System::kGlonass:
      return TimeScale::kUtc;
    case System::kGalileo:
      return TimeScale::kGalileo;
    case System::kBeidou:
      return TimeScale::kBeidou;
    case System::kQzss:
      return TimeScale::kQzss;
    case System::kNavic:
      return TimeScale::kNavic;
    case System::kGps:
    case System::kSbas:
      break;
  }
  return TimeScale::kGps;
}

std::optional<Eigen::Vector3d> ParseVector(std::string_view line) {
  constexpr std::size_t kWidth = 14;
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    const auto first = static_cast<std::size_t>(i) * kWidth;
    const std::optional<double> value = ParseDouble(RinexColumns(line, first, kWidth));
    if (!value) return std::nullopt;
    vector[i] = *value;
  }
  return vector;
}

}  // namespace

std::optional<System> RinexSystemFromLetter(char letter) {
  return letter == 'Q' ? System::kQzss : SystemFromLetter(letter);
}

Status RinexObservationHeaderParser::ParseVersion(std::string_view line, const std::string& file) {
  const auto fail = [&](ErrorCode code, const std::string& message) {
    return Status(Error{code, file + ": " + message});
  };
  if (RinexLabel(line) != "RINEX VERSION / TYPE") {
    return fail(ErrorCode::kBadData,
                "is no RINEX file: its first line is not labelled RINEX VERSION / TYPE");
  }
  const std::optional<double> version = ParseDouble(RinexColumns(line, 0, 9));
  if (!version) return fail(ErrorCode::kBadData, "states no RINEX version in its first line");
  if (*version < 2.0 || *version >= 5.0) {
    return fail(ErrorCode::kUnsupported, "has RINEX version " + std::string(RinexText(line, 0, 9)) +
                                             "; versions 2, 3 and 4 can be read");
  }
  const std::string_view type = RinexText(line, 20, 20);
  if (type.empty() || (type[0] != 'O' && type[0] != 'o')) {
    return fail(ErrorCode::kBadData,
                "is no RINEX observation file, its type is '" + std::string(type) + "'");
  }
  header_.version = *version;
  const std::string_view system = RinexText(line, 40, 20);
  header_.mixed = !system.empty() && system[0] == 'M';
  if (!system.empty() && !header_.mixed) {
    header_.file_system = RinexSystemFromLetter(system[0]).value_or(System::kGps);
  }
  header_.time_scale = header_.mixed ? TimeScale::kGps : DefaultTimeScale(header_.file_system);
  return {};
}

void RinexObservationHeaderParser::ParseRecord(std::string_view line, std::int64_t line_number,
                                               ReadReport* report) {
  const std::string_view label = RinexLabel(line);
  const bool version2 = header_.version < 3.0;
  bool good = true;
  if (label == "SYS / # / OBS TYPES" && !version2) {
    types_changed_ = true;
    good = ParseTypes(line);
  } else if (label.starts_with("# / TYPES OF OBSERV") && version2) {
    types_changed_ = true;
    good = ParseRinex2Types(line);
  } else if (label == "SYS / SCALE FACTOR") {
    types_changed_ = true;
    good = ParseScaleFactor(line);
  } else if (label == "GLONASS SLOT / FRQ #") {
    good = ParseGlonassSlots(line);
  } else if (label == "APPROX POSITION XYZ") {
    good = ParsePosition(line);
  } else if (label == "ANTENNA: DELTA H/E/N") {
    good = ParseAntennaDelta(line);
  } else if (label == "LEAP SECONDS") {
    good = ParseLeapSeconds(line);
  } else if (label == "TIME OF FIRST OBS") {
    good = ParseTimeScale(line);
  } else {
    good = ParseText(label, line);
  }
  if (!good) report->Skip(line_number, 0, "malformed header record " + std::string(label));
}

void RinexObservationHeaderParser::Finish() {
  types_system_.reset();
  scale_system_.reset();
  if (types_changed_) SettleTypes();
  types_changed_ = false;
}

const RinexRecordLayout& RinexObservationHeaderParser::layout(System system) const {
  return layouts_[Index(system)];
}

std::int8_t RinexObservationHeaderParser::glonass_channel(int slot) const {
  const auto found = header_.glonass_channels.find(slot);
  return found == header_.glonass_channels.end() ? kUnknownGlonassChannel : found->second;
}

bool RinexObservationHeaderParser::ParseRinex2Types(std::string_view line) {
  const std::string_view count_field = RinexText(line, 0, 6);
  if (!count_field.empty()) {
    const std::optional<int> count = RinexCount(count_field);
    if (!count) return false;
    rinex2_types_.clear();
    rinex2_declared_ = std::min(static_cast<std::size_t>(*count), kMostTypes);
    if (static_cast<std::size_t>(*count) > kMostTypes) return false;
  }
  for (std::size_t i = 0; i < kRinex2TypesPerLine; ++i) {
    if (rinex2_types_.size() >= rinex2_declared_) break;
    const std::string_view type = RinexText(line, 6 + 6 * i, 6);
    if (type.empty()) return i > 0;
    rinex2_types_.emplace_back(type);
  }
  return true;
}

bool RinexObservationHeaderParser::ParseTypes(std::string_view line) {
  const std::string_view letter = RinexText(line, 0, 1);
  if (!letter.empty()) {
    types_system_ = RinexSystemFromLetter(letter[0]);
    if (!types_system_) return false;
    const std::optional<int> count = RinexCount(RinexColumns(line, 3, 3));
    if (!count) return false;
    TypeList& list = types_[Index(*types_system_)];
    list.types.clear();
    list.declared = std::min(static_cast<std::size_t>(*count), kMostTypes);
  }
  if (!types_system_) return false;
  TypeList& list = types_[Index(*types_system_)];
  for (std::size_t i = 0; i < kTypesPerLine && list.types.size() < list.declared; ++i) {
    const std::string_view type = RinexText(line, 7 + 4 * i, 3);
    list.types.push_back(CurrentRinexType(*types_system_, type, header_.version));
  }
  return true;
}

bool RinexObservationHeaderParser::ParseScaleFactor(std::string_view line) {
  const std::string_view letter = RinexText(line, 0, 1);
  if (!letter.empty()) {
    scale_system_ = RinexSystemFromLetter(letter[0]);
    const std::optional<int> factor = RinexCount(RinexColumns(line, 2, 4));
    if (!scale_system_ || !factor || *factor < 1) return false;
    scale_divisor_ = *factor;
    const std::string_view count = RinexText(line, 8, 2);
    if (count.empty() || count == "0") {
      scale_factors_[Index(*scale_system_)].assign(1, ScaleFactor{"", scale_divisor_});
      return true;
    }
  }
  if (!scale_system_) return false;
  std::vector<ScaleFactor>& factors = scale_factors_[Index(*scale_system_)];
  for (std::size_t i = 0; i < kScaledTypesPerLine && factors.size() < kMostTypes; ++i) {
    const std::string_view type = RinexText(line, 11 + 4 * i, 3);
    if (type.empty()) break;
    factors.push_back({CurrentRinexType(*scale_system_, type, header_.version), scale_divisor_});
  }
  return true;
}

// Found by their letter: phone loggers are known to shift the columns by one.
bool RinexObservationHeaderParser::ParseGlonassSlots(std::string_view line) {
  const std::string_view slots = RinexColumns(line, 0, kLabelColumn);
  for (std::size_t at = slots.find('R'); at < slots.size(); at = slots.find('R', at + 1)) {
    const std::optional<SatelliteId> satellite = SatelliteFromName(slots.substr(at, 3));
    const std::optional<std::int64_t> channel = ParseInteger(RinexColumns(slots, at + 3, 3));
    if (!satellite || !channel || *channel < -7 || *channel > 6) return false;
    header_.glonass_channels[satellite->number] = static_cast<std::int8_t>(*channel);
  }
  return true;
}

bool RinexObservationHeaderParser::ParsePosition(std::string_view line) {
  const std::optional<Eigen::Vector3d> position = ParseVector(line);
  header_.approximate_position_in_ecef.reset();
  if (!position) return RinexText(line, 0, 42).empty();
  const double radius_m = position->norm();
  if (radius_m == 0.0) return true;
  if (radius_m < kNearest_m || radius_m > kFarthest_m) return false;
  header_.approximate_position_in_ecef = *position;
  return true;
}

bool RinexObservationHeaderParser::ParseAntennaDelta(std::string_view line) {
  const std::optional<Eigen::Vector3d> delta = ParseVector(line);
  if (!delta) return RinexText(line, 0, 42).empty();
  if (delta->norm() > kLongestAntennaDelta_m) return false;
  header_.antenna_delta_hen_m = *delta;
  return true;
}

bool RinexObservationHeaderParser::ParseLeapSeconds(std::string_view line) {
  const std::string_view field = RinexText(line, 0, 6);
  if (field.empty()) return true;
  const std::optional<int> seconds = RinexCount(field);
  if (!seconds || *seconds > 99) return false;
  // Version 3 can count them from BeiDou time instead (RINEX 3.04 table A2).
  const std::string_view scale = RinexText(line, 24, 3);
  const bool beidou = scale == "BDS" || scale == "BDT";
  header_.leap_seconds = *seconds + (beidou ? kBeidouBehindGps_s : 0);
  return true;
}

bool RinexObservationHeaderParser::ParseTimeScale(std::string_view line) {
  const std::string_view scale = RinexText(line, 48, 3);
  if (scale == "GPS") {
    header_.time_scale = TimeScale::kGps;
  } else if (scale == "GLO" || scale == "UTC") {
    header_.time_scale = TimeScale::kUtc;  // RINEX writes GLONASS time without its 3 h
  } else if (scale == "GAL") {
    header_.time_scale = TimeScale::kGalileo;
  } else if (scale == "BDT" || scale == "BDS") {
    header_.time_scale = TimeScale::kBeidou;
  } else if (scale == "QZS") {
    header_.time_scale = TimeScale::kQzss;
  } else if (scale == "IRN") {
    header_.time_scale = TimeScale::kNavic;
  } else {
    return scale.empty();
  }
  return true;
}

bool RinexObservationHeaderParser::ParseText(std::string_view label, std::string_view line) {
  if (label == "MARKER NAME") {
    header_.marker_name = RinexText(line, 0, 60);
  } else if (label == "REC # / TYPE / VERS") {
    header_.receiver = RinexText(line, 20, 20);
  } else if (label == "ANT # / TYPE") {
    header_.antenna = RinexText(line, 20, 20);
  } else if (label == "SIGNAL STRENGTH UNIT") {
    const std::string_view unit = RinexText(line, 0, 20);
    strength_in_dbhz_ = unit.empty() || unit == "DBHZ";
  } else if (label == "INTERVAL") {
    const std::optional<double> interval_s = ParseDouble(RinexColumns(line, 0, 10));
    if (!interval_s) return RinexText(line, 0, 10).empty();
    if (*interval_s < 0.0 || *interval_s > kLongestInterval_s) return false;
    if (*interval_s > 0.0) header_.interval_s = *interval_s;
  }
  return true;
}

void RinexObservationHeaderParser::SettleTypes() {
  header_.types.clear();
  for (std::size_t i = 0; i < layouts_.size(); ++i) {
    const System system = SystemFromIndex(i);
    const std::vector<std::string> types =
        header_.version < 3.0 ? TranslateRinex2Types(system, rinex2_types_, header_.version)
                              : types_[i].types;
    layouts_[i] = LayOutRinexRecord(system, types);
    for (std::size_t k = 0; k < types.size(); ++k) {
      layouts_[i].columns[k].scale_divisor = ScaleDivisor(system, types[k]);
    }
    if (header_.version < 3.0 && !header_.mixed && system != header_.file_system) continue;
    std::vector<std::string> named;
    std::copy_if(types.begin(), types.end(), std::back_inserter(named),
                 [](const std::string& type) { return !type.empty(); });
    if (!named.empty()) header_.types[system] = std::move(named);
  }
}

double RinexObservationHeaderParser::ScaleDivisor(System system, std::string_view type) const {
  double divisor = 1.0;
  for (const ScaleFactor& factor : scale_factors_[Index(system)]) {
    if (factor.type.empty() || factor.type == type) divisor = factor.divisor;
  }
  return divisor;
}

}  // namespace lodemark
