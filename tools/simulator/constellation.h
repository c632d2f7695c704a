// Simulated satellites: nominal constellations, what they broadcast, and where they truly are.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/gnss/broadcast_orbit.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/signal.h"
#include "tools/simulator/scenario.h"

namespace lodemark {

struct TrueSatelliteState {
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();  // at the asked time
  double clock_bias_s = 0.0;  // against the system's time, relativity included, no group delay
};

// One satellite. Its true orbit and clock are the broadcast ones plus errors of the size that
// broadcast sets have.
class SimulatedSatellite {
 public:
  SatelliteId id;
  std::int8_t glonass_channel = kUnknownGlonassChannel;
  std::vector<SignalCode> signals;

  // The state at time_gps_ns + fraction_s.
  TrueSatelliteState At(std::int64_t time_gps_ns, double fraction_s) const;

  // What has to be added to the satellite clock for a signal, as the broadcast set says.
  double GroupDelay(SignalCode signal) const;

  // All broadcast sets over the scenario's time, in order of time.
  const std::vector<KeplerEphemeris>& kepler_sets() const { return kepler_; }
  const std::vector<StateEphemeris>& state_sets() const { return states_; }

 private:
  friend class ConstellationMaker;

  // Errors of orbit and clock: amplitudes of slow waves.
  struct Wave {
    double amplitude = 0.0;
    double phase_rad = 0.0;
    double At(double turns) const;
  };

  BroadcastState BroadcastAt(std::int64_t time_gps_ns, double fraction_s) const;

  std::vector<KeplerEphemeris> kepler_;
  std::vector<StateEphemeris> states_;
  std::vector<StateOrbit> orbits_;  // of states_
  std::int64_t reference_gps_ns_ = 0;
  Wave radial_m_, along_m_, cross_m_, clock_s_;
};

// The satellites of Scenario::systems, the same for the same seed whatever the other systems.
std::vector<SimulatedSatellite> MakeConstellation(const Scenario& scenario);

// The same orbit and clock told with the reference times moved by shift_ns.
KeplerEphemeris Rereferenced(const KeplerEphemeris& ephemeris, std::int64_t shift_ns);

// A day of moderate solar activity.
KlobucharParameters SimulatedIonosphere();

}  // namespace lodemark
