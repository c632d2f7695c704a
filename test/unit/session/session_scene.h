// A receiver under an invented sky: satellites on nearly circular orbits, and what the receiver
// measures of them without atmosphere.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "core/gnss/android_measurement.h"
#include "core/gnss/broadcast_orbit.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/session/session.h"

namespace lodemark::test {

inline constexpr std::int64_t kSceneReference_ns = 2'300 * kWeek_ns + 295'200 * kSecond_ns;
inline constexpr std::int64_t kSceneStart_ns = kSceneReference_ns + 600 * kSecond_ns;

// System and signal that the scene's satellites send, one per system.
struct SceneSystem {
  System system;
  MessageType type;
  SignalCode signal;
  double frequency_hz;
  double semi_major_axis_m;
  int planes;
  int first_number;
};
inline constexpr SceneSystem kSceneGps = {
    System::kGps, MessageType::kLnav, {'1', 'C'}, 1575.42e6, 26.56e6, 6, 1};
inline constexpr SceneSystem kSceneGalileo = {
    System::kGalileo, MessageType::kInav, {'1', 'C'}, 1575.42e6, 29.6e6, 3, 1};
inline constexpr SceneSystem kSceneBeidou = {
    System::kBeidou, MessageType::kD1, {'2', 'I'}, 1561.098e6, 27.906e6, 3, 19};

class SessionScene {
 public:
  explicit SessionScene(std::vector<SceneSystem> systems = {kSceneGps, kSceneGalileo}) {
    options.ionosphere = IonosphereChoice::kNone;
    options.troposphere = TroposphereChoice::kNone;
    options.elevation_mask_rad = 0.17;
    constexpr int kSatellites = 24;
    for (const SceneSystem& system : systems) {
      for (int i = 0; i < kSatellites; ++i) {
        const int plane = i % system.planes;
        KeplerEphemeris set;
        set.satellite = {system.system, static_cast<std::uint8_t>(system.first_number + i)};
        set.type = system.type;
        set.toe_gps_ns = kSceneReference_ns;
        set.toc_gps_ns = kSceneReference_ns;
        set.transmitted_gps_ns = kSceneReference_ns;
        set.issue_of_data = 17;
        set.issue_of_clock = 17;
        set.semi_major_axis_m = system.semi_major_axis_m;
        set.eccentricity = 0.001;
        set.inclination_rad = 0.96;
        set.ascending_node_rad = std::remainder(2.0 * kPi * plane / system.planes + 0.3, 2.0 * kPi);
        // Spread along the plane, and planes against each other.
        const int in_plane = i / system.planes;
        set.mean_anomaly_rad = std::remainder(
            2.0 * kPi * in_plane * system.planes / kSatellites + 0.61 * plane + 0.1, 2.0 * kPi);
        set.clock_bias_s = 1e-6 * (i - 11);
        set.clock_drift_sps = 1e-12 * i;
        sets.push_back(set);
        systems_of[set.satellite] = system;
      }
    }
  }

  std::unique_ptr<Session> Open() const {
    std::unique_ptr<Session> session = std::move(Session::Open(options)).value();
    for (const KeplerEphemeris& set : sets) (void)session->PushNavigation(set);
    return session;
  }

  Eigen::Vector3d PlaceAt(double seconds) const {
    if (path) return path(seconds);
    return EcefFromGeodetic(place) +
           EnuFromEcefRotation(place).transpose() * velocity_enu_mps * seconds;
  }

  // Pseudorange of a satellite at the receiver's reading, the clock in it.
  double Pseudorange(const KeplerEphemeris& set, double seconds) const {
    const double clock_s = clock_m / kSpeedOfLight_mps;
    const Eigen::Vector3d receiver = PlaceAt(seconds);
    double flight_s = 0.07;
    double range_m = 0.0;
    BroadcastState state;
    for (int i = 0; i < 6; ++i) {
      state = KeplerState(set, kSceneStart_ns, seconds - clock_s - flight_s);
      const double turned_rad = 7.2921151467e-5 * flight_s;
      const Eigen::Vector3d satellite(std::cos(turned_rad) * state.position_in_ecef.x() +
                                          std::sin(turned_rad) * state.position_in_ecef.y(),
                                      -std::sin(turned_rad) * state.position_in_ecef.x() +
                                          std::cos(turned_rad) * state.position_in_ecef.y(),
                                      state.position_in_ecef.z());
      range_m = (satellite - receiver).norm();
      flight_s = range_m / kSpeedOfLight_mps;
    }
    return range_m + clock_m - kSpeedOfLight_mps * state.clock_bias_s;
  }

  double Elevation(const KeplerEphemeris& set, double seconds) const {
    const BroadcastState state = KeplerState(set, kSceneStart_ns, seconds - 0.07);
    const Eigen::Vector3d receiver = PlaceAt(seconds);
    return LookAnglesTo(state.position_in_ecef, receiver,
                        EnuFromEcefRotation(GeodeticFromEcef(receiver)))
        .elevation_rad;
  }

  // All satellites above 15 degrees, so many seconds after kSceneStart_ns by the receiver's clock.
  ObservationEpoch Epoch(double seconds) const {
    ObservationEpoch epoch;
    epoch.time_gps_ns = kSceneStart_ns + static_cast<std::int64_t>(seconds * 1e9);
    for (const KeplerEphemeris& set : sets) {
      if (Elevation(set, seconds) < 15.0 * kRadiansPerDegree) continue;
      const SceneSystem& system = systems_of.at(set.satellite);
      const double bias_m = bias_of.contains(system.system) ? bias_of.at(system.system) : 0.0;
      SignalObservation signal;
      signal.satellite = set.satellite;
      signal.signal = system.signal;
      signal.frequency_hz = system.frequency_hz;
      signal.present = kHasPseudorange | kHasDoppler | kHasCn0;
      signal.pseudorange_m = Pseudorange(set, seconds) + bias_m;
      const double rate_mps = Pseudorange(set, seconds + 0.5) - Pseudorange(set, seconds - 0.5);
      signal.doppler_hz = -rate_mps * system.frequency_hz / kSpeedOfLight_mps;
      signal.cn0_dbhz = 45.0;
      epoch.signals.push_back(signal);
    }
    return epoch;
  }

  // The same as a phone reports it, to the nanosecond. GPS and Galileo only.
  AndroidEpoch Raw(double seconds) const { return Raw(Epoch(seconds)); }
  AndroidEpoch Raw(const ObservationEpoch& epoch) const {
    AndroidEpoch raw;
    raw.clock.time_ns = 5 * kSecond_ns + (epoch.time_gps_ns - kSceneStart_ns);
    raw.clock.full_bias_ns = raw.clock.time_ns - epoch.time_gps_ns;
    raw.clock.present = kClockHasFullBias;
    for (const SignalObservation& signal : epoch.signals) {
      AndroidMeasurement measurement;
      measurement.svid = signal.satellite.number;
      measurement.constellation_type = signal.satellite.system == System::kGps ? 1 : 6;
      measurement.state = 1 | 2 | 4 | 8;  // code, bit and subframe lock, time of week decoded
      const auto travel_ns =
          static_cast<std::int64_t>(std::round(signal.pseudorange_m / kSpeedOfLight_mps * 1e9));
      measurement.received_sv_time_ns = (epoch.time_gps_ns - travel_ns) % kWeek_ns;
      measurement.received_sv_time_uncertainty_ns = 10;
      measurement.pseudorange_rate_mps =
          -signal.doppler_hz * kSpeedOfLight_mps / signal.frequency_hz;
      measurement.pseudorange_rate_uncertainty_mps = 0.1;
      measurement.cn0_dbhz = signal.cn0_dbhz;
      measurement.present = kMeasurementHasReceivedTimeUncertainty | kMeasurementHasRangeRate |
                            kMeasurementHasRangeRateUncertainty | kMeasurementHasCn0;
      raw.measurements.push_back(measurement);
    }
    return raw;
  }

  SessionOptions options;
  std::vector<KeplerEphemeris> sets;
  std::map<SatelliteId, SceneSystem> systems_of;
  std::map<System, double> bias_of;  // metres
  Geodetic place = {0.84, 0.2, 250.0};
  Eigen::Vector3d velocity_enu_mps = Eigen::Vector3d::Zero();
  std::function<Eigen::Vector3d(double)> path;  // earth-fixed by seconds, in place of these two
  double clock_m = 30'000.0;
};

// Keeps so many signals of a system, the first ones.
inline void KeepFirst(ObservationEpoch* epoch, System system, int most) {
  int kept = 0;
  std::erase_if(epoch->signals, [&](const SignalObservation& signal) {
    return signal.satellite.system == system && ++kept > most;
  });
}

inline const SessionEstimate& ProcessEpoch(Session* session, const ObservationEpoch& epoch) {
  (void)session->PushObservationEpoch(0, epoch);
  session->ProcessNext();
  return session->estimate();
}

inline int CountEvents(const Session& session, EventKind kind) {
  int count = 0;
  for (const SessionEvent& event : session.events()) count += event.kind == kind ? 1 : 0;
  return count;
}

}  // namespace lodemark::test
