#include "core/gnss/group_delay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lodemark {
namespace {

constexpr SatelliteId kGps = {System::kGps, 5};
constexpr SatelliteId kGalileo = {System::kGalileo, 11};
constexpr SatelliteId kBeidou = {System::kBeidou, 25};
constexpr SatelliteId kNavic = {System::kNavic, 2};
constexpr double kL1_hz = 1575.42e6;
constexpr double kL2_hz = 1227.60e6;
constexpr double kL5_hz = 1176.45e6;
constexpr double kE5b_hz = 1207.14e6;
constexpr double kB1i_hz = 1561.098e6;
constexpr double kB3i_hz = 1268.52e6;

// The ionosphere-free combination of two signals' clocks.
double Combine(double first_s, double first_hz, double second_s, double second_hz) {
  const double a = first_hz * first_hz;
  const double b = second_hz * second_hz;
  return (a * first_s - b * second_s) / (a - b);
}

double Broadcast(SatelliteId satellite, SignalCode signal, MessageType type,
                 const GroupDelays& delays) {
  return GroupDelayCorrection(satellite, signal, ClockSource::kBroadcast, type, delays);
}

double Precise(SatelliteId satellite, SignalCode signal, const GroupDelays& delays) {
  return GroupDelayCorrection(satellite, signal, ClockSource::kPrecise, MessageType::kLnav, delays);
}

// A clock that refers to a combination must come out unchanged when the two signals of the
// combination are combined.
TEST(GroupDelay, LeavesTheCombinationAClockRefersTo) {
  GroupDelays d;
  d.tgd_s = -1.1e-8;
  d.bgd_e5a_e1_s = 3.2e-9;
  d.bgd_e5b_e1_s = -4.1e-9;
  d.tgd1_s = 8.3e-9;
  d.tgd2_s = -2.2e-9;
  constexpr double kTolerance_s = 1e-20;
  using enum MessageType;
  EXPECT_NEAR(Combine(Broadcast(kGps, {'1', 'W'}, kLnav, d), kL1_hz,
                      Broadcast(kGps, {'2', 'W'}, kLnav, d), kL2_hz),
              0.0, kTolerance_s);
  EXPECT_NEAR(Combine(Broadcast(kGalileo, {'1', 'C'}, kFnav, d), kL1_hz,
                      Broadcast(kGalileo, {'5', 'Q'}, kFnav, d), kL5_hz),
              0.0, kTolerance_s);
  EXPECT_NEAR(Combine(Broadcast(kGalileo, {'1', 'C'}, kInav, d), kL1_hz,
                      Broadcast(kGalileo, {'7', 'Q'}, kInav, d), kE5b_hz),
              0.0, kTolerance_s);
  EXPECT_NEAR(Combine(Broadcast(kNavic, {'9', 'A'}, kLnav, d), 2492.028e6,
                      Broadcast(kNavic, {'5', 'A'}, kLnav, d), kL5_hz),
              0.0, kTolerance_s);
  EXPECT_NEAR(
      Combine(Precise(kGalileo, {'1', 'C'}, d), kL1_hz, Precise(kGalileo, {'5', 'Q'}, d), kL5_hz),
      0.0, kTolerance_s);
  EXPECT_NEAR(
      Combine(Precise(kBeidou, {'2', 'I'}, d), kB1i_hz, Precise(kBeidou, {'6', 'I'}, d), kB3i_hz),
      0.0, kTolerance_s);
  EXPECT_NEAR(Combine(GlonassDelayCorrection({'1', 'C'}, ClockSource::kPrecise, 5e-9), 9.0,
                      GlonassDelayCorrection({'2', 'C'}, ClockSource::kPrecise, 5e-9), 7.0),
              0.0, kTolerance_s);
}

// Whichever message and signal: the difference of two Galileo signals is the satellite's own.
TEST(GroupDelay, GalileoSignalsDifferAlikeUnderEitherClock) {
  GroupDelays d;
  d.bgd_e5a_e1_s = 3.2e-9;
  d.bgd_e5b_e1_s = -4.1e-9;
  for (const char band : {'5', '7', '8', '6'}) {
    const auto difference = [&](MessageType type) {
      return Broadcast(kGalileo, {band, 'Q'}, type, d) - Broadcast(kGalileo, {'1', 'C'}, type, d);
    };
    EXPECT_NEAR(difference(MessageType::kInav), difference(MessageType::kFnav), 1e-21);
  }
  // OS SIS ICD 2.1 5.1.5: single frequency E1 and E5a from F/NAV.
  EXPECT_DOUBLE_EQ(Broadcast(kGalileo, {'1', 'C'}, MessageType::kFnav, d), -3.2e-9);
  EXPECT_NEAR(Broadcast(kGalileo, {'5', 'Q'}, MessageType::kFnav, d),
              -std::pow(kL1_hz / kL5_hz, 2) * 3.2e-9, 1e-22);
}

TEST(GroupDelay, FollowsTheGpsRules) {
  GroupDelays d;
  d.tgd_s = -1.1e-8;
  using enum MessageType;
  EXPECT_DOUBLE_EQ(Broadcast(kGps, {'1', 'C'}, kLnav, d), 1.1e-8);
  EXPECT_NEAR(Broadcast(kGps, {'2', 'L'}, kLnav, d), std::pow(77.0 / 60.0, 2) * 1.1e-8, 1e-22);
  d.isc_l1ca_s = 1e-9;
  d.isc_l2c_s = 2e-9;
  d.isc_l5i5_s = 3e-9;
  d.isc_l5q5_s = 4e-9;
  d.isc_l1cd_s = 5e-9;
  d.isc_l1cp_s = 6e-9;
  struct Case {
    SignalCode signal;
    double expected_s;
  };
  for (const Case& c : {Case{{'1', 'C'}, 12e-9}, Case{{'1', ' '}, 12e-9}, Case{{'1', 'W'}, 11e-9},
                        Case{{'1', 'S'}, 16e-9}, Case{{'1', 'L'}, 17e-9}, Case{{'1', 'X'}, 17e-9},
                        Case{{'2', 'L'}, 13e-9}, Case{{'2', 'X'}, 13e-9}, Case{{'5', 'I'}, 14e-9},
                        Case{{'5', 'Q'}, 15e-9}, Case{{'5', 'X'}, 15e-9}}) {
    EXPECT_NEAR(Broadcast(kGps, c.signal, kCnav, d), c.expected_s, 1e-20)
        << c.signal.band << c.signal.attribute;
    EXPECT_DOUBLE_EQ(Precise(kGps, c.signal, d), Broadcast(kGps, c.signal, kLnav, d));
    EXPECT_DOUBLE_EQ(Broadcast({System::kQzss, 2}, c.signal, kCnav, d),
                     Broadcast(kGps, c.signal, kCnav, d));
  }
}

TEST(GroupDelay, FollowsTheBeidouRules) {
  GroupDelays d;
  d.tgd1_s = 8.3e-9;
  d.tgd2_s = -2.2e-9;
  using enum MessageType;
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'2', 'I'}, kD1, d), -8.3e-9);
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'7', 'I'}, kD1, d), 2.2e-9);
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'6', 'I'}, kD1, d), 0.0);
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'1', 'P'}, kD1, d), -8.3e-9);
  d.tgd_b1cp_s = 1e-9;
  d.tgd_b2ap_s = 2e-9;
  d.tgd_b2bi_s = 3e-9;
  d.isc_b1cd_s = 4e-10;
  d.isc_b2ad_s = 5e-10;
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'1', 'P'}, kCnav1, d), -1e-9);
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'1', 'D'}, kCnav1, d), -1.4e-9);
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'5', 'P'}, kCnav2Beidou, d), -2e-9);
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'5', 'D'}, kCnav2Beidou, d), -2.5e-9);
  EXPECT_DOUBLE_EQ(Broadcast(kBeidou, {'7', 'D'}, kCnav3, d), -3e-9);
}

TEST(GroupDelay, GlonassL2IsLateByDeltaTau) {
  EXPECT_DOUBLE_EQ(GlonassDelayCorrection({'1', 'C'}, ClockSource::kBroadcast, 5e-9), 0.0);
  EXPECT_DOUBLE_EQ(GlonassDelayCorrection({'2', 'C'}, ClockSource::kBroadcast, 5e-9), -5e-9);
}

TEST(GroupDelay, IsNothingWhereNothingIsKnown) {
  for (int system = 0; system < kSystemCount; ++system) {
    for (const char band : {'1', '2', '5', '7', '9'}) {
      const SatelliteId satellite = {static_cast<System>(system), 1};
      EXPECT_EQ(Broadcast(satellite, {band, ' '}, MessageType::kLnav, {}), 0.0);
      EXPECT_EQ(Precise(satellite, {band, ' '}, {}), 0.0);
    }
  }
}

TEST(GroupDelay, UpdatesOnlyWithWhatCanBeADelay) {
  GroupDelays known;
  known.tgd_s = 1e-9;
  known.tgd2_s = 2e-9;
  GroupDelays newer;
  newer.tgd_s = 3e-9;
  newer.tgd1_s = std::numeric_limits<double>::quiet_NaN();
  newer.tgd2_s = 1.0;
  newer.isc_b2ad_s = -4e-9;
  UpdateGroupDelays(newer, &known);
  EXPECT_EQ(known.tgd_s, 3e-9);
  EXPECT_FALSE(known.tgd1_s.has_value());
  EXPECT_EQ(known.tgd2_s, 2e-9);
  EXPECT_EQ(known.isc_b2ad_s, -4e-9);
}

}  // namespace
}  // namespace lodemark
