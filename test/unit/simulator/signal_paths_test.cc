#include "tools/simulator/signal_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kL1_m = 0.1903;
constexpr double kChip_m = 293.05;

Building Block(double west_m, double south_m, double east_m, double north_m, double height_m,
               FacadeKind facade) {
  Building building;
  building.footprint_m = {
      {west_m, south_m}, {east_m, south_m}, {east_m, north_m}, {west_m, north_m}};
  building.height_m = height_m;
  building.facade = facade;
  return building;
}

// A street from south to north: a tall glass wall 10 m to the east, a brick one 14 m to the west.
SignalSurroundings Street() {
  return *SignalSurroundings::Make({Block(10, -300, 30, 300, 40, FacadeKind::kGlass),
                                    Block(-30, -300, -14, 300, 20, FacadeKind::kBrick)});
}

TEST(SignalPaths, OpenSkyLetsEverythingThrough) {
  const SignalPaths paths =
      SignalSurroundings().To({0, 0, 1.5}, {1, 0, 0}, DirectionFromAngles(1.0, 0.1), kL1_m);
  EXPECT_EQ(paths.direct, 1.0);
  EXPECT_EQ(paths.reflected, 0.0);
  const ReceivedPaths received = Receive(paths, kL1_m, kChip_m);
  EXPECT_EQ(received.gain_db, 0.0);
  EXPECT_EQ(received.code_error_m, 0.0);
}

// A satellite 35 degrees high in the east: hidden by the wall there (75 degrees from 1.5 m), and
// mirrored by the one in the west, 14 m away. With the mirror image 28 m behind, the way is longer
// by 28 m times the cosine of the elevation: 22.9 m. The bounce is 14 tan 35 = 9.8 m above the
// phone, below the western roof; the ray from the east passes above the eastern roof only if that
// is lower than 1.5 + (14 + 24) tan 35 = 28 m, so the glass must not be 40 m high.
TEST(SignalPaths, ASatelliteBehindAHouseComesOffTheOneOpposite) {
  const SignalSurroundings street =
      *SignalSurroundings::Make({Block(10, -300, 30, 300, 15, FacadeKind::kGlass),
                                 Block(-30, -300, -14, 300, 20, FacadeKind::kBrick)});
  const double elevation_rad = 35.0 * kRadiansPerDegree;
  const Eigen::Vector3d direction = DirectionFromAngles(0.5 * kPi, elevation_rad);
  const SignalPaths paths = street.To({0, 0, 1.5}, {-1.5, 0, 0}, direction, kL1_m);
  EXPECT_EQ(paths.direct, 0.0);
  EXPECT_GT(paths.reflected, 0.2);
  EXPECT_NEAR(paths.extra_path_m, 28.0 * std::cos(elevation_rad), 1e-9);
  // Towards the wall the extra way shrinks by twice the step's share along the ray.
  EXPECT_NEAR(paths.extra_rate_mps, -3.0 * std::cos(elevation_rad), 1e-9);

  const ReceivedPaths received = Receive(paths, kL1_m, kChip_m);
  EXPECT_TRUE(received.is_reflection);
  EXPECT_EQ(received.code_error_m, paths.extra_path_m);
  EXPECT_EQ(received.rate_error_mps, paths.extra_rate_mps);
  EXPECT_NEAR(received.gain_db, 20.0 * std::log10(paths.reflected), 1e-12);
}

TEST(SignalPaths, BetweenTallWallsLowSatellitesAcrossAreLost) {
  const SignalPaths paths =
      Street().To({0, 0, 1.5}, Eigen::Vector3d::Zero(), DirectionFromAngles(0.5 * kPi, 0.4), kL1_m);
  EXPECT_EQ(paths.direct, 0.0);
  EXPECT_EQ(paths.reflected, 0.0);  // the ray to the western wall would have to pass the eastern
  EXPECT_LT(Receive(paths, kL1_m, kChip_m).gain_db, -29.0);
}

TEST(SignalPaths, AlongTheStreetAndOverheadTheSkyIsFree) {
  const SignalSurroundings street = Street();
  for (const double azimuth_rad : {0.0, kPi}) {
    EXPECT_EQ(
        street.To({0, 0, 1.5}, {0, 0, 0}, DirectionFromAngles(azimuth_rad, 0.2), kL1_m).direct,
        1.0);
  }
  EXPECT_EQ(street.To({0, 0, 1.5}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), kL1_m).direct, 1.0);
}

// A reflection of amplitude a, d metres late, moves the zero of a coherent early-minus-late
// discriminator with triangular correlation. Found here by bisection on that discriminator.
double DiscriminatorZero(double amplitude, double extra_m, double phase_rad, double spacing_m) {
  const auto triangle = [](double late_m) {
    return std::max(0.0, 1.0 - std::abs(late_m) / kChip_m);
  };
  const auto discriminator = [&](double late_m) {
    const double early = late_m - 0.5 * spacing_m;
    const double behind = late_m + 0.5 * spacing_m;
    return triangle(early) - triangle(behind) +
           amplitude * std::cos(phase_rad) *
               (triangle(early - extra_m) - triangle(behind - extra_m));
  };
  double low_m = -0.5 * spacing_m;
  double high_m = 0.5 * spacing_m;
  for (int i = 0; i < 60; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (discriminator(low_m) * discriminator(middle_m) <= 0.0 ? high_m : low_m) = middle_m;
  }
  return 0.5 * (low_m + high_m);
}

TEST(SignalPaths, TheCodeErrsAsACorrelatorDoes) {
  for (const double extra_m : {2.0, 10.0, 40.0, 120.0, 230.0}) {
    for (const double phase_turns : {0.0, 0.5}) {
      SignalPaths paths;
      paths.reflected = 0.3;
      // The nearest extra path at which the two carriers agree, or oppose each other.
      paths.extra_path_m = (std::round(extra_m / kL1_m) + phase_turns) * kL1_m;
      const double expected_m =
          DiscriminatorZero(0.3, paths.extra_path_m, 2.0 * kPi * phase_turns, 0.2 * kChip_m);
      const ReceivedPaths received = Receive(paths, kL1_m, kChip_m);
      EXPECT_NEAR(received.code_error_m, expected_m, 0.02) << extra_m << " " << phase_turns;
      EXPECT_FALSE(received.is_reflection);
      EXPECT_NEAR(received.gain_db, 20.0 * std::log10(phase_turns == 0.0 ? 1.3 : 0.7), 1e-9);
    }
  }
}

TEST(SignalPaths, AReflectionLaterThanAChipIsNotHeard) {
  SignalPaths paths;
  paths.reflected = 0.5;
  paths.extra_path_m = 1.2 * kChip_m;
  EXPECT_EQ(Receive(paths, kL1_m, kChip_m).code_error_m, 0.0);
  EXPECT_EQ(Receive(paths, kL1_m, kChip_m).gain_db, 0.0);
}

TEST(SignalPaths, GrazingAnEdgeCostsSixDecibel) {
  SignalPaths paths;
  paths.direct = 0.5;
  EXPECT_NEAR(Receive(paths, kL1_m, kChip_m).gain_db, -6.02, 0.01);
}

}  // namespace
}  // namespace lodemark
