#include "core/session/phase_changes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <vector>

#include "core/base/units.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

constexpr int kSatellites = 9;
constexpr std::int64_t kStart_ns = 1'400'000'000 * kSecond_ns;

const Geodetic kPlace = {0.84, 0.2, 250.0};
const Eigen::Vector3d kVelocity_enu_mps(6.0, -3.0, 2.0);  // 7 m/s

Eigen::Vector3d ReceiverAt(double seconds) {
  return EcefFromGeodetic(kPlace) +
         EnuFromEcefRotation(kPlace).transpose() * kVelocity_enu_mps * seconds;
}

// Satellites 22 000 km away pass by at 3 km/s; the receiver's clock is off and drifts.
std::vector<TrackedPhase> PhasesAt(double seconds) {
  std::vector<TrackedPhase> phases;
  for (int i = 0; i < kSatellites; ++i) {
    const double azimuth_rad = 2.4 * i;
    const double elevation_rad = 0.3 + 0.12 * i;
    const Eigen::Vector3d line_enu(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                   std::cos(azimuth_rad) * std::cos(elevation_rad),
                                   std::sin(elevation_rad));
    const Eigen::Vector3d passing_enu =
        3000.0 * line_enu.cross(Eigen::Vector3d(0.3 * i - 1.0, 0.5, 1.0)).normalized();
    TrackedPhase phase;
    phase.index = static_cast<std::size_t>(i) + 10;
    phase.satellite = {System::kGps, static_cast<std::uint8_t>(i + 1)};
    phase.signal = {'1', 'C'};
    const auto range = [&](double at_s) {
      const Eigen::Vector3d satellite =
          ReceiverAt(0.0) +
          EnuFromEcefRotation(kPlace).transpose() * (22e6 * line_enu + passing_enu * at_s);
      phase.satellite_in_ecef = satellite;
      return (satellite - ReceiverAt(at_s)).norm() + 4e5 + 90.0 * at_s;
    };
    phase.rate_mps = (range(seconds + 0.5) - range(seconds - 0.5));
    phase.phase_m = range(seconds) + 1234.5 * i;  // of any origin
    phase.orbit_gps_ns = kStart_ns;
    phases.push_back(phase);
  }
  return phases;
}

std::int64_t Time(double seconds) { return kStart_ns + std::llround(seconds * 1e9); }

TEST(PhaseChanges, TellTheDisplacementToATenthOfAMillimetre) {
  for (const double gap_s : {0.1, 1.0, 3.0}) {
    PhaseChanges changes;
    EXPECT_TRUE(changes.Update(Time(0.0), ReceiverAt(0.0), PhasesAt(0.0)).empty());
    const std::span<const RangeChangeObservation> found =
        changes.Update(Time(gap_s), ReceiverAt(gap_s), PhasesAt(gap_s));
    ASSERT_EQ(found.size(), static_cast<std::size_t>(kSatellites));
    Eigen::Matrix<double, kSatellites, 4> slopes;
    Eigen::Matrix<double, kSatellites, 1> right;
    for (int i = 0; i < kSatellites; ++i) {
      const RangeChangeObservation& change = found[static_cast<std::size_t>(i)];
      slopes.row(i) << -change.direction_in_ecef.transpose(), 1.0;
      right[i] = change.change_m;
      EXPECT_EQ(changes.signals()[static_cast<std::size_t>(i)], static_cast<std::size_t>(i) + 10);
    }
    const Eigen::Vector4d solved = slopes.colPivHouseholderQr().solve(right);
    EXPECT_LT((solved.head<3>() - (ReceiverAt(gap_s) - ReceiverAt(0.0))).norm(), 1e-4);
    EXPECT_NEAR(solved[3], 90.0 * gap_s, 1e-4);
  }
}

// Of the signals, those that a change was given for, after something happened to the second epoch.
std::vector<std::size_t> GivenAfter(const std::function<void(std::vector<TrackedPhase>*)>& happens,
                                    double gap_s = 1.0) {
  PhaseChanges changes;
  changes.Update(Time(0.0), ReceiverAt(0.0), PhasesAt(0.0));
  std::vector<TrackedPhase> phases = PhasesAt(gap_s);
  happens(&phases);
  changes.Update(Time(gap_s), ReceiverAt(gap_s), phases);
  return {changes.signals().begin(), changes.signals().end()};
}

TEST(PhaseChanges, WhatWasNotFollowedGivesNone) {
  const std::vector<std::size_t> all = GivenAfter([](std::vector<TrackedPhase>*) {});
  ASSERT_EQ(all.size(), static_cast<std::size_t>(kSatellites));
  std::vector<std::size_t> others = all;
  others.erase(others.begin() + 3);
  const std::vector<std::function<void(TrackedPhase*)>> breaks = {
      [](TrackedPhase* phase) { phase->lost_lock = true; },
      [](TrackedPhase* phase) { phase->half_cycle = true; },
      [](TrackedPhase* phase) { phase->orbit_gps_ns += 7200 * kSecond_ns; },
      [](TrackedPhase* phase) { phase->phase_m += 25.0; },  // against its Doppler
      [](TrackedPhase* phase) { phase->phase_m -= 3e6; },
      [](TrackedPhase* phase) { phase->signal = {'5', 'Q'}; },
      [](TrackedPhase* phase) { phase->satellite.number = 30; },
  };
  for (std::size_t i = 0; i < breaks.size(); ++i) {
    EXPECT_EQ(GivenAfter([&](std::vector<TrackedPhase>* phases) { breaks[i](&(*phases)[3]); }),
              others)
        << i;
  }
}

TEST(PhaseChanges, ALossIsOfOneEpochOnly) {
  PhaseChanges changes;
  changes.Update(Time(0.0), ReceiverAt(0.0), PhasesAt(0.0));
  std::vector<TrackedPhase> lost = PhasesAt(1.0);
  lost[3].lost_lock = true;
  EXPECT_EQ(changes.Update(Time(1.0), ReceiverAt(1.0), lost).size(), kSatellites - 1u);
  EXPECT_EQ(changes.Update(Time(2.0), ReceiverAt(2.0), PhasesAt(2.0)).size(), kSatellites + 0u);
}

TEST(PhaseChanges, LongGapsAndTimesThatDoNotAdvanceGiveNone) {
  EXPECT_EQ(GivenAfter([](std::vector<TrackedPhase>*) {}, 3.0).size(), kSatellites + 0u);
  for (const double gap_s : {5.0, 0.0, -1.0, 1e6}) {
    EXPECT_TRUE(GivenAfter([](std::vector<TrackedPhase>*) {}, gap_s).empty()) << gap_s;
  }
}

TEST(PhaseChanges, AJumpOfTheReceiversClockDropsNobody) {
  for (const double jump_m : {30.0, -299'792.458, 4e5}) {
    EXPECT_EQ(GivenAfter([&](std::vector<TrackedPhase>* phases) {
                for (TrackedPhase& phase : *phases) phase.phase_m += jump_m;
              }).size(),
              kSatellites + 0u);
  }
}

TEST(PhaseChanges, NoDopplerIsNoReasonToDoubt) {
  PhaseChanges changes;
  std::vector<TrackedPhase> first = PhasesAt(0.0);
  std::vector<TrackedPhase> second = PhasesAt(1.0);
  for (int i = 0; i < kSatellites; ++i) {
    first[static_cast<std::size_t>(i)].rate_mps.reset();
    if (i % 2 == 0) second[static_cast<std::size_t>(i)].rate_mps.reset();
  }
  changes.Update(Time(0.0), ReceiverAt(0.0), first);
  EXPECT_EQ(changes.Update(Time(1.0), ReceiverAt(1.0), second).size(), kSatellites + 0u);
}

}  // namespace
}  // namespace lodemark
