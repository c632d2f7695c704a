#include "core/logs/rinex_navigation_text.h"

#include <algorithm>
#include <cmath>

#include "core/geo/time.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

constexpr int kFieldWidth = 19;

std::optional<int> SmallInteger(std::string_view text) {
  const std::optional<std::int64_t> value = ParseInteger(text);
  if (!value || *value < 0 || *value > 9999) return std::nullopt;
  return static_cast<int>(*value);
}

}  // namespace

std::string_view Columns(std::string_view line, std::size_t first, std::size_t width) {
  return first < line.size() ? line.substr(first, width) : std::string_view();
}

void NavigationText::Start(int indent) {
  indent_ = indent;
  lines_ = 0;
  malformed_.reset();
}

void NavigationText::Append(std::int64_t line_number, std::string_view line) {
  if (lines_ < kMostLines) {
    text_[static_cast<std::size_t>(lines_)].assign(line.substr(0, 128));
    numbers_[static_cast<std::size_t>(lines_)] = line_number;
    ++lines_;
  }
}

std::int64_t NavigationText::line_number(int index) const {
  return lines_ == 0 ? 0 : numbers_[static_cast<std::size_t>(std::clamp(index, 0, lines_ - 1))];
}

std::int32_t NavigationText::Column(NavigationPlace place) const {
  const int skipped = place.line == 0 ? 1 : 0;  // the epoch takes the first field's place
  return indent_ + kFieldWidth * (place.field + skipped) + 1;
}

std::string_view NavigationText::Raw(NavigationPlace place) const {
  if (!place.exists() || place.line >= lines_) return {};
  return Columns(line(place.line), static_cast<std::size_t>(Column(place) - 1), kFieldWidth);
}

std::optional<double> NavigationText::Number(NavigationPlace place) {
  const std::string_view text = TrimSpaces(Raw(place));
  if (text.empty()) return std::nullopt;
  const std::optional<double> value = ParseDouble(text);
  if (!value && !malformed_) malformed_ = place;
  return value;
}

std::int32_t NavigationText::IntegerOrZero(NavigationPlace place) {
  const double value = NumberOrZero(place);
  if (std::abs(value) < 2e9) return static_cast<std::int32_t>(std::lround(value));
  if (!malformed_) malformed_ = place;
  return 0;
}

std::optional<std::int64_t> NavigationText::Epoch() const {
  if (lines_ == 0) return std::nullopt;
  const std::string_view text = line(0);
  const bool two_digit_year = indent_ == 3;
  const std::size_t first = two_digit_year ? 2 : 3;  // each part has a blank before it
  const std::size_t year_width = two_digit_year ? 3 : 5;
  std::array<std::optional<int>, 5> part;
  part[0] = SmallInteger(Columns(text, first, year_width));
  for (std::size_t i = 1; i < part.size(); ++i) {
    part[i] = SmallInteger(Columns(text, first + year_width + 3 * (i - 1), 3));
  }
  const std::optional<double> second =
      ParseDouble(Columns(text, first + year_width + 12, two_digit_year ? 5 : 3));
  for (const std::optional<int>& value : part) {
    if (!value) return std::nullopt;
  }
  if (!second) return std::nullopt;
  CalendarTime calendar;
  calendar.year = *part[0];
  if (two_digit_year && calendar.year < 100) calendar.year += calendar.year < 80 ? 2000 : 1900;
  calendar.month = *part[1];
  calendar.day = *part[2];
  calendar.hour = *part[3];
  calendar.minute = *part[4];
  calendar.second = *second;
  return NanosecondsFromCalendar(calendar);
}

std::optional<SatelliteId> NavigationText::Satellite() const {
  return lines_ == 0 ? std::nullopt : SatelliteFromName(Columns(line(0), 0, 3));
}

}  // namespace lodemark
