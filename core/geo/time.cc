#include "core/geo/time.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr std::int64_t kGlonassAheadOfUtc_ns = 3 * 3600 * kSecond_ns;
constexpr std::int64_t kBeidouBehindGps_ns = 14 * kSecond_ns;

// Days since 1970-01-01 of a proleptic Gregorian date (Hinnant, "chrono-compatible low-level date
// algorithms").
constexpr std::int64_t DaysFromCivil(int year, int month, int day) {
  const int y = month <= 2 ? year - 1 : year;
  const int era = (y >= 0 ? y : y - 399) / 400;
  const int year_of_era = y - era * 400;
  const int day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const int day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return std::int64_t{era} * 146'097 + day_of_era - 719'468;
}

constexpr std::int64_t kGpsEpochDays = DaysFromCivil(1980, 1, 6);

// First instants in UTC with one more leap second than before, counted since 1980-01-06.
constexpr std::int64_t LeapDate_ns(int year, int month) {
  return (DaysFromCivil(year, month, 1) - kGpsEpochDays) * kDay_ns;
}
constexpr std::array<std::int64_t, 18> kLeapDates_ns = {
    LeapDate_ns(1981, 7), LeapDate_ns(1982, 7), LeapDate_ns(1983, 7), LeapDate_ns(1985, 7),
    LeapDate_ns(1988, 1), LeapDate_ns(1990, 1), LeapDate_ns(1991, 1), LeapDate_ns(1992, 7),
    LeapDate_ns(1993, 7), LeapDate_ns(1994, 7), LeapDate_ns(1996, 1), LeapDate_ns(1997, 7),
    LeapDate_ns(1999, 1), LeapDate_ns(2006, 1), LeapDate_ns(2009, 1), LeapDate_ns(2012, 7),
    LeapDate_ns(2015, 7), LeapDate_ns(2017, 1)};

bool IsLeapYear(int year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

int DaysInMonth(int year, int month) {
  constexpr std::array<int, 12> kDays = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && IsLeapYear(year) ? 29 : kDays[static_cast<std::size_t>(month - 1)];
}

}  // namespace

std::optional<std::int64_t> NanosecondsFromCalendar(const CalendarTime& c) {
  if (c.year < 1980 || c.year > 2099 || c.month < 1 || c.month > 12) return std::nullopt;
  if (c.day < 1 || c.day > DaysInMonth(c.year, c.month)) return std::nullopt;
  if (c.hour < 0 || c.hour > 23 || c.minute < 0 || c.minute > 59) return std::nullopt;
  if (!(c.second >= 0.0 && c.second < 61.0)) return std::nullopt;
  const std::int64_t days = DaysFromCivil(c.year, c.month, c.day) - kGpsEpochDays;
  const std::int64_t minutes = (days * 24 + c.hour) * 60 + c.minute;
  return minutes * 60 * kSecond_ns + std::llround(c.second * 1e9);
}

CalendarTime CalendarFromNanoseconds(std::int64_t time_ns) {
  const std::int64_t of_day_ns = FloorModulo(time_ns, kDay_ns);
  const std::int64_t days = (time_ns - of_day_ns) / kDay_ns + kGpsEpochDays + 719'468;
  const std::int64_t era = (days >= 0 ? days : days - 146'096) / 146'097;
  const std::int64_t day_of_era = days - era * 146'097;
  const std::int64_t year_of_era =
      (day_of_era - day_of_era / 1460 + day_of_era / 36'524 - day_of_era / 146'096) / 365;
  const std::int64_t day_of_year =
      day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t shifted_month = (5 * day_of_year + 2) / 153;
  CalendarTime calendar;
  calendar.day = static_cast<int>(day_of_year - (153 * shifted_month + 2) / 5 + 1);
  calendar.month = static_cast<int>(shifted_month < 10 ? shifted_month + 3 : shifted_month - 9);
  calendar.year = static_cast<int>(year_of_era + era * 400 + (calendar.month <= 2 ? 1 : 0));
  calendar.hour = static_cast<int>(of_day_ns / (3600 * kSecond_ns));
  calendar.minute = static_cast<int>(of_day_ns / (60 * kSecond_ns) % 60);
  calendar.second = 1e-9 * static_cast<double>(of_day_ns % (60 * kSecond_ns));
  return calendar;
}

int LeapSecondsAtUtc(std::int64_t time_utc_ns) {
  const auto after = std::upper_bound(kLeapDates_ns.begin(), kLeapDates_ns.end(), time_utc_ns);
  return static_cast<int>(after - kLeapDates_ns.begin());
}

int LeapSecondsAtGps(std::int64_t time_gps_ns) {
  int leap_s = 0;
  for (const std::int64_t date_ns : kLeapDates_ns) {
    if (time_gps_ns < date_ns + (leap_s + 1) * kSecond_ns) break;
    ++leap_s;
  }
  return leap_s;
}

std::int64_t GpsFromScale(std::int64_t time_ns, TimeScale scale) {
  switch (scale) {
    case TimeScale::kBeidou:
      return time_ns + kBeidouBehindGps_ns;
    case TimeScale::kGlonass:
      return GpsFromScale(time_ns - kGlonassAheadOfUtc_ns, TimeScale::kUtc);
    case TimeScale::kUtc:
      return time_ns + LeapSecondsAtUtc(time_ns) * kSecond_ns;
    case TimeScale::kGps:
    case TimeScale::kGalileo:
    case TimeScale::kQzss:
    case TimeScale::kNavic:
      break;
  }
  return time_ns;
}

std::int64_t ScaleFromGps(std::int64_t time_gps_ns, TimeScale scale) {
  switch (scale) {
    case TimeScale::kBeidou:
      return time_gps_ns - kBeidouBehindGps_ns;
    case TimeScale::kGlonass:
      return ScaleFromGps(time_gps_ns, TimeScale::kUtc) + kGlonassAheadOfUtc_ns;
    case TimeScale::kUtc:
      return time_gps_ns - LeapSecondsAtGps(time_gps_ns) * kSecond_ns;
    case TimeScale::kGps:
    case TimeScale::kGalileo:
    case TimeScale::kQzss:
    case TimeScale::kNavic:
      break;
  }
  return time_gps_ns;
}

std::int64_t FloorModulo(std::int64_t value, std::int64_t period) {
  const std::int64_t remainder = value % period;
  return remainder < 0 ? remainder + period : remainder;
}

std::int64_t NearestCongruent(std::int64_t of_period_ns, std::int64_t period_ns,
                              std::int64_t near_ns) {
  const std::int64_t ahead_ns = FloorModulo(of_period_ns - near_ns, period_ns);
  return near_ns + (ahead_ns > period_ns / 2 ? ahead_ns - period_ns : ahead_ns);
}

}  // namespace lodemark
