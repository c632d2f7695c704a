#include "core/logs/gnss_logger.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace lodemark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr std::string_view kHeader30 =
    "# Version: v3.0.6.4 Platform: 14 Manufacturer: Google Model: Pixel 7\n"
    "# Raw,utcTimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,FullBiasNanos,BiasNanos,"
    "BiasUncertaintyNanos,DriftNanosPerSecond,DriftUncertaintyNanosPerSecond,"
    "HardwareClockDiscontinuityCount,Svid,TimeOffsetNanos,State,ReceivedSvTimeNanos,"
    "ReceivedSvTimeUncertaintyNanos,Cn0DbHz,PseudorangeRateMetersPerSecond,"
    "PseudorangeRateUncertaintyMetersPerSecond,AccumulatedDeltaRangeState,"
    "AccumulatedDeltaRangeMeters,AccumulatedDeltaRangeUncertaintyMeters,CarrierFrequencyHz,"
    "CarrierCycles,CarrierPhase,CarrierPhaseUncertainty,MultipathIndicator,SnrInDb,"
    "ConstellationType,AgcDb,BasebandCn0DbHz,FullInterSignalBiasNanos,"
    "FullInterSignalBiasUncertaintyNanos,SatelliteInterSignalBiasNanos,"
    "SatelliteInterSignalBiasUncertaintyNanos,CodeType,ChipsetElapsedRealtimeNanos\n";

// A Raw row in the order of kHeader30; the rest of a measurement is the same in all of them.
std::string Raw30(std::string_view time_ns, std::string_view svid, std::string_view constellation) {
  std::string row = "Raw,1700000000000,";
  row.append(time_ns).append(",18,,-1400000000123456789,0.25,7.5,129.0,1.0,22,").append(svid);
  row += ",0.0,16399,250000111222333,40,28.5,650.75,0.5,16,40000.5,0.25,1575420000,,,,1,,";
  row.append(constellation).append(",-1.5,25.25,-0.5,1.0,-0.75,1.0,C,16000555333000\n");
  return row;
}

// A Raw row in the order of v1.4.
std::string Raw14(std::string_view time_ns, std::string_view svid, std::string_view constellation) {
  std::string row = "Raw,300012380,";
  row.append(time_ns).append(",,,-1150000000987654321,0.0,7.6,,,0,").append(svid);
  row += ",0.0,39,164000777888999,16,34.5,600.25,0.0625,3,4000.25,0.0016,,,,,0,,";
  row.append(constellation).append("\n");
  return row;
}

struct Log {
  explicit Log(std::string_view text)
      : reader(*GnssLoggerReader::FromLines(LineReader::FromMemory("log.txt", text))) {
    GnssLoggerRecord record;
    while (reader.Next(&record)) records.push_back(record);
  }

  template <typename T>
  std::vector<T> All() const {
    std::vector<T> all;
    for (const GnssLoggerRecord& record : records) {
      if (const T* one = std::get_if<T>(&record)) all.push_back(*one);
    }
    return all;
  }

  std::string FirstProblem() const {
    const auto& problems = reader.report().problems;
    return problems.empty() ? "none" : FormatProblem(reader.report().file, problems.front());
  }

  GnssLoggerReader reader;
  std::vector<GnssLoggerRecord> records;
};

TEST(GnssLogger, ReadsEveryColumnOfARawRow) {
  const Log log(std::string(kHeader30) + Raw30("61000000000", "4", "1"));
  const auto epochs = log.All<AndroidEpoch>();
  ASSERT_EQ(epochs.size(), 1u);
  const AndroidClock& clock = epochs[0].clock;
  EXPECT_EQ(clock.time_ns, 61'000'000'000);
  EXPECT_EQ(clock.full_bias_ns, -1'400'000'000'123'456'789);
  EXPECT_EQ(clock.bias_ns, 0.25);
  EXPECT_EQ(clock.bias_uncertainty_ns, 7.5);
  EXPECT_EQ(clock.drift_nsps, 129.0);
  EXPECT_EQ(clock.drift_uncertainty_nsps, 1.0);
  EXPECT_EQ(clock.leap_second, 18);
  EXPECT_EQ(clock.hardware_clock_discontinuity_count, 22);
  EXPECT_EQ(clock.elapsed_realtime_ns, 16'000'555'333'000);
  EXPECT_EQ(clock.present, kClockHasLeapSecond | kClockHasFullBias | kClockHasBias |
                               kClockHasBiasUncertainty | kClockHasDrift |
                               kClockHasDriftUncertainty | kClockHasElapsedRealtime);

  ASSERT_EQ(epochs[0].measurements.size(), 1u);
  const AndroidMeasurement& m = epochs[0].measurements[0];
  EXPECT_EQ(m.svid, 4);
  EXPECT_EQ(m.constellation_type, 1);
  EXPECT_EQ(m.state, 16399);
  EXPECT_EQ(m.received_sv_time_ns, 250'000'111'222'333);
  EXPECT_EQ(m.received_sv_time_uncertainty_ns, 40);
  EXPECT_EQ(m.cn0_dbhz, 28.5);
  EXPECT_EQ(m.baseband_cn0_dbhz, 25.25);
  EXPECT_EQ(m.pseudorange_rate_mps, 650.75);
  EXPECT_EQ(m.pseudorange_rate_uncertainty_mps, 0.5);
  EXPECT_EQ(m.accumulated_delta_range_state, 16);
  EXPECT_EQ(m.accumulated_delta_range_m, 40000.5);
  EXPECT_EQ(m.accumulated_delta_range_uncertainty_m, 0.25);
  EXPECT_EQ(m.carrier_frequency_hz, 1'575'420'000.0);
  EXPECT_EQ(m.multipath_indicator, 1);
  EXPECT_EQ(m.agc_db, -1.5);
  EXPECT_EQ(m.full_inter_signal_bias_ns, -0.5);
  EXPECT_EQ(m.satellite_inter_signal_bias_ns, -0.75);
  EXPECT_STREQ(m.code_type, "C");
  EXPECT_FALSE(m.Has(kMeasurementHasSnr));
  EXPECT_TRUE(m.Has(kMeasurementHasCodeType | kMeasurementHasAgc | kMeasurementHasRangeRate |
                    kMeasurementHasCarrierFrequency | kMeasurementHasAccumulatedDeltaRange));
  EXPECT_EQ(log.reader.logger_version(), "v3.0.6.4");
  EXPECT_EQ(log.reader.device(), "Google Pixel 7");
}

TEST(GnssLogger, GroupsRowsOfOneEventWhateverComesBetween) {
  const Log log(std::string(kHeader30) + Raw30("1000000000", "4", "1") +
                "Accel,1700000000000,5000,0.5,9.5,1.5\n" + Raw30("1000000000", "5", "1") +
                Raw30("2000000000", "4", "1"));
  const auto epochs = log.All<AndroidEpoch>();
  ASSERT_EQ(epochs.size(), 2u);
  EXPECT_EQ(epochs[0].measurements.size(), 2u);
  EXPECT_EQ(epochs[1].measurements.size(), 1u);
  EXPECT_EQ(epochs[1].clock.time_ns, 2'000'000'000);
  EXPECT_EQ(log.All<LoggedSensor>().size(), 1u);
}

TEST(GnssLogger, ReadsVersion14WithItsHeaderAndWithout) {
  const std::string header =
      "# Version: 1.4.0.0, Platform: N\r\n# \r\n"
      "# Raw,ElapsedRealtimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,FullBiasNanos,"
      "BiasNanos,BiasUncertaintyNanos,DriftNanosPerSecond,DriftUncertaintyNanosPerSecond,"
      "HardwareClockDiscontinuityCount, Svid,TimeOffsetNanos,State,ReceivedSvTimeNanos,"
      "ReceivedSvTimeUncertaintyNanos,Cn0DbHz,PseudorangeRateMetersPerSecond,"
      "PseudorangeRateUncertaintyMetersPerSecond,AccumulatedDeltaRangeState,"
      "AccumulatedDeltaRangeMeters,AccumulatedDeltaRangeUncertaintyMeters,CarrierFrequencyHz,"
      "CarrierCycles,CarrierPhase,CarrierPhaseUncertainty,MultipathIndicator,SnrInDb,"
      "ConstellationType\r\n";
  for (const std::string& head : {header, std::string()}) {
    const Log log(head + Raw14("10000000000", "93", "3"));
    const auto epochs = log.All<AndroidEpoch>();
    ASSERT_EQ(epochs.size(), 1u);
    EXPECT_EQ(epochs[0].clock.full_bias_ns, -1'150'000'000'987'654'321);
    EXPECT_EQ(epochs[0].clock.elapsed_realtime_ns, 300'012'380'000'000);
    EXPECT_EQ(epochs[0].measurements[0].svid, 93);  // a frequency channel + 100, as logged
    EXPECT_FALSE(epochs[0].measurements[0].Has(kMeasurementHasCarrierFrequency));
    EXPECT_FALSE(epochs[0].clock.Has(kClockHasLeapSecond));
    EXPECT_EQ(log.reader.logger_version(), head.empty() ? "" : "v1.4.0.0");
  }
}

TEST(GnssLogger, ReadsAVersion30RowWithoutHeader) {
  const Log log(Raw30("61000000000", "9", "7"));  // constellation 7 is NavIC
  const auto epochs = log.All<AndroidEpoch>();
  ASSERT_EQ(epochs.size(), 1u);
  EXPECT_EQ(epochs[0].measurements[0].constellation_type, 7);
  EXPECT_STREQ(epochs[0].measurements[0].code_type, "C");
}

TEST(GnssLogger, TakesTheFilledOneOfTwoColumnsOfAName) {
  const std::string header =
      "# Raw,TimeNanos,Svid,State,ReceivedSvTimeNanos,CarrierFrequencyHz,ConstellationType,"
      "CarrierFrequencyHz\n";
  const Log log(header + "Raw,1000,3,1,5,,1,1176450000\nRaw,1000,4,1,5,1575420000,1,\n");
  const auto epochs = log.All<AndroidEpoch>();
  ASSERT_EQ(epochs.size(), 1u);
  EXPECT_EQ(epochs[0].measurements[0].carrier_frequency_hz, 1'176'450'000.0);
  EXPECT_EQ(epochs[0].measurements[1].carrier_frequency_hz, 1'575'420'000.0);
}

TEST(GnssLogger, FollowsEachHeaderBlock) {
  const Log log(
      "# Raw,TimeNanos,Svid,State,ReceivedSvTimeNanos,ConstellationType\n"
      "Raw,1000,3,1,5,1\n"
      "# Raw,ConstellationType,Svid,ReceivedSvTimeNanos,State,TimeNanos,New\n"
      "Raw,6,11,7,9,2000,?\n");
  const auto epochs = log.All<AndroidEpoch>();
  ASSERT_EQ(epochs.size(), 2u);
  EXPECT_EQ(epochs[1].clock.time_ns, 2000);
  EXPECT_EQ(epochs[1].measurements[0].svid, 11);
  EXPECT_EQ(epochs[1].measurements[0].constellation_type, 6);
  EXPECT_EQ(epochs[1].measurements[0].state, 9);
}

TEST(GnssLogger, TreatsSentinelsAsMissingWithoutComplaint) {
  std::string row = Raw30("1000000000", "4", "1");
  for (const std::string_view none : {"340282346638528860000000000000000000000", "NaN", "Infinity",
                                      "1.7976931348623157E308", ""}) {
    std::string changed = row;
    changed.replace(changed.find("28.5"), 4, none);
    const Log log(std::string(kHeader30) + changed);
    const auto epochs = log.All<AndroidEpoch>();
    ASSERT_EQ(epochs.size(), 1u) << none;
    EXPECT_FALSE(epochs[0].measurements[0].Has(kMeasurementHasCn0)) << none;
    EXPECT_EQ(log.reader.report().values_dropped, 0) << none;
  }
}

TEST(GnssLogger, DropsAnAbsurdOptionalValueAndSaysWhere) {
  std::string row = Raw30("1000000000", "4", "1");
  row.replace(row.find("28.5"), 4, "2850.");
  const Log log(std::string(kHeader30) + row);
  ASSERT_EQ(log.All<AndroidEpoch>().size(), 1u);
  EXPECT_FALSE(log.All<AndroidEpoch>()[0].measurements[0].Has(kMeasurementHasCn0));
  EXPECT_EQ(log.reader.report().values_dropped, 1);
  const std::string column = std::to_string(row.find("2850.") + 1);
  EXPECT_EQ(log.FirstProblem(), "log.txt:3:" + column + ": Cn0DbHz '2850.' is no plausible value");
}

TEST(GnssLogger, SkipsRowsWithoutWhatTheyAreAbout) {
  const std::string overflow = Raw30("99999999999999999999", "4", "1");
  const std::string no_satellite = Raw30("1000000000", "", "1");
  const std::string wrong_satellite = Raw30("1000000000", "900", "1");
  const std::string negative = Raw30("-5", "4", "1");
  const std::string short_row = "Raw,1700000000000,1000000000,18,,-138343575091\n";
  const Log log(std::string(kHeader30) + overflow + no_satellite + wrong_satellite + negative +
                short_row + Raw30("1000000000", "4", "1"));
  EXPECT_EQ(log.All<AndroidEpoch>().size(), 1u);
  EXPECT_EQ(log.reader.report().rows_read, 1);
  EXPECT_EQ(log.reader.report().rows_skipped, 5);
  ASSERT_EQ(log.reader.report().problems.size(), 5u);
  EXPECT_THAT(log.reader.report().problems[0].message, HasSubstr("TimeNanos '9999"));
  EXPECT_EQ(log.reader.report().problems[1].message, "Svid is missing");
  EXPECT_THAT(log.reader.report().problems[2].message, HasSubstr("Svid '900'"));
  EXPECT_THAT(log.reader.report().problems[4].message, HasSubstr("has 6 of 37 columns"));
}

TEST(GnssLogger, SkipsATruncatedLastRow) {
  std::string text = std::string(kHeader30) + Raw30("1000000000", "4", "1");
  const std::string last = Raw30("1000000000", "5", "1");
  for (std::size_t kept = 1; kept < last.find(",1,-1.5"); ++kept) {
    const Log log(text + last.substr(0, kept));
    ASSERT_EQ(log.All<AndroidEpoch>().size(), 1u) << kept;
    EXPECT_EQ(log.All<AndroidEpoch>()[0].measurements.size(), 1u) << kept;
    EXPECT_EQ(log.reader.report().rows_skipped + log.reader.report().rows_unknown, 1) << kept;
  }
}

TEST(GnssLogger, DoesNotTrustTheLastCellOfACutRow) {
  std::string text = std::string(kHeader30) + Raw30("1000000000", "4", "1");
  text.resize(text.size() - 4);  // the stamp loses three digits and the line its end
  const Log log(text);
  ASSERT_EQ(log.All<AndroidEpoch>().size(), 1u);
  EXPECT_FALSE(log.All<AndroidEpoch>()[0].clock.Has(kClockHasElapsedRealtime));
}

TEST(GnssLogger, SaysWhichColumnAHeaderLacks) {
  const Log log("# Raw,TimeNanos,Svid,State,ReceivedSvTimeNanos\nRaw,1000,3,1,5\n");
  EXPECT_TRUE(log.records.empty());
  EXPECT_EQ(log.FirstProblem(), "log.txt:2: ConstellationType has no column in the header");
}

TEST(GnssLogger, ReadsFixesOfBothColumnOrders) {
  const Log log(
      "# Fix,Provider,Latitude,Longitude,Altitude,Speed,Accuracy,(UTC)TimeInMs\n"
      "Fix,gps,60.25,10.5,170.75,0.5,2.0,1480000031999\n"
      "# Fix,Provider,LatitudeDegrees,LongitudeDegrees,AltitudeMeters,SpeedMps,AccuracyMeters,"
      "BearingDegrees,UnixTimeMillis,SpeedAccuracyMps,BearingAccuracyDegrees,"
      "elapsedRealtimeNanos,VerticalAccuracyMeters\n"
      "Fix,FLP,37.5,-122.25,-29co.19,0.25,4.0,181.5,1700000582000,0.125,,16100559129000,3.0\n"
      "Fix,FLP,97.5,-122.25,0,0,4.0,0,1700000582000,0,,1,3.0\n");
  const auto fixes = log.All<LoggedFix>();
  ASSERT_EQ(fixes.size(), 2u);
  EXPECT_EQ(fixes[0].provider, "gps");
  EXPECT_EQ(fixes[0].height_m, 170.75);
  EXPECT_EQ(fixes[0].unix_time_ms, 1'480'000'031'999);
  EXPECT_EQ(fixes[0].elapsed_realtime_ns, std::nullopt);
  EXPECT_EQ(fixes[1].longitude_deg, -122.25);
  EXPECT_EQ(fixes[1].height_m, std::nullopt);  // "-29co.19" is no number
  EXPECT_EQ(fixes[1].bearing_deg, 181.5);
  EXPECT_EQ(fixes[1].vertical_accuracy_m, 3.0);
  EXPECT_EQ(fixes[1].elapsed_realtime_ns, 16'100'559'129'000);
  EXPECT_EQ(log.reader.report().rows_skipped, 1);  // latitude 97.5
}

TEST(GnssLogger, ReadsStatusAndAgcRows) {
  const Log log(
      "Status,,20,3,6,11,1575420000,36.5,310.0,45.0,1,1,0\n"
      "# Agc,utcTimeMillis,TimeNanos,LeapSecond,AgcDb,CarrierFrequencyHz,ConstellationType\n"
      "Agc,1700000632000,99000000000,,40.75,1176450000,6\n");
  const auto statuses = log.All<LoggedStatus>();
  ASSERT_EQ(statuses.size(), 1u);
  EXPECT_EQ(statuses[0].unix_time_ms, std::nullopt);
  EXPECT_EQ(statuses[0].constellation_type, 6);
  EXPECT_EQ(statuses[0].svid, 11);
  EXPECT_EQ(statuses[0].cn0_dbhz, 36.5);
  EXPECT_EQ(statuses[0].azimuth_deg, 310.0);
  EXPECT_EQ(statuses[0].elevation_deg, 45.0);
  EXPECT_TRUE(statuses[0].used_in_fix);
  const auto agcs = log.All<LoggedAgc>();
  ASSERT_EQ(agcs.size(), 1u);
  EXPECT_EQ(agcs[0].agc_db, 40.75);
  EXPECT_EQ(agcs[0].carrier_frequency_hz, 1'176'450'000.0);
  EXPECT_EQ(agcs[0].unix_time_ms, 1'700'000'632'000);
}

TEST(GnssLogger, ReadsNavigationMessagesAsBytes) {
  const Log log(
      "Nav,98,769,1,5,6,11,-84,33,44\n"
      "Nav,2,257,1,-1,1,34,-51,-129\n"
      "Nav,2,257,1,-1\n"
      "Nav,2,257,1,-1,1\n"
      "Nav,2,257,1,-1,1,34,-6");
  const auto messages = log.All<LoggedNavigationMessage>();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].svid, 98);
  EXPECT_EQ(messages[0].type, 769);
  EXPECT_EQ(messages[0].status, 1);
  EXPECT_EQ(messages[0].message_id, 5);
  EXPECT_EQ(messages[0].submessage_id, 6);
  EXPECT_THAT(messages[0].bytes, ElementsAre(11, 172, 33, 44));
  EXPECT_EQ(log.reader.report().rows_skipped, 4);
}

TEST(GnssLogger, ReadsInertialAndOrientationRows) {
  const Log log(
      "# UncalGyro,utcTimeMillis,elapsedRealtimeNanos,UncalGyroXRadPerSec,UncalGyroYRadPerSec,"
      "UncalGyroZRadPerSec,DriftXRadPerSec,DriftYRadPerSec,DriftZRadPerSec,CalibrationAccuracy\n"
      "UncalGyro,1700000633290,16100000984694,0.5,-0.25,0.125,-0.0625,-0.5,0.75,3\n"
      "UncalAccel,1,2,0.5,1.5,9.75,0.25,0.125,-0.5\n"
      "Mag,1,2,-60.5,-10.25,-15.75\n"
      "OrientationDeg,1,2,220.0,1.0,-5.0\n"
      "# GameRotationVector,utcTimeMillis,elapsedRealtimeNanos,w,x,y,z\n"
      "GameRotationVector,1,2,0.5,-0.5,0.25,0.75\n"
      "Pressure,1,2,1013.25\n"
      "Gyro,1,2,0.5,nan,0.25\n");
  const auto rows = log.All<LoggedSensor>();
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].kind, LoggedSensor::Kind::kTurnRate);
  EXPECT_TRUE(rows[0].uncalibrated);
  EXPECT_EQ(rows[0].elapsed_realtime_ns, 16'100'000'984'694);
  EXPECT_EQ(rows[0].unix_time_ms, 1'700'000'633'290);
  EXPECT_THAT(rows[0].values, ElementsAre(0.5, -0.25, 0.125, 0.0));
  EXPECT_THAT(rows[0].biases, ElementsAre(-0.0625, -0.5, 0.75));
  EXPECT_EQ(rows[1].kind, LoggedSensor::Kind::kAcceleration);
  EXPECT_THAT(rows[1].biases, ElementsAre(0.25, 0.125, -0.5));
  EXPECT_EQ(rows[2].kind, LoggedSensor::Kind::kMagneticField);
  EXPECT_FALSE(rows[2].uncalibrated);
  EXPECT_EQ(rows[3].kind, LoggedSensor::Kind::kOrientation);
  EXPECT_EQ(rows[4].kind, LoggedSensor::Kind::kGameRotation);
  EXPECT_THAT(rows[4].values, ElementsAre(-0.5, 0.25, 0.75, 0.5));  // x y z w
  EXPECT_EQ(rows[5].kind, LoggedSensor::Kind::kPressure);
  EXPECT_EQ(rows[5].count, 1);
  EXPECT_EQ(log.reader.report().rows_skipped, 1);  // a NaN among the values
}

TEST(GnssLogger, CountsRowsByTheirWord) {
  const Log log("Mag,1,2,1,2,3\nNMEA,$GPGGA,\nNMEA,$GPGSV\n\xFF\x01,3\n\n# a comment\nFix,a\n");
  EXPECT_THAT(log.reader.row_counts(), UnorderedElementsAre(Pair("Mag", 1), Pair("NMEA", 2),
                                                            Pair("(other)", 1), Pair("Fix", 1)));
  EXPECT_EQ(log.reader.report().rows_unknown, 3);
  EXPECT_EQ(log.reader.report().rows_read, 1);
  EXPECT_EQ(log.reader.report().rows_skipped, 1);
}

TEST(GnssLogger, BoundsAnEndlessEpoch) {
  std::string text(kHeader30);
  for (int i = 0; i < 5'000; ++i) text += Raw30("1000000000", "4", "1");
  const Log log(text);
  ASSERT_EQ(log.All<AndroidEpoch>().size(), 1u);
  EXPECT_LE(log.All<AndroidEpoch>()[0].measurements.size(), 1'024u);
  EXPECT_GT(log.reader.report().rows_skipped, 3'000);
}

}  // namespace
}  // namespace lodemark
