// Raw GNSS measurements of a simulated phone, epoch by epoch, with the truth behind them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/random.h"
#include "core/geo/geodetic.h"
#include "core/gnss/android_measurement.h"
#include "tools/simulator/constellation.h"
#include "tools/simulator/receiver_path.h"
#include "tools/simulator/scenario.h"
#include "tools/simulator/signal_errors.h"
#include "tools/simulator/signal_paths.h"

namespace lodemark {

struct SimulatedEpoch {
  AndroidEpoch raw;
  std::int64_t true_gps_ns = 0;   // of the measurement, whole nanoseconds
  double true_fraction_ns = 0.0;  // to be added, 0 .. 1
  ReceiverState receiver;         // in the frame of Scenario::place
  // Every satellite above the mask, tracked or not, on L1.
  struct Path {
    SatelliteId satellite;
    LookAngles look;
    SignalPaths paths;
  };
  std::vector<Path> paths;
};

class Simulator {
 public:
  // Footprints that cannot be cut into convex parts let everything through; ScenarioFromJson takes
  // none.
  explicit Simulator(const Scenario& scenario);

  // False once Scenario::epochs have been given.
  bool Next(SimulatedEpoch* epoch);

  // Seconds since Scenario::start_gps_ns.
  ReceiverState TruthAt(double time_s) const { return path_.At(time_s); }
  const EnuFrame& frame() const { return frame_; }
  const std::vector<SimulatedSatellite>& satellites() const { return satellites_; }
  double progress() const;

 private:
  // One signal of one satellite, tracked or not.
  struct Channel {
    const SimulatedSatellite* satellite;
    SignalCode signal;
    double frequency_hz;
    SignalErrors errors;
    bool tracked = false;
    bool phase_locked = false;
    bool on_reflection = false;
    double phase_origin_m = 0.0;
  };

  // What is common to the signals of one satellite at one epoch.
  struct Sight {
    double range_m = 0.0;  // geometric, less the satellite clock
    double rate_mps = 0.0;
    LookAngles look;
    double troposphere_m = 0.0;
    SignalPaths paths;  // for the wavelength of L1
  };

  void StepClock();
  void ReportClock(AndroidClock* clock);
  double ClockLessRange(const SimulatedSatellite& satellite, double offset_s) const;
  Sight SightOf(const SimulatedSatellite& satellite) const;
  void Measure(const Sight& sight, Channel* channel, AndroidEpoch* raw);

  Scenario scenario_;
  SignalSurroundings surroundings_;
  EnuFrame frame_;
  ReceiverPath path_;
  std::vector<SimulatedSatellite> satellites_;
  std::vector<Channel> channels_;
  KlobucharParameters ionosphere_;
  Random random_;
  GaussMarkov time_error_ns_;  // of what the phone believes of GPS time

  int epoch_ = 0;
  std::int64_t interval_ns_;
  std::int64_t hardware_ns_;  // AndroidClock::time_ns
  std::int64_t true_gps_ns_;
  double true_fraction_ns_;
  double drift_nsps_;
  double clock_advance_ns_ = 0.0;  // hardware clock less true time, since the first epoch
};

}  // namespace lodemark
