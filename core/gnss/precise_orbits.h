// Tables of precise satellite positions and clocks (SP3), and their interpolation.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/gnss/signal.h"

namespace lodemark {

struct PreciseSample {
  std::int64_t time_gps_ns = 0;
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();  // centre of mass
  double clock_bias_s = 0.0;
  double position_sigma_m = 0.0;  // 0 if unknown
  bool has_clock = false;
  bool clock_event = false;  // the clock jumped since the sample before
  bool maneuver = false;
  bool predicted = false;
};

// Samples per satellite in ascending time.
struct PreciseOrbits {
  std::map<SatelliteId, std::vector<PreciseSample>> samples;
};

struct PreciseState {
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_ecef = Eigen::Vector3d::Zero();
  double clock_bias_s = 0.0;  // without the relativistic term
  double clock_drift_sps = 0.0;
};

// Polynomial interpolation of the positions through eleven samples, as nearly centred as the table
// allows, and linear interpolation of the clocks, at time_gps_ns + fraction_s. Empty where the
// table does not reach, has a gap or a manoeuvre within the samples it needs, lacks the clock or
// says that it jumped.
// It never extrapolates: one interval beyond its end the polynomial makes a metre of a millimetre's
// rounding.
std::optional<PreciseState> InterpolatePrecise(const std::vector<PreciseSample>& samples,
                                               std::int64_t time_gps_ns, double fraction_s);

}  // namespace lodemark
