#include "core/logs/rinex_observation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/units.h"

namespace lodemark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

// 2020-01-01 00:00:00 GPS: 2086 weeks and 3 days after 1980-01-06.
constexpr std::int64_t kNewYear2020_ns = 2086 * kWeek_ns + 3 * kDay_ns;

// A header record with its label in place.
std::string Record(std::string content, std::string_view label) {
  content.resize(60, ' ');
  return content.append(label).append("\n");
}

std::string Version(std::string_view version, std::string_view system) {
  std::string line = "     " + std::string(version);
  line.resize(20, ' ');
  line += "OBSERVATION DATA";
  line.resize(40, ' ');
  return Record(line.append(system), "RINEX VERSION / TYPE");
}

std::string FirstObservation(std::string_view scale) {
  return Record("  2020     1     1     0     0    0.0000000     " + std::string(scale),
                "TIME OF FIRST OBS");
}

const std::string kEnd = Record("", "END OF HEADER");

// A satellite's line of version 3. Each field is a number and, after a stroke, its loss-of-lock
// indicator and signal strength: "-16670.847/36".
std::string Row(const std::string& satellite, std::initializer_list<std::string> fields) {
  std::string row = satellite;
  for (const std::string& field : fields) {
    const std::size_t stroke = std::min(field.find('/'), field.size());
    std::string indicators = field.substr(std::min(stroke + 1, field.size()));
    indicators.resize(2, ' ');
    row += std::string(14 - stroke, ' ') + field.substr(0, stroke) + indicators;
  }
  return row + "\n";
}

// A version 3 file with C1C L1C D1C S1C for GPS.
std::string GpsFile(const std::string& body) {
  return Version("3.04", "M") + Record("G    4 C1C L1C D1C S1C", "SYS / # / OBS TYPES") + kEnd +
         body;
}

RinexObservationReader Open(const std::string& text) {
  static std::list<std::string> texts;  // a reader does not own its text
  texts.push_back(text);
  auto reader = RinexObservationReader::FromLines(LineReader::FromMemory("test.obs", texts.back()));
  EXPECT_TRUE(reader.ok()) << reader.error().message;
  return std::move(*reader);
}

// What is wrong with a file that cannot be opened.
Error OpenError(const std::string& text) {
  const auto reader = RinexObservationReader::FromLines(LineReader::FromMemory("test.obs", text));
  EXPECT_FALSE(reader.ok());
  return reader.ok() ? Error{} : reader.error();
}

std::vector<ObservationEpoch> AllEpochs(RinexObservationReader* reader) {
  std::vector<ObservationEpoch> epochs;
  ObservationEpoch epoch;
  while (reader->Next(&epoch)) epochs.push_back(epoch);
  return epochs;
}

std::string SignalName(const SignalObservation& signal) {
  return SatelliteName(signal.satellite) + ":" + signal.signal.band + signal.signal.attribute;
}

std::vector<std::string> SignalNames(const ObservationEpoch& epoch) {
  std::vector<std::string> names;
  for (const SignalObservation& signal : epoch.signals) names.push_back(SignalName(signal));
  return names;
}

constexpr char kTag[] = "> 2020 01 01 00 00  0.0000000  0  1\n";

TEST(RinexObservation, ReadsEveryQuantityOfASignal) {
  auto reader = Open(
      GpsFile(kTag + Row("G07", {"23738869.070/ 5", "-16670.847/36", "3433.068/ 5", "33.400"})));
  ObservationEpoch epoch;
  ASSERT_TRUE(reader.Next(&epoch));
  ASSERT_EQ(epoch.signals.size(), 1u);
  const SignalObservation& signal = epoch.signals[0];
  EXPECT_EQ(SignalName(signal), "G07:1C");
  EXPECT_EQ(signal.present, kHasPseudorange | kHasCarrierPhase | kHasDoppler | kHasCn0);
  EXPECT_EQ(signal.pseudorange_m, 23738869.070);
  EXPECT_EQ(signal.carrier_phase_cycles, -16670.847);
  EXPECT_EQ(signal.doppler_hz, 3433.068);
  EXPECT_EQ(signal.cn0_dbhz, 33.4);
  EXPECT_EQ(signal.flags, kLossOfLock | kHalfCycleAmbiguous);
  EXPECT_EQ(signal.frequency_hz, 1575.42e6);
  EXPECT_FALSE(reader.Next(&epoch));
  EXPECT_TRUE(reader.status().ok());
  EXPECT_EQ(reader.report().rows_read, 1);
  EXPECT_EQ(reader.report().rows_skipped, 0);
}

TEST(RinexObservation, KeepsTheTagToTheNanosecond) {
  auto reader =
      Open(GpsFile("> 2020 01 01 00 00  0.4299102  0  0\n"
                   "> 2020 01 01 23 59 59.9999999  0  0\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 2u);
  EXPECT_EQ(epochs[0].time_gps_ns, kNewYear2020_ns + 429'910'200);
  EXPECT_EQ(epochs[1].time_gps_ns, kNewYear2020_ns + kDay_ns - 100);
}

TEST(RinexObservation, ConvertsTheTagFromTheFilesTimeScale) {
  const auto first_time = [](std::string_view system, std::string_view scale) {
    auto reader = Open(Version("3.04", system) + FirstObservation(scale) +
                       Record("G    1 C1C", "SYS / # / OBS TYPES") + kEnd +
                       "> 2020 01 01 00 00  0.0000000  0  0\n");
    ObservationEpoch epoch;
    EXPECT_TRUE(reader.Next(&epoch));
    return (epoch.time_gps_ns - kNewYear2020_ns) / kSecond_ns;
  };
  EXPECT_EQ(first_time("M", "GPS"), 0);
  EXPECT_EQ(first_time("M", "GAL"), 0);
  EXPECT_EQ(first_time("M", "BDT"), 14);
  EXPECT_EQ(first_time("M", "GLO"), 18);  // UTC in RINEX, not UTC + 3 h
  EXPECT_EQ(first_time("R", "   "), 18);
  EXPECT_EQ(first_time("C", "   "), 14);
  EXPECT_EQ(first_time("R", "GPS"), 0);
}

TEST(RinexObservation, CountsALeapSecondInUtcFiles) {
  auto reader = Open(Version("2.11", "R") + Record("     1    C1", "# / TYPES OF OBSERV") + kEnd +
                     " 16 12 31 23 59 59.0000000  0  0\n"
                     " 16 12 31 23 59 60.0000000  0  0\n"
                     " 17  1  1  0  0  0.0000000  0  0\n");
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 3u);
  EXPECT_EQ(epochs[1].time_gps_ns - epochs[0].time_gps_ns, kSecond_ns);
  EXPECT_EQ(epochs[2].time_gps_ns - epochs[1].time_gps_ns, kSecond_ns);
}

TEST(RinexObservation, TakesBlankAndZeroAsMissing) {
  auto reader = Open(GpsFile("> 2020 01 01 00 00  0.0000000  0  3\n" +
                             Row("G01", {"0.000", "-0.000/3", "-100.000", "40.000"}) +
                             Row("G02", {"", "100000000.000"}) + "G03\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 1u);
  ASSERT_THAT(SignalNames(epochs[0]), ElementsAre("G01:1C", "G02:1C"));
  EXPECT_EQ(epochs[0].signals[0].present, kHasDoppler | kHasCn0);
  EXPECT_EQ(epochs[0].signals[1].present, kHasCarrierPhase | 0u);
  EXPECT_EQ(reader.report().values_dropped, 0);
}

TEST(RinexObservation, DropsAndCountsValuesNoReceiverMeasures) {
  auto reader = Open(GpsFile(
      "> 2020 01 01 00 00  0.0000000  0  6\n" + Row("G01", {"999999.999", "1000.000", "1.000"}) +
      Row("G02", {"nan", "inf", "1.000"}) + Row("G03", {"2000000000.00"}) +
      Row("G04", {"20000000.000", "", "9999999.000", "400.000"}) +
      Row("G05", {"20000000.000", "12x45678.9"}) + "G06  20000000.000    10000"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 1u);
  for (const SignalObservation& signal : epochs[0].signals) {
    EXPECT_TRUE(!signal.Has(kHasPseudorange) || signal.pseudorange_m == 2e7);
    EXPECT_FALSE(signal.Has(kHasCn0));
  }
  EXPECT_EQ(reader.report().rows_read, 6);
  EXPECT_EQ(reader.report().values_dropped, 8);
}

TEST(RinexObservation, SkipsSatellitesThatDoNotExistOrComeTwice) {
  auto reader =
      Open(GpsFile("> 2020 01 01 00 00  0.0000000  0  6\n"
                   "G33  20000000.000\n"
                   "G00  20000000.000\n"
                   "X01  20000000.000\n"
                   "E01  20000000.000\n"
                   "G 5  20000000.000\n"
                   "G05  21000000.000\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 1u);
  ASSERT_THAT(SignalNames(epochs[0]), ElementsAre("G05:1C"));
  EXPECT_EQ(epochs[0].signals[0].pseudorange_m, 2e7);
  EXPECT_EQ(reader.report().rows_skipped, 5);
}

TEST(RinexObservation, UsesSignalStrengthDigitsOnlyWithoutStrengthColumn) {
  auto with = Open(GpsFile(std::string(kTag) + "G01  20000000.000 7\n"));
  auto without = Open(Version("3.04", "M") + Record("G    2 C1C L1C", "SYS / # / OBS TYPES") +
                      kEnd + kTag + "G01  20000000.000 7\n");
  ObservationEpoch epoch;
  ASSERT_TRUE(with.Next(&epoch));
  EXPECT_FALSE(epoch.signals.at(0).Has(kHasCn0));
  ASSERT_TRUE(without.Next(&epoch));
  ASSERT_TRUE(epoch.signals.at(0).Has(kHasCn0));
  EXPECT_NEAR(epoch.signals[0].cn0_dbhz, 44.5, 3.0);  // 7 means 42 to 47 dB-Hz
}

TEST(RinexObservation, ReadsTypeListsOverSeveralLines) {
  auto reader = Open(
      Version("3.05", "M") +
      Record("G   15 C1C L1C D1C S1C C2W L2W D2W S2W C2L L2L D2L S2L C5Q", "SYS / # / OBS TYPES") +
      Record("       L5Q D5Q", "SYS / # / OBS TYPES") +
      Record("E    1 C1C", "SYS / # / OBS TYPES") + kEnd);
  EXPECT_THAT(reader.header().types.at(System::kGps),
              ElementsAre("C1C", "L1C", "D1C", "S1C", "C2W", "L2W", "D2W", "S2W", "C2L", "L2L",
                          "D2L", "S2L", "C5Q", "L5Q", "D5Q"));
  EXPECT_THAT(reader.header().types.at(System::kGalileo), ElementsAre("C1C"));
  EXPECT_TRUE(reader.header().mixed);
}

TEST(RinexObservation, IgnoresTypesItHasNoUseForButKeepsTheirColumns) {
  auto reader = Open(Version("3.04", "M") + Record("G    3 X1  C9Z C1C", "SYS / # / OBS TYPES") +
                     kEnd + kTag + "G01         9.000    20000001.000    20000002.000\n");
  ObservationEpoch epoch;
  ASSERT_TRUE(reader.Next(&epoch));
  ASSERT_THAT(SignalNames(epoch), ElementsAre("G01:1C"));
  EXPECT_EQ(epoch.signals[0].pseudorange_m, 20000002.0);
}

TEST(RinexObservation, DividesByTheScaleFactorOfTheType) {
  auto reader = Open(Version("3.04", "M") + Record("G 1000   1 L1C", "SYS / SCALE FACTOR") +
                     Record("G    4 C1C L1C D1C S1C", "SYS / # / OBS TYPES") +
                     Record("E    2 C1C L1C", "SYS / # / OBS TYPES") +
                     Record("E   10", "SYS / SCALE FACTOR") + kEnd +
                     "> 2020 01 01 00 00  0.0000000  0  2\n"
                     "G01  20000000.000  1000000000.000\n"
                     "E01 200000000.000  1000000000.000\n");
  ObservationEpoch epoch;
  ASSERT_TRUE(reader.Next(&epoch));
  ASSERT_EQ(epoch.signals.size(), 2u);
  EXPECT_EQ(epoch.signals[0].pseudorange_m, 2e7);
  EXPECT_EQ(epoch.signals[0].carrier_phase_cycles, 1e6);
  EXPECT_EQ(epoch.signals[1].pseudorange_m, 2e7);
  EXPECT_EQ(epoch.signals[1].carrier_phase_cycles, 1e8);
}

TEST(RinexObservation, ReadsStationRecords) {
  auto reader =
      Open(Version("3.04", "M") + Record("ESBC00DNK", "MARKER NAME") +
           Record("3048338             SEPT POLARX5        5.3.2", "REC # / TYPE / VERS") +
           Record("00464               ASH701945E_M    SNOW", "ANT # / TYPE") +
           Record("  3582105.2910   532589.7313  5232754.8054", "APPROX POSITION XYZ") +
           Record("        1.5000        0.2500       -0.1000", "ANTENNA: DELTA H/E/N") +
           Record("    30.000", "INTERVAL") + Record("    18    18  1929     7", "LEAP SECONDS") +
           Record("  2 R01  1 R02 -4", "GLONASS SLOT / FRQ #") +
           Record(" 1 R13 -2", "GLONASS SLOT / FRQ #") +
           Record("R    2 C1C C3Q", "SYS / # / OBS TYPES") + kEnd +
           "> 2020 01 01 00 00  0.0000000  0  2\n"
           "R02  20000000.000    20000000.000\n"
           "R05  20000000.000\n");
  const RinexObservationHeader& header = reader.header();
  EXPECT_EQ(header.marker_name, "ESBC00DNK");
  EXPECT_EQ(header.receiver, "SEPT POLARX5");
  EXPECT_EQ(header.antenna, "ASH701945E_M    SNOW");
  ASSERT_TRUE(header.approximate_position_in_ecef.has_value());
  EXPECT_EQ(header.approximate_position_in_ecef->y(), 532589.7313);
  EXPECT_EQ(header.antenna_delta_hen_m.x(), 1.5);
  EXPECT_EQ(header.antenna_delta_hen_m.z(), -0.1);
  EXPECT_EQ(header.interval_s, 30.0);
  EXPECT_EQ(header.leap_seconds, 18);
  EXPECT_THAT(header.glonass_channels, UnorderedElementsAre(Pair(1, 1), Pair(2, -4), Pair(13, -2)));
  ObservationEpoch epoch;
  ASSERT_TRUE(reader.Next(&epoch));
  ASSERT_THAT(SignalNames(epoch), ElementsAre("R02:1C", "R02:3Q", "R05:1C"));
  EXPECT_EQ(epoch.signals[0].glonass_channel, -4);
  EXPECT_EQ(epoch.signals[0].frequency_hz, 1602e6 - 4 * 562.5e3);
  EXPECT_EQ(epoch.signals[1].frequency_hz, 1202.025e6);
  EXPECT_EQ(epoch.signals[2].glonass_channel, kUnknownGlonassChannel);
}

TEST(RinexObservation, HasNoApproximatePositionWhereTheHeaderHasZeros) {
  auto reader = Open(Version("3.04", "M") +
                     Record("        0.0000        0.0000        0.0000", "APPROX POSITION XYZ") +
                     Record("G    1 C1C", "SYS / # / OBS TYPES") + kEnd);
  EXPECT_FALSE(reader.header().approximate_position_in_ecef.has_value());
  EXPECT_EQ(reader.report().rows_skipped, 0);
}

TEST(RinexObservation, CountsLeapSecondsFromBeidouTime) {
  auto reader = Open(Version("3.04", "C") + Record("     4     4   561     7BDS", "LEAP SECONDS") +
                     Record("C    1 C2I", "SYS / # / OBS TYPES") + kEnd);
  EXPECT_EQ(reader.header().leap_seconds, 18);
}

TEST(RinexObservation, KnowsThatVersion302CalledB1iBandOne) {
  const auto types = [](std::string_view version, std::string_view type) {
    auto reader = Open(Version(version, "M") +
                       Record("C    1 " + std::string(type), "SYS / # / OBS TYPES") + kEnd);
    return reader.header().types.at(System::kBeidou).at(0);
  };
  EXPECT_EQ(types("3.02", "C1I"), "C2I");
  EXPECT_EQ(types("3.02", "L1X"), "L2X");
  EXPECT_EQ(types("3.03", "C1I"), "C2I");
  EXPECT_EQ(types("3.04", "C1X"), "C1X");  // B1C
  EXPECT_EQ(types("3.04", "C1P"), "C1P");
}

TEST(RinexObservation, MarksAPowerFailureAndSkipsEvents) {
  auto reader =
      Open(GpsFile("> 2020 01 01 00 00  0.0000000  0  1\n"
                   "G01  20000000.000\n"
                   ">                              2  0\n"
                   "> 2020 01 01 00 00  0.5000000  5  0\n"
                   ">                              4  2\n" +
                   Record("moved", "COMMENT") + Record("G    1 L1C", "SYS / # / OBS TYPES") +
                   "> 2020 01 01 00 00  1.0000000  1  1\n"
                   "G01 100000000.000\n"
                   "> 2020 01 01 00 00  1.5000000  6  1\n"
                   "G01         3.000\n"
                   "> 2020 01 01 00 00  2.0000000  0  0\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 3u);
  EXPECT_FALSE(epochs[0].clock_discontinuity);
  EXPECT_TRUE(epochs[1].clock_discontinuity);
  EXPECT_FALSE(epochs[2].clock_discontinuity);
  EXPECT_EQ(epochs[0].signals.at(0).present, kHasPseudorange | 0u);
  EXPECT_EQ(epochs[1].signals.at(0).present, kHasCarrierPhase | 0u);
  EXPECT_EQ(reader.report().rows_skipped, 0);
}

TEST(RinexObservation, FindsTheNextEpochAfterDamage) {
  auto reader =
      Open(GpsFile("G01  20000000.000\n"
                   "G02  20000000.000\n"
                   "> 2020 01 01 00 00  0.0000000  0  3\n"
                   "G01  20000000.000\n"
                   "> 2020 13 01 00 00  1.0000000  0  1\n"
                   "G01  20000000.000\n"
                   "> 2020 01 01 00 00  2.0000000  0  1\n"
                   "G01  20000000.000\n"
                   "> 1979 01 01 00 00  2.0000000  0  1\n"
                   "G01  20000000.000\n"
                   "> 2020 01 01 00 00  3.0000000  0 99\n"
                   "G01  20000000.000\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 3u);
  for (const ObservationEpoch& epoch : epochs) EXPECT_EQ(epoch.signals.size(), 1u);
  EXPECT_EQ(epochs[2].time_gps_ns, kNewYear2020_ns + 3 * kSecond_ns);
  EXPECT_EQ(reader.report().rows_read, 3);
  EXPECT_GE(reader.report().rows_skipped, 5);
  EXPECT_EQ(reader.report().problems.at(0).line, 4);
}

TEST(RinexObservation, RefusesTimesBeforeThatOfGpsBegan) {
  auto reader =
      Open(GpsFile("> 1980 01 01 00 00  0.0000000  0  0\n"
                   "> 1980 01 05 23 59 59.9999999  0  0\n"
                   "> 1980 01 06 00 00  1.0000000  0  0\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 1u);
  EXPECT_EQ(epochs[0].time_gps_ns, kSecond_ns);
  EXPECT_GE(reader.report().rows_skipped, 1);
}

TEST(RinexObservation, PassesOnTimeRunningBackwards) {
  auto reader =
      Open(GpsFile("> 2020 01 01 00 00  5.0000000  0  0\n"
                   "> 2020 01 01 00 00  1.0000000  0  0\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 2u);
  EXPECT_LT(epochs[1].time_gps_ns, epochs[0].time_gps_ns);
}

TEST(RinexObservation, SaysWhyAFileCannotBeRead) {
  EXPECT_THAT(OpenError("hello\n").message, HasSubstr("test.obs: is no RINEX file"));
  EXPECT_THAT(OpenError(Version("5.00", "M")).message, HasSubstr("5.00"));
  EXPECT_EQ(OpenError(Version("5.00", "M")).code, ErrorCode::kUnsupported);
  EXPECT_THAT(OpenError(Version("3.04", "M")).message, HasSubstr("no END OF HEADER"));
  EXPECT_THAT(OpenError(Version("3.04", "M") + kEnd).message, HasSubstr("observation types"));
  EXPECT_THAT(OpenError(Record("     3.04           NAVIGATION DATA     M", "RINEX VERSION / TYPE"))
                  .message,
              HasSubstr("NAVIGATION DATA"));
}

// A version 2 file of five types, so that one line holds a satellite.
std::string File2(std::string_view system, std::string_view types, const std::string& body) {
  return Version("2.11", system) + Record(std::string(types), "# / TYPES OF OBSERV") + kEnd + body;
}

TEST(RinexObservation2, TranslatesTypesPerSystem) {
  auto reader = Open(File2("M", "     8    C1    P1    P2    L1    L2    D1    C5    S2", ""));
  const auto& types = reader.header().types;
  EXPECT_THAT(types.at(System::kGps),
              ElementsAre("C1C", "C1W", "C2W", "L1C", "L2W", "D1C", "C5X", "S2W"));
  EXPECT_THAT(types.at(System::kGlonass),
              ElementsAre("C1C", "C1P", "C2P", "L1C", "L2P", "D1C", "S2P"));
  EXPECT_THAT(types.at(System::kGalileo), ElementsAre("C1X", "L1X", "D1X", "C5X"));
  EXPECT_THAT(types.at(System::kSbas), ElementsAre("C1C", "L1C", "D1C", "C5X"));
}

TEST(RinexObservation2, PutsThePhaseWithTheCodeTheFileHas) {
  auto precise = Open(File2("G", "     2    P1    L1", ""));
  EXPECT_THAT(precise.header().types.at(System::kGps), ElementsAre("C1W", "L1W"));
  auto civil = Open(File2("G", "     4    C1    C2    L1    L2", ""));
  EXPECT_THAT(civil.header().types.at(System::kGps), ElementsAre("C1C", "C2X", "L1C", "L2X"));
}

TEST(RinexObservation2, ReadsTwoDigitYearsAndMissingSystemLetters) {
  auto reader = Open(File2("G", "     1    C1",
                           " 99 12 31 23 59 59.0000000  0  2  7G 8\n"
                           "  20000000.000\n"
                           "  21000000.000\n"
                           " 20  1  1  0  0  0.0000000  0  1G09\n"
                           "  22000000.000\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 2u);
  EXPECT_THAT(SignalNames(epochs[0]), ElementsAre("G07:1C", "G08:1C"));
  // 1999-12-31 23:59:59 ends week 1042, day 5.
  EXPECT_EQ(epochs[0].time_gps_ns, 1042 * kWeek_ns + 6 * kDay_ns - kSecond_ns);
  EXPECT_EQ(epochs[1].time_gps_ns, kNewYear2020_ns);
  EXPECT_EQ(reader.report().rows_skipped, 0);
}

TEST(RinexObservation2, ReadsSatellitesAndFieldsOverSeveralLines) {
  std::string list;
  std::string rows;
  for (int i = 1; i <= 14; ++i) list += (i < 10 ? "G0" : "G") + std::to_string(i);
  for (int i = 1; i <= 14; ++i) {
    rows += "  200000" + std::to_string(10 + i) + ".000\n";
    rows += i % 2 == 0 ? "\n" : "                      1000.250\n";
  }
  auto reader = Open(File2("G", "     7    C1    P2    L1    L2    S1    S2    D1",
                           " 20  1  1  0  0  0.0000000  0 14" + list.substr(0, 36) +
                               "  .000000001\n" + std::string(32, ' ') + list.substr(36) + "\n" +
                               rows + " 20  1  1  0  0  1.0000000  0  0\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 2u);
  ASSERT_EQ(epochs[0].signals.size(), 14u);
  EXPECT_EQ(epochs[0].signals[13].satellite.number, 14);
  EXPECT_EQ(epochs[0].signals[13].pseudorange_m, 20000024.0);
  EXPECT_FALSE(epochs[0].signals[13].Has(kHasDoppler));
  EXPECT_EQ(epochs[0].signals[12].doppler_hz, 1000.25);
  EXPECT_EQ(reader.report().rows_skipped, 0);
}

TEST(RinexObservation2, SkipsEventsAndCycleSlips) {
  auto reader = Open(File2("G", "     2    C1    L1",
                           " 20  1  1  0  0  0.0000000  0  1G01\n"
                           "  20000000.000\n"
                           "                            4  2\n" +
                               Record("     1    C1", "# / TYPES OF OBSERV") +
                               Record("a comment", "COMMENT") +
                               " 20  1  1  0  0  0.5000000  6  1G01\n"
                               "         3.000\n"
                               " 20  1  1  0  0  1.0000000  1  1G01\n"
                               "  21000000.000\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 2u);
  EXPECT_EQ(epochs[1].signals.at(0).pseudorange_m, 2.1e7);
  EXPECT_TRUE(epochs[1].clock_discontinuity);
  EXPECT_EQ(reader.report().rows_skipped, 0);
}

TEST(RinexObservation2, FindsTheNextEpochAfterDamage) {
  auto reader = Open(File2("G", "     2    C1    L1",
                           " 20  1  1  0  0  0.0000000  0  3G01G02G03\n"
                           "  20000000.000\n"
                           " 20  1  1  0  0  1.0000000  0  1G01\n"
                           "  20000000.000\n"
                           "  20000000.000 8 104231461.63438\n"
                           " 20  1  1  0  0  2.0000000  0  1G01\n"
                           "  20000000.000\n"));
  const auto epochs = AllEpochs(&reader);
  ASSERT_EQ(epochs.size(), 3u);
  for (const ObservationEpoch& epoch : epochs) EXPECT_EQ(epoch.signals.size(), 1u);
  EXPECT_EQ(reader.report().rows_skipped, 2);
}

}  // namespace
}  // namespace lodemark
