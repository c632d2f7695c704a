// Time scales of the navigation systems, all held as int64 nanoseconds.
//
// The reference is GPS time: nanoseconds since 1980-01-06 00:00:00 GPS, without leap seconds, in
// variables named time_gps_ns. The other scales count nanoseconds of their own calendar from the
// same date.
#pragma once

#include <cstdint>
#include <optional>

namespace lodemark {

enum class TimeScale : std::uint8_t { kGps, kGalileo, kBeidou, kGlonass, kQzss, kNavic, kUtc };

// Date and time of day as a scale's own clock shows them.
struct CalendarTime {
  int year = 1980;
  int month = 1;  // 1..12
  int day = 6;    // 1..31
  int hour = 0;
  int minute = 0;
  double second = 0.0;  // below 61: UTC and GLONASS may show a leap second
};

// Nanoseconds from 1980-01-06 to the given calendar reading, with days of 86,400 s, rounded to
// 1 ns. Empty if a field is out of its range or the year is outside 1980..2099.
std::optional<std::int64_t> NanosecondsFromCalendar(const CalendarTime& calendar);

// The inverse, for non-negative times.
CalendarTime CalendarFromNanoseconds(std::int64_t time_ns);

// GPS minus UTC in whole seconds, from the table of leap seconds that IERS Bulletin C announced
// (18 s since 2017). A time inside a leap second counts with the seconds before it.
int LeapSecondsAtGps(std::int64_t time_gps_ns);
int LeapSecondsAtUtc(std::int64_t time_utc_ns);

// GPS time of a reading in another scale, and back. GPS, Galileo, QZSS and NavIC run together;
// BeiDou is 14 s behind; GLONASS is UTC + 3 h. Differences below a microsecond between the systems
// are clock parameters, not part of the scales.
std::int64_t GpsFromScale(std::int64_t time_ns, TimeScale scale);
std::int64_t ScaleFromGps(std::int64_t time_gps_ns, TimeScale scale);

// The time nearest to near_ns that is congruent to of_period_ns modulo period_ns: turns a time of
// week or day into a full time. period_ns is positive.
std::int64_t NearestCongruent(std::int64_t of_period_ns, std::int64_t period_ns,
                              std::int64_t near_ns);

// Non-negative remainder.
std::int64_t FloorModulo(std::int64_t value, std::int64_t period);

}  // namespace lodemark
