#include "tools/simulator/inertial_sensors.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kInterval_s = 0.01;

Scenario Walk() {
  Scenario scenario;
  scenario.place = {30.5 * kRadiansPerDegree, 114.3 * kRadiansPerDegree, 24.0};
  scenario.waypoints_m = {{0, 0}, {8, 46}, {58, 38}, {49, -16}, {0, 0}};
  scenario.phone_height_m = 1.5;
  return scenario;
}

// Photographs to either side of the way, the camera tilted and rolled.
Scenario Photographing() {
  Scenario scenario = Walk();
  scenario.rise_m = 0.0;
  PhotoGroup group;
  FrameSeries series;
  series.first_s = 3.0;
  series.every_s = 4.0;
  series.ahead = true;
  for (int i = 0; i < 20; ++i) {
    series.holds.push_back({(i % 2 == 0 ? 25.0 : -28.0) * kRadiansPerDegree,
                            10.0 * kRadiansPerDegree, 3.0 * i * kRadiansPerDegree});
  }
  group.frames.push_back(series);
  scenario.photography.groups.push_back(group);
  return scenario;
}

Eigen::Quaterniond Turned(const Eigen::Vector3d& by_rad) {
  const double angle_rad = by_rad.norm();
  if (angle_rad == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, by_rad / angle_rad));
}

// Strapdown integration from the samples alone, of the equations in Groves (2013), 5.4, in a local
// frame small enough to be flat. Gives how far it ends from the simulated way.
void Integrate(const Scenario& scenario, double until_s, double* place_error_m,
               double* attitude_error_rad) {
  const InertialMotion motion(scenario);
  const double latitude_rad = scenario.place.latitude_rad;
  const Eigen::Vector3d earth_rate(0.0, 7.292115e-5 * std::cos(latitude_rad),
                                   7.292115e-5 * std::sin(latitude_rad));
  const Eigen::Vector3d gravity(0.0, 0.0, -motion.gravity_mps2());
  double time_s = 0.0;
  Eigen::Quaterniond enu_from_device = motion.hold().EnuFromDevice(time_s);
  Eigen::Vector3d velocity = motion.VelocityAt(time_s);
  Eigen::Vector3d place = motion.PositionAt(time_s);
  for (int i = 0; time_s < until_s; ++i) {
    const InertialTruth sample = motion.At(time_s + 0.5 * kInterval_s, kInterval_s);
    const Eigen::Vector3d turn_rate =
        sample.turn_rate_radps - enu_from_device.conjugate() * earth_rate;
    const Eigen::Quaterniond middle = enu_from_device * Turned(0.5 * kInterval_s * turn_rate);
    const Eigen::Vector3d acceleration =
        middle * sample.force_mps2 + gravity - 2.0 * earth_rate.cross(velocity);
    place += kInterval_s * (velocity + 0.5 * kInterval_s * acceleration);
    velocity += kInterval_s * acceleration;
    enu_from_device = (enu_from_device * Turned(kInterval_s * turn_rate)).normalized();
    time_s = (i + 1) * kInterval_s;
  }
  *place_error_m = (place - motion.PositionAt(time_s)).norm();
  *attitude_error_rad = enu_from_device.angularDistance(motion.hold().EnuFromDevice(time_s));
}

TEST(InertialMotion, IntegratesToTheSimulatedWay) {
  Scenario stopping = Walk();
  stopping.stop_s = 3.0;
  Scenario car = Walk();
  car.speed_mps = 8.0;
  for (const Scenario& scenario : {Walk(), Photographing(), stopping, car}) {
    for (const double until_s : {20.0, 80.0}) {
      double place_error_m = 0.0;
      double attitude_error_rad = 0.0;
      Integrate(scenario, until_s, &place_error_m, &attitude_error_rad);
      EXPECT_LT(attitude_error_rad, 1e-5);
      EXPECT_LT(place_error_m, 0.05) << "after " << until_s;
    }
  }
}

TEST(InertialMotion, IsNearTheReceiversWay) {
  const Scenario scenario = Walk();
  const InertialMotion motion(scenario);
  const ReceiverPath path(scenario);
  for (double time_s = 0.0; time_s < 100.0; time_s += 0.37) {
    EXPECT_LT((motion.PositionAt(time_s) - path.At(time_s).position_in_enu).norm(), 0.02);
  }
}

TEST(InertialMotion, FeelsGravityUpwardsAtRest) {
  Scenario scenario;
  scenario.place = {45.0 * kRadiansPerDegree, 0.0, 0.0};
  const InertialTruth truth = InertialMotion(scenario).At(10.0, kInterval_s);
  // Normal gravity at 45 degrees (WGS 84); upright, so y is up.
  EXPECT_NEAR((truth.force_mps2 - Eigen::Vector3d(0.0, 9.80620, 0.0)).norm(), 0.0, 1e-5);
  EXPECT_NEAR(truth.turn_rate_radps.norm(), 7.292115e-5, 1e-9);
}

TEST(PhoneHold, LooksWhereThePhotographsDo) {
  const Scenario scenario = Photographing();
  const PhoneHold hold(scenario);
  const ReceiverPath path(scenario);
  const CameraHold first = scenario.photography.groups[0].frames[0].holds[0];
  const Eigen::Quaterniond enu_from_device = hold.EnuFromDevice(3.0);
  const Eigen::Vector3d ahead = enu_from_device * Eigen::Vector3d(0.0, 0.0, -1.0);
  EXPECT_NEAR(std::asin(ahead.z()), first.tilt_rad, 1e-9);
  EXPECT_NEAR(std::remainder(
                  std::atan2(ahead.x(), ahead.y()) - path.At(3.0).heading_rad - first.heading_rad,
                  2.0 * kPi),
              0.0, 1e-9);
  // Of no roll, the screen's upper edge is up.
  EXPECT_NEAR((enu_from_device * Eigen::Vector3d::UnitY()).z(), std::cos(first.tilt_rad), 1e-9);
}

TEST(PhoneHold, TurnsWithoutAJump) {
  Scenario stopping = Walk();
  stopping.stop_s = 3.0;
  for (const Scenario& scenario : {Walk(), Photographing(), stopping}) {
    const PhoneHold hold(scenario);
    for (double time_s = -2.0; time_s < 130.0; time_s += 0.01) {
      EXPECT_LT(hold.EnuFromDevice(time_s).angularDistance(hold.EnuFromDevice(time_s + 0.01)), 0.06)
          << time_s;
    }
  }
}

TEST(SensorErrors, AreOfTheirGrade) {
  Random random(5);
  const SensorErrors::Grade grade = PhoneGyroscope();
  double bias_squares = 0.0;
  double noise_squares = 0.0;
  constexpr int kSensors = 300;
  constexpr int kSamples = 100;
  for (int i = 0; i < kSensors; ++i) {
    SensorErrors errors(grade, &random);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (int k = 0; k < kSamples; ++k) {
      const Eigen::Vector3d measured =
          errors.Measure(Eigen::Vector3d::Zero(), kInterval_s, &random);
      if (k > 0) noise_squares += 0.5 * (measured - before).squaredNorm();
      before = measured;
      mean += measured / kSamples;
    }
    bias_squares += mean.squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(bias_squares / (3 * kSensors)), grade.bias_sigma, 0.1 * grade.bias_sigma);
  const double noise = grade.noise_density / std::sqrt(kInterval_s);
  EXPECT_NEAR(std::sqrt(noise_squares / (3.0 * kSensors * (kSamples - 1))), noise, 0.03 * noise);
}

}  // namespace
}  // namespace lodemark
