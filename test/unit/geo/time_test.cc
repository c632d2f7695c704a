#include "core/geo/time.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr std::array<TimeScale, 7> kScales = {
    TimeScale::kGps,  TimeScale::kGalileo, TimeScale::kBeidou, TimeScale::kGlonass,
    TimeScale::kQzss, TimeScale::kNavic,   TimeScale::kUtc};

std::int64_t At(int year, int month, int day, int hour = 0, int minute = 0, double second = 0.0) {
  return NanosecondsFromCalendar({year, month, day, hour, minute, second}).value();
}

std::int64_t GpsWeek(std::int64_t week, double seconds = 0.0) {
  return week * kWeek_ns + std::llround(seconds * 1e9);
}

TEST(Calendar, AgreesWithTheStandardLibraryOnEveryDay) {
  using std::chrono::days;
  using std::chrono::sys_days;
  using std::chrono::year_month_day;
  const sys_days epoch = std::chrono::year(1980) / 1 / 6;
  const sys_days end = std::chrono::year(2100) / 1 / 1;
  for (sys_days day = epoch; day < end; day += days(1)) {
    const year_month_day date(day);
    const CalendarTime expected = {static_cast<int>(date.year()),
                                   static_cast<int>(static_cast<unsigned>(date.month())),
                                   static_cast<int>(static_cast<unsigned>(date.day())),
                                   0,
                                   0,
                                   0.0};
    const std::int64_t time_ns = (day - epoch).count() * kDay_ns;
    ASSERT_EQ(NanosecondsFromCalendar(expected), time_ns);
    const CalendarTime calendar = CalendarFromNanoseconds(time_ns + kDay_ns / 2);
    ASSERT_EQ(calendar.year, expected.year);
    ASSERT_EQ(calendar.month, expected.month);
    ASSERT_EQ(calendar.day, expected.day);
    ASSERT_EQ(calendar.hour, 12);
  }
}

// Rollovers and day-of-week by the GPS interface specification and by any GPS calendar.
TEST(Calendar, AgreesWithKnownGpsWeeks) {
  EXPECT_EQ(At(1980, 1, 6), 0);
  EXPECT_EQ(At(1999, 8, 22), GpsWeek(1024));
  EXPECT_EQ(At(2019, 4, 7), GpsWeek(2048));
  EXPECT_EQ(At(2038, 11, 21), GpsWeek(3072));
  EXPECT_EQ(At(2020, 2, 29, 12, 34, 56.0), GpsWeek(2094, 563'696.0));
}

TEST(Calendar, KeepsNanoseconds) {
  const std::int64_t time_ns = At(2023, 1, 8, 23, 59, 59.999'999'999);
  EXPECT_EQ(time_ns, At(2023, 1, 9) - 1);
  const CalendarTime calendar = CalendarFromNanoseconds(time_ns);
  EXPECT_EQ(calendar.day, 8);
  EXPECT_EQ(calendar.minute, 59);
  EXPECT_NEAR(calendar.second, 59.999'999'999, 1e-12);
}

TEST(Calendar, RoundTripsAtRandomTimes) {
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const auto time_ns = static_cast<std::int64_t>(random.Index(120ULL * 365 * 86'400'000'000'000));
    ASSERT_EQ(NanosecondsFromCalendar(CalendarFromNanoseconds(time_ns)), time_ns);
  }
}

TEST(Calendar, RefusesReadingsThatNoClockShows) {
  const std::array<CalendarTime, 13> impossible = {{{1979, 12, 31, 0, 0, 0.0},
                                                    {2100, 1, 1, 0, 0, 0.0},
                                                    {2023, 0, 1, 0, 0, 0.0},
                                                    {2023, 13, 1, 0, 0, 0.0},
                                                    {2023, 1, 0, 0, 0, 0.0},
                                                    {2023, 2, 29, 0, 0, 0.0},
                                                    {2024, 2, 30, 0, 0, 0.0},
                                                    {2023, 4, 31, 0, 0, 0.0},
                                                    {2023, 1, 1, 24, 0, 0.0},
                                                    {2023, 1, 1, 0, 60, 0.0},
                                                    {2023, 1, 1, 0, 0, 61.0},
                                                    {2023, 1, 1, 0, 0, -0.1},
                                                    {2023, 1, 1, 0, 0, std::nan("")}}};
  for (const CalendarTime& calendar : impossible) {
    EXPECT_FALSE(NanosecondsFromCalendar(calendar).has_value())
        << calendar.year << "-" << calendar.month << "-" << calendar.day << " " << calendar.hour
        << ":" << calendar.minute << ":" << calendar.second;
  }
  EXPECT_TRUE(NanosecondsFromCalendar({2024, 2, 29, 23, 59, 60.5}).has_value());
}

// First UTC day with the given TAI - UTC, from IERS Bulletin C; GPS time is TAI - 19 s.
struct LeapSecond {
  int year;
  int month;
  int tai_minus_utc_s;
};
constexpr std::array<LeapSecond, 18> kBulletinC = {{{1981, 7, 20},
                                                    {1982, 7, 21},
                                                    {1983, 7, 22},
                                                    {1985, 7, 23},
                                                    {1988, 1, 24},
                                                    {1990, 1, 25},
                                                    {1991, 1, 26},
                                                    {1992, 7, 27},
                                                    {1993, 7, 28},
                                                    {1994, 7, 29},
                                                    {1996, 1, 30},
                                                    {1997, 7, 31},
                                                    {1999, 1, 32},
                                                    {2006, 1, 33},
                                                    {2009, 1, 34},
                                                    {2012, 7, 35},
                                                    {2015, 7, 36},
                                                    {2017, 1, 37}}};

TEST(LeapSeconds, ChangeAtTheAnnouncedInstants) {
  for (const LeapSecond& leap : kBulletinC) {
    const std::int64_t utc_ns = At(leap.year, leap.month, 1);
    const int after_s = leap.tai_minus_utc_s - 19;
    EXPECT_EQ(LeapSecondsAtUtc(utc_ns), after_s);
    EXPECT_EQ(LeapSecondsAtUtc(utc_ns - 1), after_s - 1);
    EXPECT_EQ(LeapSecondsAtGps(utc_ns + after_s * kSecond_ns), after_s);
    EXPECT_EQ(LeapSecondsAtGps(utc_ns + after_s * kSecond_ns - 1), after_s - 1);
  }
  EXPECT_EQ(LeapSecondsAtGps(0), 0);
  EXPECT_EQ(LeapSecondsAtGps(At(2026, 1, 1)), 18);
}

TEST(LeapSeconds, RepeatTheirSecondInTheUtcCount) {
  // 2016-12-31 23:59:60 UTC is second 17 of 2017-01-01 in GPS time; a count with days of 86,400 s
  // shows it as the first second of the next day, once during the leap second and once after.
  const std::int64_t during_ns = At(2017, 1, 1, 0, 0, 17.25);
  const std::int64_t after_ns = At(2017, 1, 1, 0, 0, 18.25);
  EXPECT_EQ(ScaleFromGps(during_ns - kSecond_ns, TimeScale::kUtc), At(2016, 12, 31, 23, 59, 59.25));
  EXPECT_EQ(ScaleFromGps(during_ns, TimeScale::kUtc), At(2016, 12, 31, 23, 59, 60.25));
  EXPECT_EQ(ScaleFromGps(during_ns, TimeScale::kUtc), ScaleFromGps(after_ns, TimeScale::kUtc));
  EXPECT_EQ(GpsFromScale(At(2017, 1, 1, 0, 0, 0.25), TimeScale::kUtc), after_ns);
}

// BDS-SIS-ICD-B1I 3.3: BeiDou time began at 2006-01-01 00:00:00 UTC. Galileo OS SIS ICD 5.1.2:
// Galileo's weeks began 13 s before midnight UTC of 1999-08-21/22, with GPS week 1024.
// IS-GPS-200N 3.3.4: GPS time began with 1980-01-06 UTC. GLONASS ICD 3.3.3: UTC + 3 h.
TEST(TimeScales, BeginWhereTheirInterfaceDocumentsSay) {
  EXPECT_EQ(GpsFromScale(At(2006, 1, 1), TimeScale::kBeidou),
            GpsFromScale(At(2006, 1, 1), TimeScale::kUtc));
  EXPECT_EQ(GpsFromScale(At(2006, 1, 1), TimeScale::kBeidou), GpsWeek(1356, 14.0));
  EXPECT_EQ(ScaleFromGps(GpsWeek(1024), TimeScale::kGalileo), GpsWeek(1024));
  EXPECT_EQ(GpsFromScale(At(1999, 8, 21, 23, 59, 47.0), TimeScale::kUtc), GpsWeek(1024));
  EXPECT_EQ(GpsFromScale(0, TimeScale::kUtc), 0);
  EXPECT_EQ(ScaleFromGps(At(2023, 1, 8, 12, 0, 18.0), TimeScale::kGlonass),
            At(2023, 1, 8, 15, 0, 0.0));
}

TEST(TimeScales, RoundTripAwayFromLeapSeconds) {
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    const auto gps_ns = static_cast<std::int64_t>(random.Index(60ULL * 365 * 86'400'000'000'000));
    for (const TimeScale scale : kScales) {
      if (LeapSecondsAtGps(gps_ns + kSecond_ns) != LeapSecondsAtGps(gps_ns)) continue;
      ASSERT_EQ(GpsFromScale(ScaleFromGps(gps_ns, scale), scale), gps_ns);
    }
  }
}

TEST(TimeScales, NeverRunBackwardsInGpsTime) {
  for (const LeapSecond& leap : kBulletinC) {
    const std::int64_t utc_ns = At(leap.year, leap.month, 1);
    std::int64_t previous_ns = 0;
    for (std::int64_t t = utc_ns - 3 * kSecond_ns; t < utc_ns + 3 * kSecond_ns;
         t += kSecond_ns / 4) {
      const std::int64_t gps_ns = GpsFromScale(t, TimeScale::kUtc);
      EXPECT_GT(gps_ns, previous_ns);
      previous_ns = gps_ns;
    }
  }
}

TEST(NearestCongruent, CompletesATimeOfWeekAcrossTheRollover) {
  const std::int64_t rollover_ns = GpsWeek(2300);
  EXPECT_EQ(NearestCongruent(kWeek_ns - kSecond_ns, kWeek_ns, rollover_ns + kSecond_ns),
            rollover_ns - kSecond_ns);
  EXPECT_EQ(NearestCongruent(kSecond_ns, kWeek_ns, rollover_ns - kSecond_ns),
            rollover_ns + kSecond_ns);
}

TEST(NearestCongruent, IsCongruentAndWithinHalfAPeriod) {
  Random random(3);
  for (int i = 0; i < 10'000; ++i) {
    const auto near_ns = static_cast<std::int64_t>(random.Index(4'000'000'000'000'000'000ULL));
    const auto of_day_ns = static_cast<std::int64_t>(random.Index(86'400'000'000'000ULL));
    const std::int64_t full_ns = NearestCongruent(of_day_ns, kDay_ns, near_ns);
    ASSERT_EQ(FloorModulo(full_ns, kDay_ns), of_day_ns);
    ASSERT_LE(std::abs(full_ns - near_ns), kDay_ns / 2);
  }
}

TEST(FloorModulo, IsNeverNegative) {
  EXPECT_EQ(FloorModulo(7, 5), 2);
  EXPECT_EQ(FloorModulo(-1, 5), 4);
  EXPECT_EQ(FloorModulo(-5, 5), 0);
  EXPECT_EQ(FloorModulo(0, 5), 0);
}

}  // namespace
}  // namespace lodemark
