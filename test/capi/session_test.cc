#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"

namespace lodemark::test {
namespace {

constexpr double kPlace[3] = {48.2, 16.37, 180.0};
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kStart_gps_ns = Constellation::kReference_gps_ns + 600 * kSecond_ns;

lodemark_session_options WithoutAtmosphere() {
  lodemark_session_options options = {};
  options.struct_size = sizeof options;
  options.ionosphere = LODEMARK_IONOSPHERE_NONE;
  options.troposphere = LODEMARK_TROPOSPHERE_NONE;
  return options;
}

class SessionTest : public testing::Test {
 protected:
  SessionTest() {
    const lodemark_session_options options = WithoutAtmosphere();
    Open(options);
  }
  ~SessionTest() override { lodemark_session_close(session_); }

  void Open(const lodemark_session_options& options) {
    lodemark_session_close(session_);
    EXPECT_EQ(lodemark_session_open(&options, &session_), LODEMARK_OK);
  }

  lodemark_status PushNavigation(lodemark_read_report* report = nullptr) {
    const std::string text = Constellation::NavigationFile();
    return lodemark_session_push_navigation(session_, "circles.rnx", text.data(), text.size(),
                                            report);
  }

  lodemark_status PushPhone(std::int64_t time_ns = 0) {
    return lodemark_session_push_gnss(session_, time_ns, &phone_.clock, phone_.measurements.data(),
                                      phone_.count());
  }

  lodemark_status Estimate() {
    estimate_ = {};
    estimate_.struct_size = sizeof estimate_;
    return lodemark_session_estimate(session_, &estimate_);
  }

  double Error_m() const {
    double error_m = 0.0;
    for (int i = 0; i < 3; ++i) {
      error_m = std::hypot(error_m, estimate_.ecef_m[i] - phone_.ecef_m()[i]);
    }
    return error_m;
  }

  std::vector<lodemark_satellite> Satellites() {
    std::int32_t count = 0;
    EXPECT_EQ(lodemark_session_satellites(session_, nullptr, 0, &count), LODEMARK_OK);
    std::vector<lodemark_satellite> satellites(static_cast<std::size_t>(count));
    if (count > 0) satellites[0].struct_size = sizeof satellites[0];
    EXPECT_EQ(lodemark_session_satellites(session_, satellites.data(), count, &count), LODEMARK_OK);
    return satellites;
  }

  lodemark_session* session_ = nullptr;
  lodemark_estimate estimate_ = {};
  StillPhone phone_{kPlace, 3000.0};
};

TEST_F(SessionTest, FixesAPhoneUnderAKnownSky) {
  lodemark_read_report report = {};
  report.struct_size = sizeof report;
  ASSERT_EQ(PushNavigation(&report), LODEMARK_OK);
  EXPECT_GE(report.rows_read, Constellation::kSatellites);
  EXPECT_EQ(report.rows_skipped, 0);
  EXPECT_STREQ(report.first_problem, "");

  phone_.Measure(kStart_gps_ns);
  ASSERT_GE(phone_.count(), 6);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_process(session_), LODEMARK_OK);
  ASSERT_EQ(Estimate(), LODEMARK_OK);
  EXPECT_EQ(estimate_.outcome, LODEMARK_OUTCOME_FIX);
  EXPECT_TRUE(estimate_.present & LODEMARK_ESTIMATE_HAS_POSITION);
  EXPECT_LT(Error_m(), 0.5);
  EXPECT_NEAR(estimate_.latitude_deg, kPlace[0], 1e-5);
  EXPECT_NEAR(estimate_.longitude_deg, kPlace[1], 1e-5);
  EXPECT_NEAR(estimate_.height_m, kPlace[2], 0.5);
  EXPECT_NEAR(estimate_.clock_bias_m, 3000.0, 0.5);
  EXPECT_EQ(estimate_.time_gps_ns, kStart_gps_ns);
  EXPECT_EQ(estimate_.time_ns, kStart_gps_ns);
  EXPECT_EQ(estimate_.sources, LODEMARK_SOURCE_GNSS);
  EXPECT_EQ(estimate_.satellites_used, phone_.count());
  EXPECT_GT(estimate_.accuracy_m, 0.0);
  EXPECT_GT(estimate_.covariance_enu_m2[8], 0.0);
  ASSERT_TRUE(estimate_.present & LODEMARK_ESTIMATE_HAS_VELOCITY);
  for (const double velocity_mps : estimate_.velocity_enu_mps) EXPECT_NEAR(velocity_mps, 0.0, 0.05);
}

TEST_F(SessionTest, TellsHowEachSatelliteFared) {
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  phone_.Measure(kStart_gps_ns);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_process(session_), LODEMARK_OK);
  const std::vector<lodemark_satellite> satellites = Satellites();
  ASSERT_EQ(satellites.size(), phone_.measurements.size());
  for (const lodemark_satellite& satellite : satellites) {
    EXPECT_EQ(satellite.system, LODEMARK_SYSTEM_GPS);
    EXPECT_EQ(satellite.verdict, LODEMARK_VERDICT_USED);
    EXPECT_STREQ(satellite.signal, "1C");
    ASSERT_TRUE(satellite.present & LODEMARK_SATELLITE_HAS_RESIDUAL);
    EXPECT_NEAR(satellite.residual_m, 0.0, 0.5);
    ASSERT_TRUE(satellite.present & LODEMARK_SATELLITE_HAS_DIRECTION);
    EXPECT_GT(satellite.elevation_deg, 9.9);
    EXPECT_LE(satellite.elevation_deg, 90.0);
    EXPECT_GE(satellite.azimuth_deg, 0.0);
    EXPECT_LT(satellite.azimuth_deg, 360.0);
    EXPECT_NEAR(satellite.cn0_dbhz, 45.0, 1e-9);
  }
}

TEST_F(SessionTest, TakesObservablesAsWell) {
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  phone_.Measure(kStart_gps_ns);
  lodemark_observation_epoch epoch = {};
  epoch.struct_size = sizeof epoch;
  epoch.time_gps_ns = kStart_gps_ns;
  std::vector<lodemark_observation> observations;
  for (std::size_t i = 0; i < phone_.measurements.size(); ++i) {
    lodemark_observation observation = {};
    observation.struct_size = sizeof observation;
    observation.present = LODEMARK_OBSERVATION_HAS_PSEUDORANGE | LODEMARK_OBSERVATION_HAS_CN0;
    observation.system = LODEMARK_SYSTEM_GPS;
    observation.satellite = phone_.measurements[i].svid;
    std::memcpy(observation.signal, "1C", 3);
    observation.pseudorange_m = phone_.pseudoranges_m[i];
    observation.cn0_dbhz = 45.0;
    observations.push_back(observation);
  }
  ASSERT_EQ(lodemark_session_push_observations(session_, 0, &epoch, observations.data(),
                                               static_cast<int>(observations.size())),
            LODEMARK_OK);
  ASSERT_EQ(lodemark_session_process(session_), LODEMARK_OK);
  ASSERT_EQ(Estimate(), LODEMARK_OK);
  EXPECT_LT(Error_m(), 0.5);
}

TEST_F(SessionTest, CountsEpochsInItsOwnTimeBase) {
  lodemark_session_options options = WithoutAtmosphere();
  options.time_base = LODEMARK_TIME_BASE_BOOT;
  Open(options);
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  phone_.Measure(kStart_gps_ns);
  ASSERT_EQ(PushPhone(123'456'789), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_process(session_), LODEMARK_OK);
  ASSERT_EQ(Estimate(), LODEMARK_OK);
  EXPECT_EQ(estimate_.time_ns, 123'456'789);
  EXPECT_EQ(estimate_.time_gps_ns, kStart_gps_ns);
}

TEST_F(SessionTest, SaysThatNothingWaits) {
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NOTHING_QUEUED);
  EXPECT_EQ(Estimate(), LODEMARK_NO_POSITION);
  EXPECT_EQ(estimate_.outcome, LODEMARK_OUTCOME_NO_DATA);
  EXPECT_EQ(estimate_.present, 0u);
}

TEST_F(SessionTest, SaysThatNoSatelliteHasAnOrbit) {
  phone_.Measure(kStart_gps_ns);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NO_POSITION);
  EXPECT_EQ(Estimate(), LODEMARK_NO_POSITION);
  EXPECT_EQ(estimate_.outcome, LODEMARK_OUTCOME_NO_EPHEMERIS);
  EXPECT_FALSE(estimate_.present & LODEMARK_ESTIMATE_HAS_POSITION);
  EXPECT_EQ(estimate_.ecef_m[0], 0.0);
  for (const lodemark_satellite& satellite : Satellites()) {
    EXPECT_EQ(satellite.verdict, LODEMARK_VERDICT_NO_EPHEMERIS);
  }
}

TEST_F(SessionTest, SaysThatThreeSatellitesAreTooFew) {
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  phone_.Measure(kStart_gps_ns);
  phone_.measurements.resize(3);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NO_POSITION);
  EXPECT_EQ(Estimate(), LODEMARK_NO_POSITION);
  EXPECT_EQ(estimate_.outcome, LODEMARK_OUTCOME_TOO_FEW);
}

TEST_F(SessionTest, StatesProtectionLevelsOnlyWhereAFaultWouldBeSeen) {
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  constexpr std::uint32_t kLevels =
      LODEMARK_ESTIMATE_HAS_PROTECTION_LEVEL | LODEMARK_ESTIMATE_HAS_VERTICAL_PROTECTION_LEVEL;
  phone_.Measure(kStart_gps_ns);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_process(session_), LODEMARK_OK);
  ASSERT_EQ(Estimate(), LODEMARK_OK);
  EXPECT_EQ(estimate_.present & kLevels, kLevels);

  phone_.Measure(kStart_gps_ns + 1'000'000'000);
  phone_.measurements.resize(4);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_process(session_), LODEMARK_OK);
  ASSERT_EQ(Estimate(), LODEMARK_OK);
  EXPECT_EQ(estimate_.present & kLevels, 0u);
  EXPECT_EQ(estimate_.protection_level_m, 0.0);
  EXPECT_EQ(estimate_.vertical_protection_level_m, 0.0);
}

TEST_F(SessionTest, AsksToProcessWhenTheQueueIsFull) {
  lodemark_session_options options = WithoutAtmosphere();
  options.queue_capacity = 2;
  Open(options);
  for (int i = 0; i < 2; ++i) {
    phone_.Measure(kStart_gps_ns + i * kSecond_ns);
    ASSERT_EQ(PushPhone(), LODEMARK_OK);
  }
  std::int32_t count = 0;
  ASSERT_EQ(lodemark_session_queued(session_, &count), LODEMARK_OK);
  EXPECT_EQ(count, 2);
  phone_.Measure(kStart_gps_ns + 2 * kSecond_ns);
  EXPECT_EQ(PushPhone(), LODEMARK_ERROR_QUEUE_FULL);
  EXPECT_GE(lodemark_session_process(session_), 0);
  EXPECT_EQ(PushPhone(), LODEMARK_OK);
}

TEST_F(SessionTest, ReportsItsFirstFixUntilEventsAreCleared) {
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  phone_.Measure(kStart_gps_ns);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_process(session_), LODEMARK_OK);
  std::vector<lodemark_event> events(8);
  events[0].struct_size = sizeof events[0];
  std::int32_t count = 0;
  ASSERT_EQ(lodemark_session_events(session_, events.data(), 8, &count), LODEMARK_OK);
  bool first_fix = false;
  for (int i = 0; i < count && i < 8; ++i) {
    first_fix = first_fix || events[static_cast<std::size_t>(i)].kind == LODEMARK_EVENT_FIRST_FIX;
    EXPECT_NE(events[static_cast<std::size_t>(i)].text[0], '\0');
  }
  EXPECT_TRUE(first_fix);
  ASSERT_EQ(lodemark_session_clear_events(session_), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_events(session_, nullptr, 0, &count), LODEMARK_OK);
  EXPECT_EQ(count, 0);
}

TEST_F(SessionTest, KeepsOrbitsWhenReset) {
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  phone_.Measure(kStart_gps_ns);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_reset(session_), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NOTHING_QUEUED);
  ASSERT_EQ(PushPhone(), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_OK);
}

TEST_F(SessionTest, CountsMalformedNavigationRows) {
  std::string text = Constellation::NavigationFile();
  const std::size_t fifth = text.find("G05");
  text.replace(fifth, 3, "G99");
  lodemark_read_report report = {};
  report.struct_size = sizeof report;
  ASSERT_EQ(
      lodemark_session_push_navigation(session_, "bad.rnx", text.data(), text.size(), &report),
      LODEMARK_OK);
  EXPECT_EQ(report.rows_skipped, 1);
  EXPECT_EQ(std::strncmp(report.first_problem, "bad.rnx:", 8), 0) << report.first_problem;
}

TEST_F(SessionTest, RefusesATextThatIsNoNavigationFile) {
  const char text[] = "Dear diary,\n";
  EXPECT_EQ(lodemark_session_push_navigation(session_, "diary.txt", text, sizeof text - 1, nullptr),
            LODEMARK_ERROR_BAD_DATA);
  EXPECT_NE(std::strstr(lodemark_last_error(), "diary.txt"), nullptr) << lodemark_last_error();
  EXPECT_EQ(lodemark_session_push_navigation(session_, nullptr, text, 0, nullptr),
            LODEMARK_ERROR_BAD_DATA);
  EXPECT_EQ(
      lodemark_session_push_precise_orbits(session_, "diary.txt", text, sizeof text - 1, nullptr),
      LODEMARK_ERROR_BAD_DATA);
  EXPECT_NE(std::strstr(lodemark_last_error(), "diary.txt"), nullptr) << lodemark_last_error();
}

TEST_F(SessionTest, TwoSessionsDoNotKnowEachOther) {
  lodemark_session* other = nullptr;
  ASSERT_EQ(lodemark_session_open(nullptr, &other), LODEMARK_OK);
  ASSERT_EQ(PushNavigation(), LODEMARK_OK);
  phone_.Measure(kStart_gps_ns);
  ASSERT_EQ(lodemark_session_push_gnss(other, 0, &phone_.clock, phone_.measurements.data(),
                                       phone_.count()),
            LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NOTHING_QUEUED);
  EXPECT_EQ(lodemark_session_process(other), LODEMARK_NO_POSITION);
  lodemark_session_close(other);
}

}  // namespace
}  // namespace lodemark::test
