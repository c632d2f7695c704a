#include "core/logs/sp3.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/geo/time.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

std::string HeaderText(const std::string& scale = "GPS") {
  return "#dP2021  4 28  0  0  0.00000000       2 d+D   IGb14 FIT  TST\n"
         "## 2155 259200.00000000   300.00000000 59332 0.0000000000000\n"
         "+    3   G01C06L12  0  0  0  0  0  0  0  0  0  0  0  0  0  0\n"
         "++         5  0  7  0  0  0  0  0  0  0  0  0  0  0  0  0  0\n"
         "%c M  cc " +
         scale +
         " ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n"
         "%c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n"
         "%f  1.2500000  1.025000000  0.00000000000  0.000000000000000\n"
         "%i    0    0    0    0      0      0      0      0         0\n"
         "/* P 1 2 3 a comment\n";
}

const std::string kEpoch = "*  2021  4 28 18  5  0.00000000\n";
const std::string kGps = "PG01  13287.682546 -15491.926575  16545.690647    703.963460";

struct Outcome {
  Result<PreciseOrbits> orbits;
  ReadReport report;
};

Outcome Read(const std::string& text) {
  ReadReport report;
  LineReader lines = LineReader::FromMemory("test.sp3", text);
  Result<PreciseOrbits> orbits = ReadSp3(&lines, &report);
  return {std::move(orbits), report};
}

std::int64_t At(int hour, int minute, double second, TimeScale scale = TimeScale::kGps) {
  return GpsFromScale(*NanosecondsFromCalendar({2021, 4, 28, hour, minute, second}), scale);
}

PreciseSample OnlySample(const std::string& text) {
  const Outcome outcome = Read(text);
  return outcome.orbits.value().samples.at({System::kGps, 1}).at(0);
}

TEST(Sp3, ReadsPositionInMetresAndClockInSeconds) {
  const PreciseSample sample = OnlySample(HeaderText() + kEpoch + kGps + "\nEOF\n");
  EXPECT_EQ(sample.time_gps_ns, At(18, 5, 0));
  EXPECT_DOUBLE_EQ(sample.position_in_ecef.x(), 13'287'682.546);
  EXPECT_DOUBLE_EQ(sample.position_in_ecef.y(), -15'491'926.575);
  EXPECT_DOUBLE_EQ(sample.position_in_ecef.z(), 16'545'690.647);
  EXPECT_TRUE(sample.has_clock);
  EXPECT_DOUBLE_EQ(sample.clock_bias_s, 703.963460e-6);
  EXPECT_DOUBLE_EQ(sample.position_sigma_m, 0.032);  // 2^5 mm in the header
  EXPECT_FALSE(sample.maneuver || sample.predicted || sample.clock_event);
}

TEST(Sp3, RowsOwnExponentsComeBeforeTheHeaders) {
  const PreciseSample sample = OnlySample(HeaderText() + kEpoch + kGps + " 10 10 10 100\n");
  EXPECT_NEAR(sample.position_sigma_m, 1e-3 * std::pow(1.25, 10), 1e-12);
}

TEST(Sp3, AbsentClocksAndPositionsAreAbsent) {
  const Outcome outcome = Read(HeaderText() + kEpoch +
                               "PG01  13287.682546 -15491.926575  16545.690647 999999.999999\n"
                               "PG02      0.000000      0.000000      0.000000      1.000000\n"
                               "PG03  13287.682546 -15491.926575  16545.690647\n");
  ASSERT_TRUE(outcome.orbits.ok());
  EXPECT_EQ(outcome.report.rows_skipped, 0);
  const auto& samples = outcome.orbits->samples;
  EXPECT_EQ(samples.size(), 2u);
  EXPECT_FALSE(samples.at({System::kGps, 1})[0].has_clock);
  EXPECT_FALSE(samples.at({System::kGps, 3})[0].has_clock);
}

TEST(Sp3, ReadsTheFlags) {
  const std::string row = kGps + "               ";  // columns 75, 76, 79 and 80
  const auto with = [&](std::size_t column, char flag) {
    std::string flagged = row;
    flagged.resize(80, ' ');
    flagged[column - 1] = flag;
    return OnlySample(HeaderText() + kEpoch + flagged + "\n");
  };
  EXPECT_TRUE(with(75, 'E').clock_event);
  EXPECT_TRUE(with(76, 'P').predicted);
  EXPECT_TRUE(with(79, 'M').maneuver);
  EXPECT_TRUE(with(80, 'P').predicted);
  EXPECT_FALSE(with(77, 'E').clock_event);
}

TEST(Sp3, EpochsAreInTheScaleOfTheHeader) {
  const auto time = [](const std::string& scale) {
    return OnlySample(HeaderText(scale) + kEpoch + kGps + "\n").time_gps_ns;
  };
  EXPECT_EQ(time("GPS"), At(18, 5, 0));
  EXPECT_EQ(time("ccc"), At(18, 5, 0));
  EXPECT_EQ(time("GAL"), At(18, 5, 0));
  EXPECT_EQ(time("BDT"), At(18, 5, 14));
  EXPECT_EQ(time("UTC"), At(18, 5, 18));
  EXPECT_EQ(time("GLO"), At(18, 5, 18));
  EXPECT_EQ(time("TAI"), At(18, 4, 41));
  const Outcome unknown = Read(HeaderText("XYZ") + kEpoch + kGps + "\n");
  ASSERT_FALSE(unknown.orbits.ok());
  EXPECT_THAT(unknown.orbits.error().message, HasSubstr("test.sp3:5:10: "));
}

TEST(Sp3, PassesOverVelocitiesCorrelationsAndOtherSatellites) {
  const Outcome outcome =
      Read(HeaderText() + kEpoch + kGps +
           "\n"
           "EP  55   55   55     222 1234567 -1234567 5999999      -30       21 -1230000\n"
           "VG01  20298.880364 -18462.044804   1381.387685     -4.534317\n"
           "EV  22   22   22     111 1234567  1234567 1234567  1234567  1234567  1234567\n"
           "PL12   6287.682546  -1491.926575   1545.690647    703.963460\n");
  ASSERT_TRUE(outcome.orbits.ok());
  EXPECT_EQ(outcome.orbits->samples.size(), 1u);
  EXPECT_EQ(outcome.report.rows_read, 1);
  EXPECT_EQ(outcome.report.rows_unknown, 1);
  EXPECT_EQ(outcome.report.rows_skipped, 0);
}

TEST(Sp3, VersionAHasGpsWithoutALetter) {
  std::string text = HeaderText("ccc");
  text[1] = 'a';
  const PreciseSample sample =
      OnlySample(text + kEpoch + "P  1  13287.682546 -15491.926575  16545.690647    703.963460\n");
  EXPECT_TRUE(sample.has_clock);
}

TEST(Sp3, SkipsBadRowsNamingThePlace) {
  const Outcome outcome = Read(HeaderText() + kEpoch + kGps + "\n" +  // good
                               "PG02  13287.682x46 -15491.926575  16545.690647    703.963460\n"
                               "PG03      1.000000      1.000000      1.000000    703.963460\n"
                               "PG04 913287.682546 -15491.926575  16545.690647    703.963460\n"
                               "PG05  13287.682546 -15491.926575  16545.690647    703.96.460\n"
                               "PG06  13287.682546           nan  16545.690647    703.963460\n"
                               "what is this\n"
                               "*  2021 14 28 18 10  0.00000000\n" +
                               kGps + "\n" + kEpoch + kGps + "\n");
  ASSERT_TRUE(outcome.orbits.ok());
  EXPECT_EQ(outcome.orbits->samples.size(), 1u);
  EXPECT_EQ(outcome.report.rows_read, 1);
  EXPECT_EQ(outcome.report.rows_skipped, 8);
  EXPECT_EQ(FormatProblem("f", outcome.report.problems.at(0)),
            "f:12:5: the coordinate is not a number");
  EXPECT_EQ(outcome.report.problems.at(3).column, 47);
  EXPECT_THAT(outcome.report.problems.at(7).message, HasSubstr("not after"));
}

TEST(Sp3, StopsAtTheEndMark) {
  const Outcome outcome = Read(HeaderText() + kEpoch + kGps + "\nEOF\nrubbish\n");
  EXPECT_EQ(outcome.report.rows_skipped, 0);
}

TEST(Sp3, RefusesOtherFilesWithAReason) {
  EXPECT_THAT(Read("# Raw,\n").orbits.error().message, HasSubstr("not an SP3 file"));
  EXPECT_THAT(Read("").orbits.error().message, HasSubstr("empty"));
  EXPECT_THAT(Read(HeaderText()).orbits.error().message, HasSubstr("no position"));
}

}  // namespace
}  // namespace lodemark
