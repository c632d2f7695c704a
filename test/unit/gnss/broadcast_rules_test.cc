#include "core/gnss/broadcast_rules.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/units.h"

namespace lodemark {
namespace {

TEST(UserRangeAccuracy, HasTheNominalValuesOfTheIcd) {
  // IS-GPS-200N 20.3.3.3.1.3.
  constexpr double kNominal_m[] = {2.0,  2.8,   4.0,   5.7,   8.0,    11.3,   16.0,  32.0,
                                   64.0, 128.0, 256.0, 512.0, 1024.0, 2048.0, 4096.0};
  for (int index = 0; index < 15; ++index) {
    EXPECT_DOUBLE_EQ(UserRangeAccuracy(index).value(), kNominal_m[index]);
  }
  EXPECT_FALSE(UserRangeAccuracy(15).has_value());
  EXPECT_FALSE(UserRangeAccuracy(-16).has_value());
  EXPECT_DOUBLE_EQ(UserRangeAccuracy(-2).value(), 1.0);
}

TEST(GalileoSignalAccuracy, HasTheStepsOfTheIcd) {
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(0).value(), 0.0);
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(49).value(), 0.49);
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(50).value(), 0.50);
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(74).value(), 0.98);
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(75).value(), 1.00);
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(99).value(), 1.96);
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(100).value(), 2.00);
  EXPECT_DOUBLE_EQ(GalileoSignalAccuracy(125).value(), 6.00);
  EXPECT_FALSE(GalileoSignalAccuracy(126).has_value());
  EXPECT_FALSE(GalileoSignalAccuracy(255).has_value());
}

TEST(GlonassAccuracy, EndsAtFifteen) {
  EXPECT_EQ(GlonassAccuracy(2), 2.5);
  EXPECT_EQ(GlonassAccuracy(14), 512.0);
  EXPECT_FALSE(GlonassAccuracy(15).has_value());
  EXPECT_FALSE(GlonassAccuracy(-1).has_value());
}

TEST(IsBeidouGeostationary, HoldsForBothRangesOfNumbers) {
  EXPECT_TRUE(IsBeidouGeostationary({System::kBeidou, 5}));
  EXPECT_FALSE(IsBeidouGeostationary({System::kBeidou, 6}));
  EXPECT_FALSE(IsBeidouGeostationary({System::kBeidou, 58}));
  EXPECT_TRUE(IsBeidouGeostationary({System::kBeidou, 59}));
  EXPECT_FALSE(IsBeidouGeostationary({System::kGps, 5}));
}

TEST(GpsFitInterval, FollowsTheTableOfIssues) {
  EXPECT_EQ(GpsFitInterval(false, 245), 4 * 3600.0);
  EXPECT_EQ(GpsFitInterval(true, 5), 6 * 3600.0);
  EXPECT_EQ(GpsFitInterval(true, 247), 8 * 3600.0);
  EXPECT_EQ(GpsFitInterval(true, 496), 14 * 3600.0);
  EXPECT_EQ(GpsFitInterval(true, 1022), 26 * 3600.0);
}

TEST(IsHealthy, ReadsEachMessagesOwnBits) {
  EXPECT_TRUE(IsHealthy(System::kGps, MessageType::kCnav, 1));   // L5 alone
  EXPECT_FALSE(IsHealthy(System::kGps, MessageType::kCnav, 4));  // L1
  EXPECT_FALSE(IsHealthy(System::kGps, MessageType::kCnav2, 1));
  EXPECT_TRUE(IsHealthy(System::kQzss, MessageType::kLnav, 0x10));   // sends L1C/B
  EXPECT_FALSE(IsHealthy(System::kQzss, MessageType::kLnav, 0x11));  // sends neither
  EXPECT_FALSE(IsHealthy(System::kSbas, MessageType::kSbas, 0x20));
  EXPECT_FALSE(IsHealthy(System::kGlonass, MessageType::kFdma, 1));
}

KeplerEphemeris PlausibleGps() {
  KeplerEphemeris e;
  e.semi_major_axis_m = 26.56e6;
  e.eccentricity = 0.01;
  e.inclination_rad = 0.97;
  return e;
}

TEST(ImplausibleElement, NamesTheOneThatCannotBe) {
  EXPECT_EQ(ImplausibleElement(PlausibleGps()), "");
  KeplerEphemeris e = PlausibleGps();
  e.semi_major_axis_m = 42e6;
  EXPECT_EQ(ImplausibleElement(e), "semi-major axis");
  e.satellite.system = System::kQzss;
  EXPECT_EQ(ImplausibleElement(e), "");
  e = PlausibleGps();
  e.toe_gps_ns = 2 * kDay_ns;
  EXPECT_EQ(ImplausibleElement(e), "time of ephemeris");
}

TEST(ImplausibleElement, LetsGalileosEccentricPairThrough) {
  KeplerEphemeris e = PlausibleGps();
  e.satellite = {System::kGalileo, 18};
  e.semi_major_axis_m = 27.98e6;
  e.eccentricity = 0.162;
  EXPECT_EQ(ImplausibleElement(e), "");
}

TEST(ImplausibleElement, FindsWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  double KeplerEphemeris::* const fields[] = {&KeplerEphemeris::clock_bias_s,
                                              &KeplerEphemeris::clock_drift_sps,
                                              &KeplerEphemeris::clock_drift_rate_sps2,
                                              &KeplerEphemeris::semi_major_axis_m,
                                              &KeplerEphemeris::semi_major_axis_rate_mps,
                                              &KeplerEphemeris::eccentricity,
                                              &KeplerEphemeris::mean_anomaly_rad,
                                              &KeplerEphemeris::mean_motion_difference_radps,
                                              &KeplerEphemeris::mean_motion_difference_rate_radps2,
                                              &KeplerEphemeris::argument_of_perigee_rad,
                                              &KeplerEphemeris::inclination_rad,
                                              &KeplerEphemeris::inclination_rate_radps,
                                              &KeplerEphemeris::ascending_node_rad,
                                              &KeplerEphemeris::ascending_node_rate_radps,
                                              &KeplerEphemeris::cuc_rad,
                                              &KeplerEphemeris::cus_rad,
                                              &KeplerEphemeris::cic_rad,
                                              &KeplerEphemeris::cis_rad,
                                              &KeplerEphemeris::crc_m,
                                              &KeplerEphemeris::crs_m};
  for (double KeplerEphemeris::* const field : fields) {
    KeplerEphemeris e = PlausibleGps();
    e.*field = kNan;
    EXPECT_NE(ImplausibleElement(e), "");
  }
  StateEphemeris state;
  state.satellite.system = System::kGlonass;
  state.position_in_ecef = {25.5e6, 0, 0};
  EXPECT_EQ(ImplausibleElement(state), "");
  state.velocity_in_ecef.x() = kNan;
  EXPECT_EQ(ImplausibleElement(state), "velocity");
}

}  // namespace
}  // namespace lodemark
