// The header of a RINEX navigation file: version, and what it says about the ionosphere, the time
// scales and leap seconds.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "core/base/result.h"
#include "core/gnss/ephemeris.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

class RinexNavigationHeader {
 public:
  using Sink = std::function<void(const NavigationRecord&)>;

  static bool IsVersionLine(std::string_view line);

  // Reads from the given version line through END OF HEADER and gives every parameter to sink.
  // Malformed lines are counted in *report. Fails if this is no navigation file or the header has
  // no end.
  Status Read(std::string_view version_line, LineReader* lines, const Sink& sink,
              ReadReport* report);

  int major_version() const { return major_version_; }
  // RINEX 2, where a file holds one system and its records do not name it.
  System system() const { return system_; }

 private:
  // One of the four coefficients' lines of a Klobuchar model; the other comes in a line of its own.
  struct Halves {
    std::optional<std::array<double, 4>> alpha;
    std::optional<std::array<double, 4>> beta;
  };

  Status ReadVersion(std::string_view line, const std::string& file);
  void ReadLine(std::string_view line, std::int64_t line_number, const Sink& sink,
                ReadReport* report);
  bool ReadIonosphere(std::string_view line, const Sink& sink);
  bool AddHalf(System system, bool alpha, std::string_view line, std::size_t first,
               const Sink& sink);
  bool ReadTimeOffset(std::string_view line, const Sink& sink);
  bool ReadOffset2(std::string_view line, std::string_view label, const Sink& sink);
  bool ReadGlonassOffset2(std::string_view line, const Sink& sink);
  bool ReadLeapSeconds(std::string_view line, const Sink& sink);

  int major_version_ = 0;
  System system_ = System::kGps;
  std::array<Halves, kSystemCount> klobuchar_ = {};
};

}  // namespace lodemark
