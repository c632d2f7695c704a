// Position, velocity and clock of a satellite from one broadcast set, which is assumed to be
// plausible (see broadcast_rules.h).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/units.h"
#include "core/gnss/ephemeris.h"

namespace lodemark {

struct BroadcastState {
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();  // antenna phase centre, m
  Eigen::Vector3d velocity_in_ecef = Eigen::Vector3d::Zero();  // m/s, relative to the earth
  // Satellite clock minus system time, with the relativistic term where the ICD asks for it and
  // without group delays.
  double clock_bias_s = 0.0;
  double clock_drift_sps = 0.0;
};

// State at time_gps_ns + fraction_s. Velocity is the derivative of position, drift that of bias.
BroadcastState KeplerState(const KeplerEphemeris& ephemeris, std::int64_t time_gps_ns,
                           double fraction_s);

// The clock polynomial alone: within 0.2 microseconds of the clock with the relativistic term.
double KeplerClockPolynomial(const KeplerEphemeris& ephemeris, std::int64_t time_gps_ns,
                             double fraction_s);

// Orbit of a GLONASS or SBAS set. A GLONASS set is integrated once, when it is made, to nodes two
// minutes apart, so that asking takes one step from the nearest.
class StateOrbit {
 public:
  // How far from toe the nodes go. A time beyond is answered as the state at the farthest node.
  static constexpr std::int64_t kReach_ns = 32 * 60 * kSecond_ns;

  explicit StateOrbit(const StateEphemeris& ephemeris);

  const StateEphemeris& ephemeris() const { return ephemeris_; }
  StateEphemeris& ephemeris() { return ephemeris_; }

  // State at time_gps_ns + fraction_s.
  BroadcastState At(std::int64_t time_gps_ns, double fraction_s) const;

  // Clock minus system time.
  double ClockBias(std::int64_t time_gps_ns, double fraction_s) const;

 private:
  struct Node {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
  };

  StateEphemeris ephemeris_;
  std::vector<Node> nodes_;  // empty for SBAS
};

}  // namespace lodemark
