// Where a satellite was and what its clock said when it sent a signal.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/gnss/ephemeris.h"
#include "core/gnss/precise_orbits.h"
#include "core/gnss/signal.h"

namespace lodemark {

enum class OrbitVerdict : std::uint8_t {
  kGood,
  kNoEphemeris,  // nothing was ever received for the satellite
  kTooOld,       // there is a set, but none near enough in time
  kUnhealthy,    // the newest set says so
};

struct SatelliteState {
  // Earth-fixed at the instant of transmission: not yet turned by the earth's rotation in flight.
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_ecef = Eigen::Vector3d::Zero();
  // Satellite clock minus GPS time (for GLONASS and others: minus the system's time as aligned by
  // GpsFromScale), with the relativistic term and the group delay of the asked signal: add
  // c times this to the pseudorange.
  double clock_bias_s = 0.0;
  double clock_drift_sps = 0.0;
  double accuracy_m = 0.0;  // 1 sigma of the range as the source states it, 0 if unknown
  std::int64_t transmitted_gps_ns = 0;  // whole nanoseconds of the time of transmission
  std::int64_t reference_gps_ns = 0;    // toe of the set used, or the time asked for precise orbits
  std::int32_t issue_of_data = 0;
  std::int8_t glonass_channel = kUnknownGlonassChannel;
  bool precise = false;
};

// Holds broadcast sets and precise tables and answers for one signal at a time. Adding allocates;
// asking does not.
class SatelliteOrbits {
 public:
  SatelliteOrbits();
  ~SatelliteOrbits();
  SatelliteOrbits(SatelliteOrbits&&) noexcept;
  SatelliteOrbits& operator=(SatelliteOrbits&&) noexcept;

  // Keeps the set unless the same one (satellite, type, issue, times, health) is already here or
  // it is implausible. Says whether it is kept. A satellite has room for kMostSets of either kind;
  // then the one sent first goes.
  static constexpr std::size_t kMostSets = 600;
  bool Add(const KeplerEphemeris& ephemeris);
  bool Add(const StateEphemeris& ephemeris);
  // Precise orbits come first wherever they cover the time asked for. A satellite has room for
  // kMostSamples, and then loses the oldest. Positions stay those of the centre of mass.
  static constexpr std::size_t kMostSamples = 20'000;
  void Add(const PreciseOrbits& orbits);

  // State at transmission of a signal received at time_gps_ns with the given pseudorange by a
  // receiver whose clock was ahead by receiver_clock_s: solves for the time of transmission. Since
  // the pseudorange carries the receiver's clock error, the receiver's own reading with a
  // receiver_clock_s of zero means the same.
  //
  // Of several broadcast sets the newest already transmitted that is valid is taken; a set from the
  // future only where none from the past is near enough. kUnhealthy if that set says so, precise
  // orbits or not. *state is written only with kGood.
  OrbitVerdict AtTransmission(SatelliteId satellite, SignalCode signal, std::int64_t time_gps_ns,
                              double pseudorange_m, double receiver_clock_s,
                              SatelliteState* state) const;

  // State at a given time of transmission (GPS time plus a fraction in seconds).
  OrbitVerdict AtTime(SatelliteId satellite, SignalCode signal, std::int64_t time_gps_ns,
                      double fraction_s, SatelliteState* state) const;

  // FDMA channel of a GLONASS slot from its broadcast sets, or kUnknownGlonassChannel.
  std::int8_t GlonassChannel(int slot) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
