// Header records of RINEX observation files, at the head or within events.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/gnss/signal.h"
#include "core/logs/read_report.h"
#include "core/logs/rinex_observation.h"
#include "core/logs/rinex_observation_types.h"

namespace lodemark {

// Spirent's simulators name QZSS by Q.
std::optional<System> RinexSystemFromLetter(char letter);

class RinexObservationHeaderParser {
 public:
  // More types of one system than any format version defines.
  static constexpr std::size_t kMostTypes = 255;

  // The record RINEX VERSION / TYPE, always the first.
  Status ParseVersion(std::string_view line, const std::string& file);

  // Any other record; unknown ones and comments are ignored. Malformed ones are counted as skipped.
  void ParseRecord(std::string_view line, std::int64_t line_number, ReadReport* report);

  // After the last record of the header or of an event: settles what depends on several records.
  void Finish();

  const RinexObservationHeader& header() const { return header_; }
  const RinexRecordLayout& layout(System system) const;
  // Columns of a version 2 record, the same for every system.
  std::size_t rinex2_column_count() const { return rinex2_types_.size(); }
  std::int8_t glonass_channel(int slot) const;
  // Signal strengths are dB-Hz, as far as the file says.
  bool strength_in_dbhz() const { return strength_in_dbhz_; }

 private:
  struct ScaleFactor {
    std::string type;  // empty: all types
    double divisor = 1.0;
  };
  struct TypeList {
    std::vector<std::string> types;
    std::size_t declared = 0;
  };

  bool ParseRinex2Types(std::string_view line);
  bool ParseTypes(std::string_view line);
  bool ParseScaleFactor(std::string_view line);
  bool ParseGlonassSlots(std::string_view line);
  bool ParsePosition(std::string_view line);
  bool ParseAntennaDelta(std::string_view line);
  bool ParseLeapSeconds(std::string_view line);
  bool ParseTimeScale(std::string_view line);
  bool ParseText(std::string_view label, std::string_view line);
  void SettleTypes();
  double ScaleDivisor(System system, std::string_view type) const;

  RinexObservationHeader header_;
  std::vector<std::string> rinex2_types_;
  std::size_t rinex2_declared_ = 0;
  std::array<TypeList, kSystemCount> types_;
  std::optional<System> types_system_;  // of the list being continued
  std::array<std::vector<ScaleFactor>, kSystemCount> scale_factors_;
  std::optional<System> scale_system_;
  double scale_divisor_ = 1.0;
  bool strength_in_dbhz_ = true;
  bool types_changed_ = true;  // since the layouts were made
  std::array<RinexRecordLayout, kSystemCount> layouts_;
};

}  // namespace lodemark
