#include "core/logs/rinex_epoch_tag.h"

#include <array>

#include "core/base/units.h"
#include "core/logs/parse_number.h"
#include "core/logs/rinex_fields.h"

namespace lodemark {
namespace {

constexpr int kMostRecords = 999;  // the field has three digits

// Columns of one version's epoch line.
struct Layout {
  std::size_t year;
  std::size_t year_width;
  std::size_t fields;  // month, day, hour, minute: three columns each
  std::size_t second;  // 11 columns
  std::size_t flag;
  std::size_t count;
};
constexpr Layout kVersion2 = {1, 2, 3, 15, 28, 29};
constexpr Layout kVersion3 = {2, 4, 6, 18, 31, 32};
constexpr std::size_t kSecondWidth = 11;
constexpr std::size_t kVersion2Point = 18;  // of the seconds
constexpr std::size_t kObservationPoint = 10;

// Nanoseconds of F11.7 seconds below 61, exact.
std::optional<std::int64_t> ParseSeconds(std::string_view field) {
  field = TrimSpaces(field);
  if (field == ".") return std::nullopt;
  const std::size_t point = field.find('.');
  const std::optional<int> whole_s = RinexCount(field.substr(0, point));
  std::int64_t seconds_ns = 0;
  if (whole_s && *whole_s < 61) {
    seconds_ns = *whole_s * kSecond_ns;
  } else if (whole_s || point != 0) {  // ".5" has no whole part
    return std::nullopt;
  }
  if (point == std::string_view::npos) return seconds_ns;
  std::int64_t digit_ns = kSecond_ns / 10;
  for (const char c : field.substr(point + 1)) {
    if (c < '0' || c > '9') return std::nullopt;
    seconds_ns += (c - '0') * digit_ns;
    digit_ns /= 10;
  }
  return seconds_ns;
}

std::optional<std::int64_t> ParseTime(std::string_view line, const Layout& layout,
                                      TimeScale scale) {
  const std::optional<int> year = RinexCount(RinexColumns(line, layout.year, layout.year_width));
  std::array<int, 4> fields = {};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::optional<int> field = RinexCount(RinexColumns(line, layout.fields + 3 * i, 3));
    if (!field) return std::nullopt;
    fields[i] = *field;
  }
  const std::optional<std::int64_t> seconds_ns =
      ParseSeconds(RinexColumns(line, layout.second, kSecondWidth));
  if (!year || !seconds_ns) return std::nullopt;

  CalendarTime minute;
  minute.year = *year;
  if (layout.year_width == 2) minute.year += *year >= 80 ? 1900 : 2000;  // RINEX 2.11 6.5
  minute.month = fields[0];
  minute.day = fields[1];
  minute.hour = fields[2];
  minute.minute = fields[3];
  const std::optional<std::int64_t> minute_ns = NanosecondsFromCalendar(minute);
  if (!minute_ns) return std::nullopt;
  // A leap second, 23:59:60, belongs to its own minute: convert that and add.
  const std::int64_t time_gps_ns = GpsFromScale(*minute_ns, scale) + *seconds_ns;
  // The first days of 1980 are before GPS time.
  return time_gps_ns >= 0 ? std::optional(time_gps_ns) : std::nullopt;
}

std::optional<RinexEpochTag> ParseTag(std::string_view line, const Layout& layout,
                                      TimeScale scale) {
  RinexEpochTag tag;
  const std::string_view flag = RinexText(line, layout.flag, 1);
  if (!flag.empty()) {
    const std::optional<int> number = RinexCount(flag);
    if (!number || *number > kRinexCycleSlips) return std::nullopt;
    tag.flag = *number;
  }
  const std::optional<int> count = RinexCount(RinexColumns(line, layout.count, 3));
  const bool event = tag.flag >= kRinexFirstEvent && tag.flag <= kRinexLastEvent;
  if (!count && !event) return std::nullopt;
  tag.count = count.value_or(0);
  if (tag.count > kMostRecords) return std::nullopt;
  tag.time_gps_ns = ParseTime(line, layout, scale);
  if (tag.time_gps_ns) return tag;
  const std::string_view date = RinexText(line, layout.year, layout.flag - layout.year);
  return event && date.empty() ? std::optional(tag) : std::nullopt;
}

}  // namespace

std::optional<RinexEpochTag> ParseRinex2EpochTag(std::string_view line, TimeScale scale) {
  if (line.empty() || line[0] != ' ') return std::nullopt;
  return ParseTag(line, kVersion2, scale);
}

std::optional<RinexEpochTag> ParseRinex3EpochTag(std::string_view line, TimeScale scale) {
  if (line.empty() || line[0] != '>') return std::nullopt;
  return ParseTag(line, kVersion3, scale);
}

bool LooksLikeRinex2Epoch(std::string_view line) {
  return line.size() > kVersion2Point && line[kVersion2Point] == '.' &&
         line[kObservationPoint] != '.' && ParseRinex2EpochTag(line, TimeScale::kGps).has_value();
}

}  // namespace lodemark
