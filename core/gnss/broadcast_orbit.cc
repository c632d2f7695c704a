#include "core/gnss/broadcast_orbit.h"

#include <algorithm>
#include <cmath>

#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"

namespace lodemark {
namespace {

struct EarthModel {
  double gm_m3ps2;
  double rotation_radps;
};

// IS-GPS-200N table 20-IV; IRNSS-SIS-ICD-1.1 appendix A and IS-QZSS-PNT-005 follow it. Galileo OS
// SIS ICD 2.1 table 61; BDS-SIS-ICD-B1I-3.0 5.2.4.12.
EarthModel EarthModelOf(System system) {
  switch (system) {
    case System::kGalileo:
      return {3.986004418e14, 7.2921151467e-5};
    case System::kBeidou:
      return {3.986004418e14, 7.2921150e-5};
    default:
      return {3.986005e14, 7.2921151467e-5};
  }
}

double SecondsSince(std::int64_t reference_ns, std::int64_t time_ns, double fraction_s) {
  return 1e-9 * static_cast<double>(time_ns - reference_ns) + fraction_s;
}

// Eccentric anomaly with its sine and cosine.
struct EccentricAnomaly {
  double sine;
  double cosine;
};

// Newton's method. For eccentricities below 0.5 three steps reach 1e-7 rad from this start; the
// last correction is applied to sine and cosine by their series, so its square (1e-14) is what is
// left.
EccentricAnomaly SolveKepler(double mean_anomaly_rad, double eccentricity) {
  const double mean_rad = std::remainder(mean_anomaly_rad, 2.0 * kPi);
  double anomaly_rad = mean_rad + eccentricity * std::sin(mean_rad);
  EccentricAnomaly result{};
  for (int iteration = 0; iteration < 10; ++iteration) {
    result = {std::sin(anomaly_rad), std::cos(anomaly_rad)};
    const double step_rad = (mean_rad - anomaly_rad + eccentricity * result.sine) /
                            (1.0 - eccentricity * result.cosine);
    if (std::abs(step_rad) < 1e-7) {
      const double half_square = 0.5 * step_rad * step_rad;
      return {result.sine * (1.0 - half_square) + result.cosine * step_rad,
              result.cosine * (1.0 - half_square) - result.sine * step_rad};
    }
    anomaly_rad += step_rad;
  }
  return result;
}

// Turns a state of a geostationary set into the earth-fixed frame: 5 degrees about x, then the
// earth's rotation since toe about z (BDS-SIS-ICD-B1I-3.0 5.2.4.12).
void TurnGeostationary(double rotation_radps, double since_toe_s, BroadcastState* state) {
  const double tilt_sin = std::sin(-5.0 * kRadiansPerDegree);
  const double tilt_cos = std::cos(-5.0 * kRadiansPerDegree);
  const double turn_sin = std::sin(rotation_radps * since_toe_s);
  const double turn_cos = std::cos(rotation_radps * since_toe_s);
  const auto turn = [&](const Eigen::Vector3d& vector) {
    const double y = tilt_cos * vector.y() + tilt_sin * vector.z();
    const double z = tilt_cos * vector.z() - tilt_sin * vector.y();
    return Eigen::Vector3d(turn_cos * vector.x() + turn_sin * y,
                           turn_cos * y - turn_sin * vector.x(), z);
  };
  const Eigen::Vector3d position = turn(state->position_in_ecef);
  const Eigen::Vector3d velocity = turn(state->velocity_in_ecef);
  state->position_in_ecef = position;
  state->velocity_in_ecef =
      velocity + rotation_radps * Eigen::Vector3d(position.y(), -position.x(), 0.0);
}

// GLONASS ICD L1, L2 edition 5.1 (2008) A.3.1.2.
constexpr double kGlonassGm_m3ps2 = 398'600.44e9;
constexpr double kGlonassRadius_m = 6'378'136.0;
constexpr double kGlonassJ2 = 1'082'625.75e-9;
constexpr double kGlonassRotation_radps = 7.292115e-5;

// Acceleration in the rotating frame (GLONASS ICD 5.1 A.3.1.2), sun and moon as broadcast.
Eigen::Vector3d GlonassAcceleration(const Eigen::Vector3d& position,
                                    const Eigen::Vector3d& velocity,
                                    const Eigen::Vector3d& sun_and_moon) {
  const double inverse_r2 = 1.0 / position.squaredNorm();
  const double central = -kGlonassGm_m3ps2 * inverse_r2 * std::sqrt(inverse_r2);
  const double flattening = 1.5 * kGlonassJ2 * kGlonassRadius_m * kGlonassRadius_m * inverse_r2;
  const double z2 = 5.0 * position.z() * position.z() * inverse_r2;
  const double equatorial =
      central * (1.0 + flattening * (1.0 - z2)) + kGlonassRotation_radps * kGlonassRotation_radps;
  const double polar = central * (1.0 + flattening * (3.0 - z2));
  return Eigen::Vector3d(equatorial * position.x() + 2.0 * kGlonassRotation_radps * velocity.y(),
                         equatorial * position.y() - 2.0 * kGlonassRotation_radps * velocity.x(),
                         polar * position.z()) +
         sun_and_moon;
}

// One step of the classical fourth-order Runge-Kutta method.
void StepGlonass(double step_s, const Eigen::Vector3d& sun_and_moon, Eigen::Vector3d* position,
                 Eigen::Vector3d* velocity) {
  const Eigen::Vector3d v1 = *velocity;
  const Eigen::Vector3d a1 = GlonassAcceleration(*position, v1, sun_and_moon);
  const Eigen::Vector3d v2 = *velocity + 0.5 * step_s * a1;
  const Eigen::Vector3d a2 = GlonassAcceleration(*position + 0.5 * step_s * v1, v2, sun_and_moon);
  const Eigen::Vector3d v3 = *velocity + 0.5 * step_s * a2;
  const Eigen::Vector3d a3 = GlonassAcceleration(*position + 0.5 * step_s * v2, v3, sun_and_moon);
  const Eigen::Vector3d v4 = *velocity + step_s * a3;
  const Eigen::Vector3d a4 = GlonassAcceleration(*position + step_s * v3, v4, sun_and_moon);
  *position += step_s / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
  *velocity += step_s / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

constexpr double kNodeSpacing_s = 120.0;
constexpr int kNodesEachSide = static_cast<int>(StateOrbit::kReach_ns / kSecond_ns) / 120;

}  // namespace

double KeplerClockPolynomial(const KeplerEphemeris& e, std::int64_t time_gps_ns,
                             double fraction_s) {
  const double t_s = SecondsSince(e.toc_gps_ns, time_gps_ns, fraction_s);
  return e.clock_bias_s + t_s * (e.clock_drift_sps + t_s * e.clock_drift_rate_sps2);
}

// IS-GPS-200N tables 20-IV and 30-II (position), 20.3.3.3.3.1 (clock). The ICDs of the other
// systems give the same equations.
BroadcastState KeplerState(const KeplerEphemeris& e, std::int64_t time_gps_ns, double fraction_s) {
  const EarthModel earth = EarthModelOf(e.satellite.system);
  const bool geostationary = (e.type == MessageType::kD1 || e.type == MessageType::kD2) &&
                             IsBeidouGeostationary(e.satellite);
  const double t_s = SecondsSince(e.toe_gps_ns, time_gps_ns, fraction_s);

  const double root_axis = std::sqrt(e.semi_major_axis_m);
  const double axis_m = e.semi_major_axis_m + e.semi_major_axis_rate_mps * t_s;
  const double initial_motion_radps =
      std::sqrt(earth.gm_m3ps2) / (root_axis * e.semi_major_axis_m) +
      e.mean_motion_difference_radps;
  const double mean_anomaly_rad =
      e.mean_anomaly_rad +
      (initial_motion_radps + 0.5 * e.mean_motion_difference_rate_radps2 * t_s) * t_s;
  const double mean_motion_radps =
      initial_motion_radps + e.mean_motion_difference_rate_radps2 * t_s;

  const EccentricAnomaly anomaly = SolveKepler(mean_anomaly_rad, e.eccentricity);
  const double nearness = 1.0 - e.eccentricity * anomaly.cosine;  // radius over axis
  const double anomaly_rate_radps = mean_motion_radps / nearness;
  const double minor = std::sqrt(1.0 - e.eccentricity * e.eccentricity);
  const double true_anomaly_rad = std::atan2(minor * anomaly.sine, anomaly.cosine - e.eccentricity);

  // Argument of latitude, radius and inclination with their second harmonics, and the rates.
  const double latitude_rad = true_anomaly_rad + e.argument_of_perigee_rad;
  const double latitude_rate_radps = minor * anomaly_rate_radps / nearness;
  const double c2 = std::cos(2.0 * latitude_rad);
  const double s2 = std::sin(2.0 * latitude_rad);
  const double u_rad = latitude_rad + e.cus_rad * s2 + e.cuc_rad * c2;
  const double u_rate = latitude_rate_radps * (1.0 + 2.0 * (e.cus_rad * c2 - e.cuc_rad * s2));
  const double r_m = axis_m * nearness + e.crs_m * s2 + e.crc_m * c2;
  const double r_rate = e.semi_major_axis_rate_mps * nearness +
                        axis_m * e.eccentricity * anomaly.sine * anomaly_rate_radps +
                        2.0 * latitude_rate_radps * (e.crs_m * c2 - e.crc_m * s2);
  const double i_rad =
      e.inclination_rad + e.inclination_rate_radps * t_s + e.cis_rad * s2 + e.cic_rad * c2;
  const double i_rate =
      e.inclination_rate_radps + 2.0 * latitude_rate_radps * (e.cis_rad * c2 - e.cic_rad * s2);

  // Longitude of the ascending node. The sets of geostationary satellites leave the earth's
  // rotation since toe to TurnGeostationary.
  const std::int64_t toe_of_week_ns = FloorModulo(
      e.satellite.system == System::kBeidou ? ScaleFromGps(e.toe_gps_ns, TimeScale::kBeidou)
                                            : e.toe_gps_ns,
      kWeek_ns);
  const double node_rate =
      e.ascending_node_rate_radps - (geostationary ? 0.0 : earth.rotation_radps);
  const double node_rad = e.ascending_node_rad + node_rate * t_s -
                          earth.rotation_radps * 1e-9 * static_cast<double>(toe_of_week_ns);

  const double cos_u = std::cos(u_rad);
  const double sin_u = std::sin(u_rad);
  const double along_m = r_m * cos_u;  // in the orbit's plane, from the node
  const double across_m = r_m * sin_u;
  const double along_rate = r_rate * cos_u - across_m * u_rate;
  const double across_rate = r_rate * sin_u + along_m * u_rate;
  const double cos_i = std::cos(i_rad);
  const double sin_i = std::sin(i_rad);
  const double cos_node = std::cos(node_rad);
  const double sin_node = std::sin(node_rad);
  const double x = along_m * cos_node - across_m * cos_i * sin_node;
  const double y = along_m * sin_node + across_m * cos_i * cos_node;
  const double level_rate = across_rate * cos_i - across_m * sin_i * i_rate;

  BroadcastState state;
  state.position_in_ecef = {x, y, across_m * sin_i};
  state.velocity_in_ecef = {along_rate * cos_node - level_rate * sin_node - y * node_rate,
                            along_rate * sin_node + level_rate * cos_node + x * node_rate,
                            across_rate * sin_i + across_m * cos_i * i_rate};
  if (geostationary) TurnGeostationary(earth.rotation_radps, t_s, &state);

  const double relativity = -2.0 * std::sqrt(earth.gm_m3ps2) * e.eccentricity * root_axis /
                            (kSpeedOfLight_mps * kSpeedOfLight_mps);
  const double clock_s = SecondsSince(e.toc_gps_ns, time_gps_ns, fraction_s);
  state.clock_bias_s =
      KeplerClockPolynomial(e, time_gps_ns, fraction_s) + relativity * anomaly.sine;
  state.clock_drift_sps = e.clock_drift_sps + 2.0 * e.clock_drift_rate_sps2 * clock_s +
                          relativity * anomaly.cosine * anomaly_rate_radps;
  return state;
}

StateOrbit::StateOrbit(const StateEphemeris& ephemeris) : ephemeris_(ephemeris) {
  if (ephemeris.satellite.system != System::kGlonass) return;
  nodes_.resize(2 * kNodesEachSide + 1);
  for (const int direction : {-1, 1}) {
    Node node{ephemeris.position_in_ecef, ephemeris.velocity_in_ecef};
    nodes_[kNodesEachSide] = node;
    for (int i = 1; i <= kNodesEachSide; ++i) {
      for (int half = 0; half < 2; ++half) {
        StepGlonass(direction * 0.5 * kNodeSpacing_s, ephemeris.acceleration_in_ecef,
                    &node.position, &node.velocity);
      }
      nodes_[static_cast<std::size_t>(kNodesEachSide + direction * i)] = node;
    }
  }
}

double StateOrbit::ClockBias(std::int64_t time_gps_ns, double fraction_s) const {
  return ephemeris_.clock_bias_s +
         ephemeris_.frequency_bias * SecondsSince(ephemeris_.toe_gps_ns, time_gps_ns, fraction_s);
}

BroadcastState StateOrbit::At(std::int64_t time_gps_ns, double fraction_s) const {
  const double t_s = SecondsSince(ephemeris_.toe_gps_ns, time_gps_ns, fraction_s);
  BroadcastState state;
  state.clock_bias_s = ephemeris_.clock_bias_s + ephemeris_.frequency_bias * t_s;
  state.clock_drift_sps = ephemeris_.frequency_bias;
  if (nodes_.empty()) {  // RTCA DO-229 A.4.4.11
    const Eigen::Vector3d& acceleration = ephemeris_.acceleration_in_ecef;
    state.velocity_in_ecef = ephemeris_.velocity_in_ecef + t_s * acceleration;
    state.position_in_ecef = ephemeris_.position_in_ecef + t_s * ephemeris_.velocity_in_ecef +
                             0.5 * t_s * t_s * acceleration;
    return state;
  }
  constexpr double kReach_s = kNodeSpacing_s * kNodesEachSide;
  const double served_s = std::clamp(t_s, -kReach_s, kReach_s);
  const double nearest = std::round(served_s / kNodeSpacing_s);
  const Node& node = nodes_[static_cast<std::size_t>(kNodesEachSide + static_cast<int>(nearest))];
  state.position_in_ecef = node.position;
  state.velocity_in_ecef = node.velocity;
  StepGlonass(served_s - nearest * kNodeSpacing_s, ephemeris_.acceleration_in_ecef,
              &state.position_in_ecef, &state.velocity_in_ecef);
  return state;
}

}  // namespace lodemark
