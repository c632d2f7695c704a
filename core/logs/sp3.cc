#include "core/logs/sp3.h"

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

constexpr double kKilometre_m = 1e3;
constexpr double kMillimetre_m = 1e-3;
constexpr double kMicrosecond_s = 1e-6;
constexpr double kAbsentClock_us = 999'999.0;

// SP3-d knows 999 satellites in a header.
constexpr std::size_t kMostSatellites = 999;
constexpr std::size_t kPerLine = 17;

// Medium to geosynchronous orbits, inclined and eccentric ones included.
constexpr double kLowest_m = 15e6;
constexpr double kHighest_m = 60e6;

std::string_view Columns(std::string_view line, std::size_t first, std::size_t width) {
  return first < line.size() ? line.substr(first, width) : std::string_view();
}

char CharacterAt(std::string_view line, std::size_t column) {
  return column < line.size() ? line[column] : ' ';
}

// SP3-a numbers GPS satellites without a letter.
std::optional<SatelliteId> SatelliteAt(std::string_view line, std::size_t column) {
  std::string name(Columns(line, column, 3));
  if (name.size() == 3 && name[0] == ' ') name[0] = 'G';
  return SatelliteFromName(name);
}

// "2016  6  6  0  0  0.00000000"
std::optional<std::int64_t> CalendarAt(std::string_view line, std::size_t column) {
  constexpr std::array<std::size_t, 5> kOffsets = {0, 5, 8, 11, 14};
  std::array<int, 5> parts = {};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto value = ParseInteger(Columns(line, column + kOffsets[i], i == 0 ? 4 : 2));
    if (!value || *value < 0 || *value > 9999) return std::nullopt;
    parts[i] = static_cast<int>(*value);
  }
  const std::optional<double> second = ParseDouble(Columns(line, column + 17, 11));
  if (!second) return std::nullopt;
  return NanosecondsFromCalendar({parts[0], parts[1], parts[2], parts[3], parts[4], *second});
}

// The scale that the first %c line names. SP3-a has none there and means GPS time.
struct EpochScale {
  TimeScale scale = TimeScale::kGps;
  std::int64_t ahead_of_gps_ns = 0;  // international atomic time alone
};

std::optional<EpochScale> ScaleFromName(std::string_view name) {
  if (name == "GPS" || name == "ccc" || name.empty()) return EpochScale{};
  if (name == "GAL") return EpochScale{TimeScale::kGalileo, 0};
  if (name == "QZS") return EpochScale{TimeScale::kQzss, 0};
  if (name == "IRN") return EpochScale{TimeScale::kNavic, 0};
  if (name == "BDT" || name == "BDS") return EpochScale{TimeScale::kBeidou, 0};
  // "GLO to identify the GLONASS UTC time system": UTC, without the three hours of Moscow.
  if (name == "UTC" || name == "GLO") return EpochScale{TimeScale::kUtc, 0};
  if (name == "TAI") return EpochScale{TimeScale::kGps, 19 * kSecond_ns};
  return std::nullopt;
}

class Reader {
 public:
  Reader(LineReader* lines, ReadReport* report) : lines_(*lines), report_(*report) {}

  Result<PreciseOrbits> Read() {
    std::string_view line;
    if (!lines_.Next(&line)) {
      if (!lines_.status()) return lines_.status().error();
      return Error{ErrorCode::kBadData, lines_.name() + ": the file is empty"};
    }
    const char version = CharacterAt(line, 1);
    const char content = CharacterAt(line, 2);
    if (CharacterAt(line, 0) != '#' || version < 'a' || version > 'd' ||
        (content != 'P' && content != 'V')) {
      return Error{ErrorCode::kBadData,
                   lines_.name() + ":1: not an SP3 file: it does not begin with #aP to #dV"};
    }
    while (lines_.Next(&line)) {
      if (Columns(line, 0, 3) == "EOF") break;
      if (const Status status = Take(line); !status) return status.error();
    }
    if (!lines_.status()) return lines_.status().error();
    if (orbits_.samples.empty()) {
      return Error{ErrorCode::kBadData, lines_.name() + ": the SP3 file holds no position"};
    }
    return std::move(orbits_);
  }

 private:
  Status Take(std::string_view line) {
    switch (CharacterAt(line, 0)) {
      case '*':
        TakeEpoch(line);
        break;
      case 'P':
        TakePosition(line);
        break;
      case '+':
        if (CharacterAt(line, 1) == '+') {
          TakeAccuracies(line);
        } else {
          TakeSatellites(line);
        }
        break;
      case '%':
        return TakeDescription(line);
      case '#':  // week and interval
      case '/':  // comment
      case 'V':  // velocity
      case 'E':  // correlations of the line before
        break;
      default:
        if (!TrimSpaces(line).empty()) Skip(0, "the line is of no kind that SP3 has");
        break;
    }
    return Status();
  }

  void TakeSatellites(std::string_view line) {
    for (std::size_t i = 0; i < kPerLine && listed_.size() < kMostSatellites; ++i) {
      listed_.push_back(SatelliteAt(line, 9 + 3 * i));
    }
  }

  // 2^n millimetres for each satellite, in the order in which they were listed; 0 is unknown.
  void TakeAccuracies(std::string_view line) {
    for (std::size_t i = 0; i < kPerLine && accuracies_ < listed_.size(); ++i, ++accuracies_) {
      const auto exponent = ParseInteger(Columns(line, 9 + 3 * i, 3));
      if (listed_[accuracies_] && exponent && *exponent > 0 && *exponent < 40) {
        sigmas_m_[*listed_[accuracies_]] =
            kMillimetre_m * std::exp2(static_cast<double>(*exponent));
      }
    }
  }

  Status TakeDescription(std::string_view line) {
    if (Columns(line, 0, 3) == "%c " && !described_scale_) {
      described_scale_ = true;
      const std::string_view name = TrimSpaces(Columns(line, 9, 3));
      const std::optional<EpochScale> scale = ScaleFromName(name);
      if (!scale) {
        return Error{ErrorCode::kUnsupported,
                     lines_.name() + ":" + std::to_string(lines_.line_number()) +
                         ":10: no time system called '" + std::string(name) + "'"};
      }
      scale_ = *scale;
    } else if (Columns(line, 0, 3) == "%f " && base_ == 0.0) {
      const std::optional<double> base = ParseDouble(Columns(line, 3, 10));
      if (base && *base > 1.0 && *base < 10.0) base_ = *base;
    }
    return Status();
  }

  void TakeEpoch(std::string_view line) {
    epoch_gps_ns_.reset();
    const std::optional<std::int64_t> time_ns = CalendarAt(line, 3);
    if (!time_ns) {
      Skip(4, "the epoch is no date; its positions are passed over");
      return;
    }
    epoch_gps_ns_ = GpsFromScale(*time_ns - scale_.ahead_of_gps_ns, scale_.scale);
  }

  void TakePosition(std::string_view line) {
    if (!epoch_gps_ns_) return;  // counted with its epoch
    const std::optional<SatelliteId> satellite = SatelliteAt(line, 1);
    if (!satellite) {
      ++report_.rows_unknown;  // low satellites among them
      return;
    }
    PreciseSample sample;
    sample.time_gps_ns = *epoch_gps_ns_;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t column = 4 + 14 * static_cast<std::size_t>(axis);
      const std::optional<double> value_km = ParseDouble(Columns(line, column, 14));
      if (!value_km) {
        Skip(static_cast<std::int32_t>(column) + 1, "the coordinate is not a number");
        return;
      }
      sample.position_in_ecef[axis] = kKilometre_m * *value_km;
    }
    const double radius_m = sample.position_in_ecef.norm();
    if (radius_m == 0.0) return;  // the satellite is listed but was not determined
    if (!(radius_m >= kLowest_m && radius_m <= kHighest_m)) {
      Skip(5, "no navigation satellite is so far from the earth's centre");
      return;
    }
    const std::string_view clock = TrimSpaces(Columns(line, 46, 14));
    const std::optional<double> clock_us = ParseDouble(clock);
    if (!clock_us && !clock.empty()) {
      Skip(47, "the clock is not a number");
      return;
    }
    if (clock_us && std::abs(*clock_us) < kAbsentClock_us) {
      sample.has_clock = true;
      sample.clock_bias_s = kMicrosecond_s * *clock_us;
    }
    sample.clock_event = CharacterAt(line, 74) == 'E';
    sample.maneuver = CharacterAt(line, 78) == 'M';
    sample.predicted = CharacterAt(line, 75) == 'P' || CharacterAt(line, 79) == 'P';
    sample.position_sigma_m = SigmaOf(line, *satellite);

    std::vector<PreciseSample>& samples = orbits_.samples[*satellite];
    if (!samples.empty() && sample.time_gps_ns <= samples.back().time_gps_ns) {
      Skip(1, "the epoch is not after the one before");
      return;
    }
    samples.push_back(sample);
    ++report_.rows_read;
  }

  // From the row's own exponents if it has all three, else from the header.
  double SigmaOf(std::string_view line, SatelliteId satellite) const {
    double squares_mm2 = 0.0;
    int axes = 0;
    for (std::size_t axis = 0; axis < 3 && base_ > 0.0; ++axis) {
      const auto exponent = ParseInteger(Columns(line, 61 + 3 * axis, 2));
      if (!exponent || *exponent < 0) break;
      squares_mm2 += std::pow(base_, 2.0 * static_cast<double>(*exponent));
      ++axes;
    }
    if (axes == 3) return kMillimetre_m * std::sqrt(squares_mm2 / 3.0);
    const auto listed = sigmas_m_.find(satellite);
    return listed == sigmas_m_.end() ? 0.0 : listed->second;
  }

  void Skip(std::int32_t column, std::string_view reason) {
    report_.Skip(lines_.line_number(), column, reason);
  }

  LineReader& lines_;
  ReadReport& report_;
  PreciseOrbits orbits_;
  EpochScale scale_;
  bool described_scale_ = false;
  double base_ = 0.0;  // of the exponents in position rows
  std::vector<std::optional<SatelliteId>> listed_;
  std::size_t accuracies_ = 0;
  std::map<SatelliteId, double> sigmas_m_;
  std::optional<std::int64_t> epoch_gps_ns_;
};

}  // namespace

Result<PreciseOrbits> ReadSp3(LineReader* lines, ReadReport* report) {
  report->file = lines->name();
  return Reader(lines, report).Read();
}

Result<PreciseOrbits> ReadSp3(const std::string& path, ReadReport* report) {
  report->file = path;
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return ReadSp3(&lines.value(), report);
}

}  // namespace lodemark
