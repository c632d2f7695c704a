// Epochs with satellites and landmarks of which some are wrong: signals that came by a longer way,
// landmarks taken for others. For the tests of integrity.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/random.h"
#include "core/fusion/bearing_group.h"
#include "core/fusion/combined_adjustment.h"
#include "test/unit/fusion/camera_scene.h"
#include "test/unit/fusion/range_scene.h"

namespace lodemark {

struct FaultyEpochs {
  int satellites = 10;
  int landmarks = 12;
  double reflected = 0.0;      // share of the satellites
  double reflection_m = 30.0;  // mean of the extra path
  double mismatched = 0.0;     // share of the landmarks
  double mismatch_m = 3.0;     // mean distance of what is seen instead
  // What the adjustment is told: of a signal it cannot know more than how often such are reflected.
  double stated_reflected = 0.05;
};

struct FaultyAnswer {
  Eigen::Vector3d error_enu_m = Eigen::Vector3d::Zero();
  PointEstimate estimate;
  bool used_landmarks = false;
  int reflected = 0;
  int mismatched = 0;

  double horizontal_m() const { return error_enu_m.head<2>().norm(); }
  double up_m() const { return std::abs(error_enu_m.z()); }
  bool IsMisleading() const {
    return estimate.protection_level_m > 0.0 && horizontal_m() > estimate.protection_level_m;
  }
  bool IsMisleadingUp() const {
    return estimate.vertical_protection_level_m > 0.0 &&
           up_m() > estimate.vertical_protection_level_m;
  }
};

// Bearings of a phone: two pixels of a thousand.
inline constexpr double kBearingSigma_rad = 2e-3;

// Adjusts epoch number so; empty where there is no answer. Deterministic by seed and number.
inline std::optional<FaultyAnswer> AnswerFaultyEpoch(const FaultyEpochs& epochs, std::uint64_t seed,
                                                     int number) {
  Random random(seed * 1'000'003ULL + static_cast<std::uint64_t>(number));
  FaultyAnswer answer;
  RangeScene scene;
  for (int i = 0; i < epochs.satellites; ++i) {
    const double elevation_deg = random.Uniform(10.0, 80.0);
    const double sigma_m = std::hypot(2.0, 1.0 / std::sin(elevation_deg * kRadiansPerDegree));
    // One in each part of the sky.
    const double azimuth_deg = 360.0 * (i + random.Uniform()) / epochs.satellites;
    scene.AddSatellite(azimuth_deg, elevation_deg, 0, kClock_m,
                       {sigma_m, epochs.stated_reflected, epochs.reflection_m});
    RangeObservation& range = scene.ranges.back();
    range.range_m += random.Gaussian(0.0, sigma_m);
    const double late_m = random.Exponential(epochs.reflection_m);
    if (random.Uniform() >= epochs.reflected) continue;
    range.range_m += late_m;
    ++answer.reflected;
  }

  CameraScene camera(&scene);
  const double wall_m = random.Uniform(20.0, 80.0);
  for (int i = 0; i < epochs.landmarks; ++i) {
    const Eigen::Vector3d landmark(wall_m * random.Uniform(-0.6, 0.6),
                                   wall_m + random.Uniform(-6.0, 6.0),
                                   wall_m * random.Uniform(-0.1, 0.3));
    // What is seen of the wall is that far beside it, in any direction.
    const double aside_m = random.Exponential(epochs.mismatch_m);
    const double turn_rad = random.Uniform(0.0, 2.0 * kPi);
    const bool mismatched = random.Uniform() < epochs.mismatched;
    Eigen::Vector2d noise(random.Gaussian(), random.Gaussian());
    if (mismatched) {
      noise += aside_m / (landmark.norm() * kBearingSigma_rad) *
               Eigen::Vector2d(std::cos(turn_rad), std::sin(turn_rad));
      ++answer.mismatched;
    }
    camera.AddLandmark(landmark, kBearingSigma_rad, noise);
  }

  AttitudePriors priors;
  const double gravity_sigma_rad = 0.01;
  const auto tilt = [&] { return random.Gaussian(0.0, gravity_sigma_rad); };
  const Eigen::Vector3d up_in_camera(tilt(), -1.0, tilt());  // the camera is held level
  priors.gravity = AttitudePriors::Gravity{up_in_camera.normalized(), gravity_sigma_rad};

  std::vector<ObservationVerdict> verdicts;
  const Eigen::Vector3d start =
      scene.Beside({random.Gaussian(0.0, 5.0), random.Gaussian(0.0, 5.0), 0.0});
  CombinedAdjustment adjustment;
  CombinedEstimate estimate;
  BearingGroup bearings;
  bearings.Set(camera.bearings, priors, camera.camera_from_ecef, {});
  if (adjustment.Solve(scene.ranges, start, ClockBiases(), {}, &bearings, &estimate, &verdicts) !=
      PointStatus::kGood) {
    return std::nullopt;
  }
  answer.estimate = estimate.point;
  answer.used_landmarks = estimate.witness == WitnessVerdict::kUsed;
  answer.error_enu_m = scene.ErrorInEnu(estimate.point.position_in_ecef);
  return answer;
}

}  // namespace lodemark
