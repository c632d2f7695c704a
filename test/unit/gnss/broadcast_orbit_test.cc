#include "core/gnss/broadcast_orbit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "test/unit/gnss/orbit_scene.h"

namespace lodemark {
namespace {

constexpr double kEarthRotation_radps = 7.2921151467e-5;

// One set of every kind the equations treat differently.
std::vector<KeplerEphemeris> EveryKind() {
  KeplerEphemeris geostationary = FullSet({System::kBeidou, 3}, MessageType::kD2);
  geostationary.inclination_rad = 0.06;
  geostationary.eccentricity = 3e-4;
  KeplerEphemeris eccentric = FullSet({System::kGalileo, 14}, MessageType::kInav);
  eccentric.eccentricity = 0.16;
  return {FullSet({System::kGps, 5}, MessageType::kLnav),
          FullSet({System::kGps, 5}, MessageType::kCnav),
          FullSet({System::kGalileo, 11}, MessageType::kFnav),
          FullSet({System::kBeidou, 25}, MessageType::kD1),
          FullSet({System::kBeidou, 25}, MessageType::kCnav1),
          geostationary,
          eccentric,
          FullSet({System::kQzss, 2}, MessageType::kLnav),
          FullSet({System::kNavic, 9}, MessageType::kLnav)};
}

Eigen::Vector3d InertialVelocity(const BroadcastState& state, double rotation_radps) {
  const Eigen::Vector3d axis(0.0, 0.0, rotation_radps);
  return state.velocity_in_ecef + axis.cross(state.position_in_ecef);
}

TEST(KeplerState, VelocityIsTheDerivativeOfPosition) {
  constexpr double kStep_s = 1.0;
  for (const KeplerEphemeris& set : EveryKind()) {
    for (const int minutes : {-118, -37, 0, 1, 64, 120}) {
      const std::int64_t time_ns = set.toe_gps_ns + minutes * 60 * kSecond_ns;
      const BroadcastState before = KeplerState(set, time_ns, -kStep_s);
      const BroadcastState after = KeplerState(set, time_ns, kStep_s);
      const BroadcastState state = KeplerState(set, time_ns, 0.0);
      const Eigen::Vector3d difference =
          (after.position_in_ecef - before.position_in_ecef) / (2.0 * kStep_s);
      // Central differences leave jerk / 6, some 2e-5 m/s, and rounding of the same size below.
      EXPECT_LT((difference - state.velocity_in_ecef).norm(), 4e-5)
          << SatelliteName(set.satellite) << " at " << minutes;
      EXPECT_NEAR((after.clock_bias_s - before.clock_bias_s) / (2.0 * kStep_s),
                  state.clock_drift_sps, 1e-17);
    }
  }
}

TEST(KeplerState, ConservesEnergyAndAngularMomentumOfAPlainOrbit) {
  struct Case {
    SatelliteId satellite;
    MessageType type;
    double gm_m3ps2;
    double rotation_radps;
  };
  for (const Case& c :
       {Case{{System::kGps, 1}, MessageType::kLnav, 3.986005e14, kEarthRotation_radps},
        Case{{System::kGalileo, 1}, MessageType::kInav, 3.986004418e14, kEarthRotation_radps},
        Case{{System::kBeidou, 30}, MessageType::kD1, 3.986004418e14, 7.292115e-5},
        Case{{System::kBeidou, 60}, MessageType::kD2, 3.986004418e14, 7.292115e-5}}) {
    KeplerEphemeris set = PlainSet(c.satellite, c.type);
    set.eccentricity = 0.3;
    const double energy = -0.5 * c.gm_m3ps2 / set.semi_major_axis_m;
    const double momentum =
        std::sqrt(c.gm_m3ps2 * set.semi_major_axis_m * (1.0 - set.eccentricity * set.eccentricity));
    for (int hours = -6; hours <= 6; ++hours) {
      const std::int64_t time_ns = set.toe_gps_ns + hours * 3600 * kSecond_ns;
      const BroadcastState state = KeplerState(set, time_ns, 0.25);
      const Eigen::Vector3d velocity = InertialVelocity(state, c.rotation_radps);
      EXPECT_NEAR(0.5 * velocity.squaredNorm() - c.gm_m3ps2 / state.position_in_ecef.norm(), energy,
                  1e-11 * std::abs(energy))
          << SatelliteName(set.satellite);
      EXPECT_NEAR(state.position_in_ecef.cross(velocity).norm(), momentum, 1e-11 * momentum);
    }
  }
}

TEST(KeplerState, StartsWhereTheElementsSay) {
  KeplerEphemeris set = PlainSet({System::kGps, 1}, MessageType::kLnav);
  set.mean_anomaly_rad = 0.0;
  set.argument_of_perigee_rad = 0.0;
  const BroadcastState state = KeplerState(set, set.toe_gps_ns, 0.0);
  // At perigee on the ascending node, whose longitude has turned with the earth since the week
  // began.
  const double node_rad = set.ascending_node_rad - kEarthRotation_radps * 295'200.0;
  const double radius_m = set.semi_major_axis_m * (1.0 - set.eccentricity);
  EXPECT_NEAR(state.position_in_ecef.x(), radius_m * std::cos(node_rad), 1e-6);
  EXPECT_NEAR(state.position_in_ecef.y(), radius_m * std::sin(node_rad), 1e-6);
  EXPECT_NEAR(state.position_in_ecef.z(), 0.0, 1e-6);
}

TEST(KeplerState, CountsBeidouWeeksInBeidouTime) {
  KeplerEphemeris set = PlainSet({System::kBeidou, 30}, MessageType::kD1);
  set.toe_gps_ns = 2'300 * kWeek_ns + 14 * kSecond_ns;  // the BeiDou week begins
  set.mean_anomaly_rad = 0.0;
  set.argument_of_perigee_rad = 0.0;
  const BroadcastState state = KeplerState(set, set.toe_gps_ns, 0.0);
  EXPECT_NEAR(std::atan2(state.position_in_ecef.y(), state.position_in_ecef.x()),
              set.ascending_node_rad, 1e-12);
}

// The frame of geostationary sets is the earth-fixed one of toe, turned by 5 degrees about x.
TEST(KeplerState, TiltsOnlyGeostationaryBeidouSets) {
  KeplerEphemeris flat = PlainSet({System::kBeidou, 59}, MessageType::kD2);
  flat.inclination_rad = 0.0;
  flat.eccentricity = 0.0;
  const BroadcastState tilted = KeplerState(flat, flat.toe_gps_ns, 0.0);
  flat.satellite.number = 58;
  const BroadcastState level = KeplerState(flat, flat.toe_gps_ns, 0.0);
  const Eigen::Vector3d expected =
      Eigen::AngleAxisd(5.0 * kRadiansPerDegree, Eigen::Vector3d::UnitX()) * level.position_in_ecef;
  EXPECT_LT((tilted.position_in_ecef - expected).norm(), 1e-6);
  EXPECT_NEAR(level.position_in_ecef.z(), 0.0, 1e-6);
}

TEST(KeplerState, RelativityIsMinusTwoRVOverCSquared) {
  for (const KeplerEphemeris& plain : {PlainSet({System::kGps, 1}, MessageType::kLnav),
                                       PlainSet({System::kGalileo, 14}, MessageType::kInav)}) {
    for (const int minutes : {-90, 0, 45}) {
      const std::int64_t time_ns = plain.toe_gps_ns + minutes * 60 * kSecond_ns;
      const BroadcastState state = KeplerState(plain, time_ns, 0.0);
      const double expected_s = -2.0 * state.position_in_ecef.dot(state.velocity_in_ecef) /
                                (kSpeedOfLight_mps * kSpeedOfLight_mps);
      EXPECT_NEAR(state.clock_bias_s, expected_s, 1e-18);
    }
  }
}

TEST(KeplerState, SolvesKeplersEquationUpToTheLargestEccentricity) {
  KeplerEphemeris set = PlainSet({System::kGalileo, 1}, MessageType::kInav);
  set.inclination_rad = 0.0;
  set.argument_of_perigee_rad = 0.0;
  for (const double eccentricity : {0.0, 1e-9, 0.02, 0.16, 0.5}) {
    set.eccentricity = eccentricity;
    for (double mean_rad = -6.2; mean_rad < 6.3; mean_rad += 0.1) {
      set.mean_anomaly_rad = mean_rad;
      const BroadcastState state = KeplerState(set, set.toe_gps_ns, 0.0);
      // Radius and relativistic term give the eccentric anomaly, and so the mean one, back.
      const double cosine =
          (1.0 - state.position_in_ecef.norm() / set.semi_major_axis_m) / (eccentricity + 1e-300);
      const double scale = -2.0 * std::sqrt(3.986004418e14 * set.semi_major_axis_m) /
                           (kSpeedOfLight_mps * kSpeedOfLight_mps);
      const double product = state.clock_bias_s / scale;  // e sin E
      if (eccentricity < 0.01) continue;
      const double anomaly_rad = std::atan2(product / eccentricity, cosine);
      EXPECT_NEAR(std::remainder(anomaly_rad - product - mean_rad, 2.0 * kPi), 0.0, 1e-12);
    }
  }
}

TEST(KeplerState, TakesFractionsAsPartOfTheTime) {
  const KeplerEphemeris set = FullSet({System::kGps, 5}, MessageType::kLnav);
  const BroadcastState whole = KeplerState(set, set.toe_gps_ns + 1'500'000'000, 0.0);
  const BroadcastState split = KeplerState(set, set.toe_gps_ns + 1'000'000'000, 0.5);
  EXPECT_LT((whole.position_in_ecef - split.position_in_ecef).norm(), 1e-7);
  EXPECT_NEAR(whole.clock_bias_s, split.clock_bias_s, 1e-20);
}

TEST(KeplerState, StaysFiniteFarFromItsTime) {
  const KeplerEphemeris set = FullSet({System::kGps, 5}, MessageType::kCnav);
  for (const std::int64_t time_ns : {std::int64_t{0}, std::int64_t{4'600'000'000'000'000'000}}) {
    EXPECT_TRUE(KeplerState(set, time_ns, 0.0).position_in_ecef.allFinite());
  }
}

TEST(StateOrbit, VelocityIsTheDerivativeOfPosition) {
  constexpr double kStep_s = 1.0;
  StateEphemeris geostationary = GlonassSet(3);
  geostationary.satellite = {System::kSbas, 23};
  geostationary.type = MessageType::kSbas;
  for (const StateEphemeris& set : {GlonassSet(3), geostationary}) {
    const StateOrbit orbit(set);
    // The last lies half a step beside a change of node.
    for (const int seconds : {-1'790, -433, 0, 120, 1'799, 60}) {
      const std::int64_t time_ns = set.toe_gps_ns + seconds * kSecond_ns;
      const Eigen::Vector3d difference = (orbit.At(time_ns, kStep_s).position_in_ecef -
                                          orbit.At(time_ns, -kStep_s).position_in_ecef) /
                                         (2.0 * kStep_s);
      EXPECT_LT((difference - orbit.At(time_ns, 0.0).velocity_in_ecef).norm(), 2e-5) << seconds;
    }
  }
}

// Without sun and moon the energy in the field of an oblate earth is conserved.
TEST(StateOrbit, ConservesEnergyInTheOblateField) {
  StateEphemeris set = GlonassSet(3);
  set.acceleration_in_ecef.setZero();
  const StateOrbit orbit(set);
  const auto energy = [&](std::int64_t time_ns) {
    const BroadcastState state = orbit.At(time_ns, 0.0);
    const double radius_m = state.position_in_ecef.norm();
    const double sine = state.position_in_ecef.z() / radius_m;
    const double j2_term =
        1'082'625.75e-9 * std::pow(6'378'136.0 / radius_m, 2) * (1.0 - 3.0 * sine * sine) / 2.0;
    return 0.5 * InertialVelocity(state, 7.292115e-5).squaredNorm() -
           398'600.44e9 / radius_m * (1.0 + j2_term);
  };
  const double start = energy(set.toe_gps_ns);
  for (int minutes = -31; minutes <= 31; ++minutes) {
    EXPECT_NEAR(energy(set.toe_gps_ns + minutes * 60 * kSecond_ns), start, 1e-10 * std::abs(start));
  }
}

TEST(StateOrbit, ReturnsToItsStart) {
  const StateEphemeris set = GlonassSet(3);
  const BroadcastState end = StateOrbit(set).At(set.toe_gps_ns, 1'800.0);
  StateEphemeris back = set;
  back.toe_gps_ns += 1'800 * kSecond_ns;
  back.position_in_ecef = end.position_in_ecef;
  back.velocity_in_ecef = end.velocity_in_ecef;
  const BroadcastState start = StateOrbit(back).At(set.toe_gps_ns, 0.0);
  EXPECT_LT((start.position_in_ecef - set.position_in_ecef).norm(), 1e-4);
  EXPECT_LT((start.velocity_in_ecef - set.velocity_in_ecef).norm(), 1e-7);
}

TEST(StateOrbit, StopsAtItsReach) {
  const StateEphemeris set = GlonassSet(3);
  const StateOrbit orbit(set);
  const BroadcastState end = orbit.At(set.toe_gps_ns + StateOrbit::kReach_ns, 0.0);
  const BroadcastState beyond = orbit.At(set.toe_gps_ns + kDay_ns, 0.0);
  EXPECT_EQ(end.position_in_ecef, beyond.position_in_ecef);
}

TEST(StateOrbit, ClockRunsByItsFrequencyBias) {
  const StateEphemeris set = GlonassSet(3);
  const BroadcastState state = StateOrbit(set).At(set.toe_gps_ns, 100.0);
  EXPECT_DOUBLE_EQ(state.clock_bias_s, set.clock_bias_s + 100.0 * set.frequency_bias);
  EXPECT_DOUBLE_EQ(StateOrbit(set).ClockBias(set.toe_gps_ns, 100.0), state.clock_bias_s);
}

}  // namespace
}  // namespace lodemark
