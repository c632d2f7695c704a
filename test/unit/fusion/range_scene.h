// Ranges from a known place to satellites and landmarks, for the tests of fusion.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/fusion/observation.h"
#include "core/geo/geodetic.h"

namespace lodemark {

inline constexpr double kClock_m = 123'456.789;  // of group 0, where a test does not say otherwise

// Direction from the receiver in its own east, north, up.
inline Eigen::Vector3d DirectionInEnu(double azimuth_deg, double elevation_deg) {
  const double azimuth_rad = azimuth_deg * kRadiansPerDegree;
  const double elevation_rad = elevation_deg * kRadiansPerDegree;
  return {std::sin(azimuth_rad) * std::cos(elevation_rad),
          std::cos(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
}

// Measured without error until the test adds some.
class RangeScene {
 public:
  explicit RangeScene(const Geodetic& place = {48.2 * kRadiansPerDegree, 16.37 * kRadiansPerDegree,
                                               180.0})
      : place_(place), frame_(place), truth_in_ecef(EcefFromGeodetic(place)) {}

  void AddPoint(const Eigen::Vector3d& point_in_enu, int group, double clock_m,
                const RangeErrorModel& error) {
    RangeObservation observation;
    observation.point_in_ecef = frame_.ToEcef(point_in_enu);
    observation.range_m = (observation.point_in_ecef - truth_in_ecef).norm() + clock_m;
    observation.clock_group = group;
    observation.error = error;
    ranges.push_back(observation);
  }

  void AddSatellite(double azimuth_deg, double elevation_deg, int group = 0,
                    double clock_m = kClock_m, const RangeErrorModel& error = {3.0, 0.1, 20.0}) {
    // Distance to a circle of 26 560 km around the centre of the earth.
    constexpr double kEarth_m = 6.37e6;
    constexpr double kOrbit_m = 26.56e6;
    const double rise_m = kEarth_m * std::sin(elevation_deg * kRadiansPerDegree);
    const double distance_m =
        std::sqrt(rise_m * rise_m + kOrbit_m * kOrbit_m - kEarth_m * kEarth_m) - rise_m;
    AddPoint(distance_m * DirectionInEnu(azimuth_deg, elevation_deg), group, clock_m, error);
  }

  void AddLandmark(double azimuth_deg, double distance_m, double up_m, double sigma_m = 0.5) {
    Eigen::Vector3d point = distance_m * DirectionInEnu(azimuth_deg, 0.0);
    point.z() = up_m;
    AddPoint(point, kNoClock, 0.0, {sigma_m, 0.0, 30.0});
  }

  // Satellites well spread over the sky.
  void AddSky(int count, int group = 0, double clock_m = kClock_m,
              const RangeErrorModel& error = {3.0, 0.1, 20.0}) {
    constexpr double kElevations_deg[] = {62.0, 18.0, 38.0, 78.0, 27.0, 50.0, 12.0};
    for (int i = 0; i < count; ++i) {
      AddSatellite(137.5 * i + 20.0 + 11.0 * group, kElevations_deg[(i + group) % 7], group,
                   clock_m, error);
    }
  }

  // What an estimate is off by, in the true place's east, north, up.
  Eigen::Vector3d ErrorInEnu(const Eigen::Vector3d& position_in_ecef) const {
    return frame_.enu_from_ecef() * (position_in_ecef - truth_in_ecef);
  }

  Eigen::Vector3d Beside(const Eigen::Vector3d& offset_in_enu) const {
    return frame_.ToEcef(offset_in_enu);
  }

 private:
  Geodetic place_;
  EnuFrame frame_;

 public:
  Eigen::Vector3d truth_in_ecef;
  std::vector<RangeObservation> ranges;
};

// One error drawn from the model: noise, a reflection, or with the given probability anything
// within a kilometre.
inline double DrawError(const RangeErrorModel& model, double gross_probability, Random* random) {
  const double lot = random->Uniform();
  if (lot < gross_probability) return random->Uniform(-1000.0, 1000.0);
  const double noise_m = random->Gaussian(0.0, model.sigma_m);
  return lot < gross_probability + model.late_probability
             ? noise_m + random->Exponential(model.late_scale_m)
             : noise_m;
}

}  // namespace lodemark
