#include "core/logs/kaggle_gnss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/kaggle_row.h"

namespace lodemark {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kTime_ns = 67'000'000'000;  // hardware clock
constexpr std::int64_t kFullBias_ns = -1'370'000'012'345'678'901;
constexpr std::int64_t kReception_gps_ns = kTime_ns - kFullBias_ns;

constexpr char kDeviceHeader[] =
    "MessageType,utcTimeMillis,TimeNanos,LeapSecond,FullBiasNanos,BiasNanos,"
    "HardwareClockDiscontinuityCount,Svid,TimeOffsetNanos,State,ReceivedSvTimeNanos,Cn0DbHz,"
    "CarrierFrequencyHz,ConstellationType,CodeType,ArrivalTimeNanosSinceGpsEpoch,"
    "RawPseudorangeMeters,RawPseudorangeUncertaintyMeters,SignalType,"
    "ReceivedSvTimeNanosSinceGpsEpoch,SvPositionXEcefMeters,SvPositionYEcefMeters,"
    "SvPositionZEcefMeters,SvElevationDegrees,SvAzimuthDegrees,SvVelocityXEcefMetersPerSecond,"
    "SvVelocityYEcefMetersPerSecond,SvVelocityZEcefMetersPerSecond,SvClockBiasMeters,"
    "SvClockDriftMetersPerSecond,IsrbMeters,IonosphericDelayMeters,TroposphericDelayMeters,"
    "WlsPositionXEcefMeters,WlsPositionYEcefMeters,WlsPositionZEcefMeters\n";

constexpr char kDerivedHeader[] =
    "collectionName,phoneName,millisSinceGpsEpoch,constellationType,svid,signalType,"
    "receivedSvTimeInGpsNanos,xSatPosM,ySatPosM,zSatPosM,xSatVelMps,ySatVelMps,zSatVelMps,"
    "satClkBiasM,satClkDriftMps,rawPrM,rawPrUncM,isrbM,ionoDelayM,tropoDelayM\n";

double RangeAfter(std::int64_t travel_ns) {
  return kSpeedOfLight_mps * 1e-9 * static_cast<double>(travel_ns);
}

// A row of a signal that was this long under way, its full bias written as given.
std::string DeviceRow(int svid, int constellation, std::int64_t received_ns, std::int64_t travel_ns,
                      const char* full_bias) {
  char row[512];
  std::snprintf(row, sizeof row,
                "Raw,1690000000000,%lld,18,%s,0,10,%d,0.0,16399,%lld,40.5,1575420000,%d,C,1.37e18,"
                "%.6f,4.5,GPS_L1,1.37e18,-1.5e7,8e6,2.1e7,16.5,313.0,84.5,-2527.5,1124.5,-166876.5,"
                "0.0026,0.25,9.25,8.5,-2.6e6,-4.2e6,3.8e6\n",
                static_cast<long long>(kTime_ns), full_bias, svid,
                static_cast<long long>(received_ns), constellation, RangeAfter(travel_ns));
  return row;
}

std::string DerivedRow(std::int64_t millis, int constellation, int svid, const char* signal,
                       const std::string& sent, std::int64_t travel_ns) {
  char row[512];
  std::snprintf(row, sizeof row,
                "here,Pixel4,%lld,%d,%d,%s,%s,-1.5e7,8e6,2.1e7,-24.5,244.5,3070.5,124614.5,0.5,"
                "%.6f,3.5,-222.25,4.5,3.25\n",
                static_cast<long long>(millis), constellation, svid, signal, sent.c_str(),
                RangeAfter(travel_ns));
  return row;
}

std::vector<KaggleEpoch> ReadAll(KaggleGnssReader* reader) {
  std::vector<KaggleEpoch> all;
  KaggleEpoch epoch;
  while (reader->Next(&epoch)) all.push_back(epoch);
  return all;
}

Result<KaggleGnssReader> Read(const std::string& text) {
  return KaggleGnssReader::FromLines(LineReader::FromMemory("gnss.csv", text));
}

// Pseudorange as the raw times give it, for a constellation that counts GPS weeks.
double RangeFromTimes(const AndroidEpoch& epoch, std::size_t i) {
  const std::int64_t now_ns = FloorModulo(epoch.clock.time_ns - epoch.clock.full_bias_ns, kWeek_ns);
  return RangeAfter(now_ns - epoch.measurements[i].received_sv_time_ns);
}

TEST(KaggleGnss, GivesMeasurementsWithTheirPseudorangeAndWhatGoogleDerived) {
  const std::int64_t sent_ns = FloorModulo(kReception_gps_ns - 71'000'000, kWeek_ns);
  const std::string text =
      kDeviceHeader + DeviceRow(2, 1, sent_ns, 71'000'000, "-1370000012345678901");
  auto reader = Read(text);
  ASSERT_TRUE(reader.ok());
  const auto epochs = ReadAll(&*reader);
  ASSERT_EQ(epochs.size(), 1u);
  EXPECT_EQ(reader->layout(), KaggleGnssReader::Layout::kDeviceGnss);
  EXPECT_FALSE(reader->timestamps_rounded());
  EXPECT_EQ(epochs[0].time_gps_ns, kReception_gps_ns);
  EXPECT_EQ(epochs[0].raw.clock.full_bias_ns, kFullBias_ns);
  EXPECT_TRUE(epochs[0].raw.clock.Has(kClockHasFullBias | kClockHasBias));
  ASSERT_EQ(epochs[0].raw.measurements.size(), 1u);
  const AndroidMeasurement& m = epochs[0].raw.measurements[0];
  EXPECT_TRUE(m.Has(kMeasurementHasGivenPseudorange | kMeasurementHasCn0));
  EXPECT_NEAR(m.given_pseudorange_m, RangeAfter(71'000'000), 1e-5);
  EXPECT_EQ(m.received_sv_time_ns, sent_ns);

  ASSERT_EQ(epochs[0].derived.size(), 1u);
  const KaggleDerived& derived = epochs[0].derived[0];
  EXPECT_EQ(derived.signal_type, "GPS_L1");
  EXPECT_EQ(derived.satellite_in_ecef, Eigen::Vector3d(-1.5e7, 8e6, 2.1e7));
  EXPECT_EQ(derived.satellite_velocity_in_ecef, Eigen::Vector3d(84.5, -2527.5, 1124.5));
  EXPECT_EQ(derived.clock_bias_m, -166876.5);
  EXPECT_EQ(derived.clock_drift_mps, 0.0026);
  EXPECT_EQ(derived.inter_signal_bias_m, 0.25);
  EXPECT_EQ(derived.ionosphere_m, 9.25);
  EXPECT_EQ(derived.troposphere_m, 8.5);
  EXPECT_EQ(derived.elevation_deg, 16.5);
  EXPECT_EQ(derived.azimuth_deg, 313.0);
  EXPECT_EQ(derived.pseudorange_sigma_m, 4.5);
  EXPECT_EQ(epochs[0].receiver_in_ecef, Eigen::Vector3d(-2.6e6, -4.2e6, 3.8e6));
}

TEST(KaggleGnss, FindsTheClockAgainWhereTheFullBiasLostItsDigits) {
  for (const char* full_bias : {"-1.37000001234568E+018", "-1370000012345680000"}) {
    std::string text = kDeviceHeader;
    for (int svid = 1; svid <= 5; ++svid) {
      const std::int64_t travel_ns = 70'000'000 + svid * 1'234'567;
      text += DeviceRow(svid, 1, FloorModulo(kReception_gps_ns - travel_ns, kWeek_ns), travel_ns,
                        full_bias);
    }
    auto reader = Read(text);
    const auto epochs = ReadAll(&*reader);
    ASSERT_EQ(epochs.size(), 1u);
    EXPECT_TRUE(reader->timestamps_rounded());
    EXPECT_EQ(epochs[0].time_gps_ns, kReception_gps_ns);
    EXPECT_EQ(epochs[0].raw.clock.time_ns, kTime_ns);
    EXPECT_EQ(epochs[0].raw.clock.full_bias_ns, kFullBias_ns);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(RangeFromTimes(epochs[0].raw, i),
                  epochs[0].raw.measurements[i].given_pseudorange_m, 0.3);  // 1 ns
    }
  }
}

TEST(KaggleGnss, TakesTheTimeOfA2021EpochFromItsRangesNotItsLateMilliseconds) {
  const std::string sent = std::to_string(kReception_gps_ns - 80'000'000);
  const std::int64_t late_ms = kReception_gps_ns / 1'000'000 + 1'000;
  const std::string text = kDerivedHeader + DerivedRow(late_ms, 6, 13, "GAL_E5A", sent, 80'000'000);
  auto reader = Read(text);
  ASSERT_TRUE(reader.ok());
  const auto epochs = ReadAll(&*reader);
  ASSERT_EQ(epochs.size(), 1u);
  EXPECT_EQ(reader->layout(), KaggleGnssReader::Layout::kDerived2021);
  EXPECT_FALSE(reader->timestamps_rounded());
  EXPECT_EQ(epochs[0].time_gps_ns, kReception_gps_ns);
  const AndroidMeasurement& m = epochs[0].raw.measurements[0];
  EXPECT_EQ(m.carrier_frequency_hz, 1'176'450'000.0);
  EXPECT_NEAR(RangeFromTimes(epochs[0].raw, 0), m.given_pseudorange_m, 0.3);
  EXPECT_EQ(epochs[0].derived[0].inter_signal_bias_m, -222.25);
}

TEST(KaggleGnss, Gives2021SignalsTimesOfTransmissionInTheirOwnScale) {
  const std::int64_t sent_gps_ns = kReception_gps_ns - 75'000'000;
  const std::string sent = std::to_string(sent_gps_ns);
  std::string text = kDerivedHeader;
  text += DerivedRow(1, 1, 5, "GPS_L1", sent, 75'000'000);
  text += DerivedRow(1, 3, 24, "GLO_G1", sent, 75'000'000);
  text += DerivedRow(1, 5, 20, "BDS_B1I", sent, 75'000'000);
  auto reader = Read(text);
  const auto epochs = ReadAll(&*reader);
  ASSERT_EQ(epochs.size(), 1u);
  const auto& m = epochs[0].raw.measurements;
  ASSERT_EQ(m.size(), 3u);
  const std::int64_t leap_ns = 18 * kSecond_ns;
  EXPECT_EQ(m[0].received_sv_time_ns, FloorModulo(sent_gps_ns, kWeek_ns));
  EXPECT_EQ(m[1].received_sv_time_ns,
            FloorModulo(sent_gps_ns - leap_ns + 3 * 3600 * kSecond_ns, kDay_ns));
  EXPECT_EQ(m[2].received_sv_time_ns, FloorModulo(sent_gps_ns - 14 * kSecond_ns, kWeek_ns));
  EXPECT_NE(m[0].state & 8, 0);                             // time of week decoded
  EXPECT_NE(m[1].state & 128, 0);                           // GLONASS time of day decoded
  EXPECT_FALSE(m[1].Has(kMeasurementHasCarrierFrequency));  // its channel is not in the file
}

TEST(KaggleGnss, KeepsRangesAndTimesTogetherWhereTimesOfTransmissionAreRounded) {
  std::string text = kDerivedHeader;
  for (int svid = 1; svid <= 9; ++svid) {
    const std::int64_t travel_ns = 70'000'000 + svid * 1'234'567;
    char sent[32];
    std::snprintf(sent, sizeof sent, "%.14E", static_cast<double>(kReception_gps_ns - travel_ns));
    text += DerivedRow(7, 1, svid, "GPS_L1", sent, travel_ns);
  }
  auto reader = Read(text);
  const auto epochs = ReadAll(&*reader);
  ASSERT_EQ(epochs.size(), 1u);
  EXPECT_TRUE(reader->timestamps_rounded());
  EXPECT_NEAR(static_cast<double>(epochs[0].time_gps_ns - kReception_gps_ns), 0.0, 5'000.0);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(RangeFromTimes(epochs[0].raw, i), epochs[0].raw.measurements[i].given_pseudorange_m,
                0.3);
  }
}

TEST(KaggleGnss, SplitsEpochsAndCountsBadRows) {
  const std::string sent = std::to_string(kReception_gps_ns - 80'000'000);
  std::string text = kDerivedHeader;
  text += DerivedRow(1'000, 1, 5, "GPS_L1", sent, 80'000'000);
  text += DerivedRow(2'000, 1, 5, "GPS_L1", sent, 80'000'000);
  text += DerivedRow(2'000, 1, 900, "GPS_L1", sent, 80'000'000);
  text += "here,Pixel4,2000,1\n\n";
  text += DerivedRow(2'000, 1, 6, "GPS_L1", sent, 80'000'000);
  auto reader = Read(text);
  const auto epochs = ReadAll(&*reader);
  ASSERT_EQ(epochs.size(), 2u);
  EXPECT_EQ(epochs[0].raw.measurements.size(), 1u);
  EXPECT_EQ(epochs[1].raw.measurements.size(), 2u);
  EXPECT_EQ(reader->report().rows_read, 3);
  EXPECT_EQ(reader->report().rows_skipped, 2);
}

TEST(KaggleGnss, RefusesAFileOfAnotherKind) {
  for (const char* text : {"a,b,c\n1,2,3\n", "", "\n\n", "time_gps_ns,latitude_deg\n"}) {
    const auto reader = Read(text);
    ASSERT_FALSE(reader.ok());
    EXPECT_EQ(reader.error().code, ErrorCode::kBadData);
    EXPECT_THAT(reader.error().message, HasSubstr("gnss.csv: the first line is not the header"));
  }
}

TEST(LostDigits, KnowsRoundedTimesFromWholeOnes) {
  for (const char* text :
       {"-1.37814834837619E+018", "1.3037709439996923e+18", "-1378148348376190000", "1.27e18"}) {
    EXPECT_TRUE(LostDigits(text)) << text;
  }
  for (const char* text : {"-1378148348376188193", "414015918240093", "414015918240000",
                           "426943928203644.0", "", "0", "x", "67624000000"}) {
    EXPECT_FALSE(LostDigits(text)) << text;
  }
}

}  // namespace
}  // namespace lodemark
