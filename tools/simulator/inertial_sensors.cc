#include "tools/simulator/inertial_sensors.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kEarthRotation_radps = 7.292115e-5;

// Normal gravity of WGS 84: Somigliana's formula and the free air gradient (NIMA TR8350.2, 4-1).
double NormalGravity(const Geodetic& place) {
  const double squared = std::pow(std::sin(place.latitude_rad), 2);
  const double at_ellipsoid = 9.7803253359 * (1.0 + 0.00193185265241 * squared) /
                              std::sqrt(1.0 - 0.00669437999013 * squared);
  return at_ellipsoid - 3.086e-6 * place.height_m;
}

// Steps of a walker; faster than this it is a vehicle.
constexpr double kFastestWalk_mps = 2.5;
constexpr double kSteps_hz = 1.8;
constexpr double kBob_s = 0.014;  // times the speed: 19 mm at 1.35 m/s

// For derivatives of the bobbing, whose shortest period is half a second.
constexpr double kStep_s = 1e-4;

Eigen::Vector3d DrawVector(double sigma, Random* random) {
  Eigen::Vector3d drawn;
  for (double& component : drawn) component = random->Gaussian(0.0, sigma);
  return drawn;
}

}  // namespace

InertialMotion::InertialMotion(const Scenario& scenario)
    : path_(scenario),
      hold_(scenario),
      walks_(scenario.speed_mps < kFastestWalk_mps),
      gravity_mps2_(NormalGravity(scenario.place)),
      earth_rate_in_enu_(0.0, kEarthRotation_radps * std::cos(scenario.place.latitude_rad),
                         kEarthRotation_radps * std::sin(scenario.place.latitude_rad)) {}

double InertialMotion::BobAt(double time_s) const {
  if (!walks_) return 0.0;
  const double speed_mps = path_.At(time_s).velocity_in_enu.head<2>().norm();
  return kBob_s * speed_mps * std::sin(2.0 * kPi * kSteps_hz * time_s);
}

Eigen::Vector3d InertialMotion::PositionAt(double time_s) const {
  return path_.At(time_s).position_in_enu + Eigen::Vector3d(0.0, 0.0, BobAt(time_s));
}

Eigen::Vector3d InertialMotion::VelocityAt(double time_s) const {
  const double bob_mps = (BobAt(time_s + kStep_s) - BobAt(time_s - kStep_s)) / (2.0 * kStep_s);
  return path_.At(time_s).velocity_in_enu + Eigen::Vector3d(0.0, 0.0, bob_mps);
}

InertialTruth InertialMotion::At(double time_s, double interval_s) const {
  const double begin_s = time_s - 0.5 * interval_s;
  const double end_s = time_s + 0.5 * interval_s;
  const Eigen::Quaterniond device_from_enu = hold_.EnuFromDevice(time_s).conjugate();
  const Eigen::Vector3d gained_mps = VelocityAt(end_s) - VelocityAt(begin_s);
  const Eigen::Vector3d mean_mps = 0.5 * (VelocityAt(end_s) + VelocityAt(begin_s));
  InertialTruth truth;
  truth.force_mps2 =
      device_from_enu * (gained_mps / interval_s + 2.0 * earth_rate_in_enu_.cross(mean_mps) +
                         Eigen::Vector3d(0.0, 0.0, gravity_mps2_));
  const Eigen::AngleAxisd turned(hold_.EnuFromDevice(begin_s).conjugate() *
                                 hold_.EnuFromDevice(end_s));
  truth.turn_rate_radps = std::remainder(turned.angle(), 2.0 * kPi) / interval_s * turned.axis() +
                          device_from_enu * earth_rate_in_enu_;
  return truth;
}

SensorErrors::SensorErrors(const Grade& grade, Random* random)
    : grade_(grade),
      bias_(DrawVector(grade.bias_sigma, random)),
      scale_(Eigen::Vector3d::Ones() + DrawVector(grade.scale_sigma, random)),
      stated_bias_(bias_ + DrawVector(grade.stated_share * grade.bias_sigma, random)) {}

Eigen::Vector3d SensorErrors::Measure(const Eigen::Vector3d& truth, double interval_s,
                                      Random* random) {
  bias_ += DrawVector(grade_.bias_walk * std::sqrt(interval_s), random);
  const Eigen::Vector3d noise = DrawVector(grade_.noise_density / std::sqrt(interval_s), random);
  return scale_.cwiseProduct(truth) + bias_ + noise;
}

// About what data sheets of the sensors in phones state (Bosch BMI260, TDK ICM-42607): 160 ug and
// 0.007 degrees per second per square root of a hertz; biases as they are left after soldering.
SensorErrors::Grade PhoneAccelerometer() {
  return {.bias_sigma = 0.08,
          .bias_walk = 3e-4,
          .noise_density = 1.6e-3,
          .scale_sigma = 0.003,
          .stated_share = 0.3};
}

SensorErrors::Grade PhoneGyroscope() {
  return {.bias_sigma = 0.006,
          .bias_walk = 1e-5,
          .noise_density = 1.2e-4,
          .scale_sigma = 0.003,
          .stated_share = 0.1};
}

}  // namespace lodemark
