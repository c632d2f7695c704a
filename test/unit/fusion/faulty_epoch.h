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
  // How often the wall is taken for its repeat: all landmarks, or those on one side of a place
  // anywhere on it, are seen where others of the same looks stand, a period of the wall beside.
  double repeated = 0.0;
  double least_period_m = 2.0;
  double largest_period_m = 6.0;
  // What the adjustment is told: of a signal it cannot know more than how often such are reflected.
  double stated_reflected = 0.05;
  DisplacementRisk stated_displacement = CombinedOptions().displacement;
};

struct FaultyAnswer {
  Eigen::Vector3d error_enu_m = Eigen::Vector3d::Zero();
  PointEstimate estimate;
  bool used_landmarks = false;
  int reflected = 0;
  int mismatched = 0;
  int repeated = 0;

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

// Drawn deterministically by seed and number.
struct FaultyScene {
  FaultyScene(const FaultyEpochs& epochs, std::uint64_t seed, int number)
      : random(seed * 1'000'003ULL + static_cast<std::uint64_t>(number)) {
    DrawSatellites(epochs);
    DrawLandmarks(epochs);
    constexpr double kGravitySigma_rad = 0.01;
    // One draw a statement: compilers take the arguments of a call in different orders.
    const double forward = random.Gaussian(0.0, kGravitySigma_rad);
    const double sideways = random.Gaussian(0.0, kGravitySigma_rad);
    const Eigen::Vector3d up_in_camera(sideways, -1.0, forward);  // the camera is held level
    attitude.gravity = AttitudePriors::Gravity{up_in_camera.normalized(), kGravitySigma_rad};
    start_in_ecef = ranges.Beside({random.Gaussian(0.0, 5.0), random.Gaussian(0.0, 5.0), 0.0});
    Repeat(epochs);
  }
  FaultyScene(const FaultyScene&) = delete;
  FaultyScene& operator=(const FaultyScene&) = delete;

  void DrawSatellites(const FaultyEpochs& epochs) {
    for (int i = 0; i < epochs.satellites; ++i) {
      const double elevation_deg = random.Uniform(10.0, 80.0);
      const double sigma_m = std::hypot(2.0, 1.0 / std::sin(elevation_deg * kRadiansPerDegree));
      // One in each part of the sky.
      const double azimuth_deg = 360.0 * (i + random.Uniform()) / epochs.satellites;
      ranges.AddSatellite(azimuth_deg, elevation_deg, 0, kClock_m,
                          {sigma_m, epochs.stated_reflected, epochs.reflection_m});
      RangeObservation& range = ranges.ranges.back();
      range.range_m += random.Gaussian(0.0, sigma_m);
      const double late_m = random.Exponential(epochs.reflection_m);
      if (random.Uniform() >= epochs.reflected) continue;
      range.range_m += late_m;
      ++reflected;
    }
  }

  void DrawLandmarks(const FaultyEpochs& epochs) {
    wall_m = random.Uniform(20.0, 80.0);
    for (int i = 0; i < epochs.landmarks; ++i) {
      const double up_m = wall_m * random.Uniform(-0.1, 0.3);
      const double away_m = wall_m + random.Uniform(-6.0, 6.0);
      const double along_m = wall_m * random.Uniform(-0.6, 0.6);
      const Eigen::Vector3d landmark(along_m, away_m, up_m);
      // What is seen of the wall is that far beside it, in any direction.
      const double aside_m = random.Exponential(epochs.mismatch_m);
      const double turn_rad = random.Uniform(0.0, 2.0 * kPi);
      const bool is_mismatched = random.Uniform() < epochs.mismatched;
      const double down = random.Gaussian();
      const double right = random.Gaussian();
      Eigen::Vector2d noise(right, down);
      if (is_mismatched) {
        noise += aside_m / (landmark.norm() * kBearingSigma_rad) *
                 Eigen::Vector2d(std::cos(turn_rad), std::sin(turn_rad));
        ++mismatched;
      }
      camera.AddLandmark(landmark, kBearingSigma_rad, noise);
    }
  }

  // The whole wall in one half of the cases.
  void Repeat(const FaultyEpochs& epochs) {
    const double width_m = random.Uniform(epochs.least_period_m, epochs.largest_period_m);
    const double period_m = random.Uniform() < 0.5 ? -width_m : width_m;
    const bool is_whole = random.Uniform() < 0.5;
    const double edge_m = random.Uniform(-0.6, 0.6) * wall_m;
    if (random.Uniform() >= epochs.repeated) return;
    for (BearingObservation& bearing : camera.bearings) {
      const Eigen::Vector3d landmark = ranges.ErrorInEnu(bearing.point_in_ecef);
      if (!is_whole && landmark.x() > edge_m) continue;
      bearing.point_in_ecef = ranges.Beside(landmark + Eigen::Vector3d(period_m, 0.0, 0.0));
      ++repeated;
    }
  }

  Random random;
  RangeScene ranges;
  CameraScene camera{&ranges};
  double wall_m = 0.0;
  AttitudePriors attitude;
  Eigen::Vector3d start_in_ecef = Eigen::Vector3d::Zero();
  int reflected = 0;
  int mismatched = 0;
  int repeated = 0;
};

// The scene adjusted with its landmarks as the witness has them; empty where there is no answer.
inline std::optional<FaultyAnswer> Answer(const FaultyScene& scene, const FaultyEpochs& epochs,
                                          const Eigen::Vector3d& start_in_ecef,
                                          PositionWitness* witness) {
  CombinedOptions options;
  options.displacement = epochs.stated_displacement;
  CombinedAdjustment adjustment;
  CombinedEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  if (adjustment.Solve(scene.ranges.ranges, start_in_ecef, ClockBiases(), options, witness,
                       &estimate, &verdicts) != PointStatus::kGood) {
    return std::nullopt;
  }
  FaultyAnswer answer;
  answer.reflected = scene.reflected;
  answer.mismatched = scene.mismatched;
  answer.repeated = scene.repeated;
  answer.estimate = estimate.point;
  answer.used_landmarks = estimate.witness == WitnessVerdict::kUsed;
  answer.error_enu_m = scene.ranges.ErrorInEnu(estimate.point.position_in_ecef);
  return answer;
}

// Adjusts epoch number so, the landmarks as bearings.
inline std::optional<FaultyAnswer> AnswerFaultyEpoch(const FaultyEpochs& epochs, std::uint64_t seed,
                                                     int number) {
  const FaultyScene scene(epochs, seed, number);
  BearingGroup bearings;
  bearings.Set(scene.camera.bearings, scene.attitude, scene.camera.camera_from_ecef, {});
  return Answer(scene, epochs, scene.start_in_ecef, &bearings);
}

}  // namespace lodemark
