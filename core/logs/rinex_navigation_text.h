// The lines of one navigation record and the numbers in their fixed columns.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/gnss/signal.h"

namespace lodemark {

// Line 0 holds the epoch and fields 0 to 2, the lines after it fields 0 to 3, each 19 wide.
struct NavigationPlace {
  std::int8_t line = -1;
  std::int8_t field = 0;

  bool exists() const { return line >= 0; }
};

class NavigationText {
 public:
  static constexpr int kMostLines = 12;

  // RINEX 2 indents its lines by 3, RINEX 3 and 4 by 4.
  void Start(int indent);
  // Lines past kMostLines are only counted.
  void Append(std::int64_t line_number, std::string_view line);

  int lines() const { return lines_; }
  std::string_view line(int index) const { return text_[static_cast<std::size_t>(index)]; }
  std::int64_t line_number(int index) const;
  std::int32_t Column(NavigationPlace place) const;

  // Empty for a blank field, a line that is not there, and text that is no number, which is noted.
  std::optional<double> Number(NavigationPlace place);
  double NumberOrZero(NavigationPlace place) { return Number(place).value_or(0.0); }
  // The same, rounded. A number outside 32 bits is noted as malformed.
  std::int32_t IntegerOrZero(NavigationPlace place);

  // The calendar reading of line 0 in nanoseconds of its own scale.
  std::optional<std::int64_t> Epoch() const;
  std::optional<SatelliteId> Satellite() const;  // RINEX 3 and 4: the name that opens line 0

  // The first field that was asked for and is no number.
  const std::optional<NavigationPlace>& malformed() const { return malformed_; }
  std::string_view Raw(NavigationPlace place) const;

 private:
  int indent_ = 4;
  int lines_ = 0;
  std::array<std::string, kMostLines> text_;
  std::array<std::int64_t, kMostLines> numbers_ = {};
  std::optional<NavigationPlace> malformed_;
};

// Part of a line, empty where the line is too short.
std::string_view Columns(std::string_view line, std::size_t first, std::size_t width);

}  // namespace lodemark
