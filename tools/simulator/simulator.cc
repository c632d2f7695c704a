#include "tools/simulator/simulator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/android_signal_time.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/troposphere.h"

namespace lodemark {
namespace {

constexpr std::int64_t kFirstHardware_ns = 184'263LL * kSecond_ns;
constexpr double kFirstTag_ns = 163'421.37;  // the first epoch after the whole second
constexpr double kEarthRotation_radps = 7.2921151467e-5;
constexpr double kGpsL1_hz = 1575.42e6;
constexpr double kAcquired_dbhz = 16.0;
constexpr double kLost_dbhz = 13.5;
constexpr double kPhaseLocked_dbhz = 23.0;

// Delays in the phone's radio, which no model knows: metres against GPS L1 C/A.
double HardwareDelay(SatelliteId satellite, SignalCode signal, std::int8_t glonass_channel) {
  switch (satellite.system) {
    case System::kGalileo:
      return signal.band == '5' ? 6.4 : -1.3;
    case System::kGlonass:
      return 4.2 + 0.35 * glonass_channel;
    case System::kBeidou:
      return -2.1;
    default:
      return signal.band == '5' ? 7.9 : 0.0;
  }
}

std::int32_t ConstellationType(System system) {
  switch (system) {
    case System::kGlonass:
      return 3;
    case System::kBeidou:
      return 5;
    case System::kGalileo:
      return 6;
    default:
      return 1;
  }
}

std::int32_t TrackingState(System system, SignalCode signal) {
  switch (system) {
    case System::kGlonass:
      return kStateCodeLock | kStateBitSync | kStateGlonassStringSync | kStateGlonassTodDecoded |
             kStateGlonassTodKnown;
    case System::kGalileo:
      if (signal.band == '1') {
        return kStateGalileoE1bcCodeLock | kStateGalileoE1cSecondaryCodeLock |
               kStateGalileoE1bPageSync | kStateTowDecoded | kStateTowKnown;
      }
      return kStateCodeLock | kStateSecondaryCodeLock | kStateTowDecoded | kStateTowKnown;
    default:
      return kStateCodeLock | kStateBitSync | kStateSubframeSync | kStateTowDecoded |
             kStateTowKnown | (signal.band == '5' ? kStateSecondaryCodeLock : 0);
  }
}

// Time of week, or of day for GLONASS, that the satellite's system shows at a GPS time.
std::int64_t SystemTimeOf(System system, std::int64_t time_gps_ns) {
  switch (system) {
    case System::kGlonass:
      return FloorModulo(ScaleFromGps(time_gps_ns, TimeScale::kGlonass), kDay_ns);
    case System::kBeidou:
      return FloorModulo(ScaleFromGps(time_gps_ns, TimeScale::kBeidou), kWeek_ns);
    default:
      return FloorModulo(time_gps_ns, kWeek_ns);
  }
}

double ChipLength(SignalCode signal) {
  return kSpeedOfLight_mps / (signal.band == '5' ? 10.23e6 : 1.023e6);
}

SignalSurroundings SurroundingsOf(const Scenario& scenario) {
  Result<SignalSurroundings> made = SignalSurroundings::Make(scenario.photography.scene.buildings);
  return made ? std::move(*made) : SignalSurroundings();
}

double RoundedTo(double value, double step) { return std::round(value / step) * step; }

}  // namespace

Simulator::Simulator(const Scenario& scenario)
    : scenario_(scenario),
      surroundings_(SurroundingsOf(scenario)),
      frame_(scenario.place),
      path_(scenario),
      satellites_(MakeConstellation(scenario)),
      ionosphere_(SimulatedIonosphere()),
      random_(scenario.seed),
      time_error_ns_(12.0, 40.0, &random_),
      interval_ns_(std::llround(scenario.interval_s * 1e9)),
      hardware_ns_(kFirstHardware_ns),
      true_gps_ns_(scenario.start_gps_ns + static_cast<std::int64_t>(kFirstTag_ns)),
      true_fraction_ns_(kFirstTag_ns - std::floor(kFirstTag_ns)),
      drift_nsps_(scenario.clock_drift_nsps) {
  const bool moving = scenario.waypoints_m.size() > 1;
  for (const SimulatedSatellite& satellite : satellites_) {
    for (const SignalCode signal : satellite.signals) {
      const double frequency_hz =
          CarrierFrequency(satellite.id.system, signal.band, satellite.glonass_channel)
              .value_or(kGpsL1_hz);
      channels_.push_back({&satellite, signal, frequency_hz,
                           SignalErrors(satellite.id, signal, scenario.multipath_sigma_m, moving,
                                        surroundings_.empty(), scenario.seed)});
    }
  }
}

double Simulator::progress() const {
  return static_cast<double>(epoch_) / static_cast<double>(scenario_.epochs);
}

// The hardware clock ticks whole intervals; true time passes a little slower or faster.
void Simulator::StepClock() {
  if (epoch_ == 0) return;
  hardware_ns_ += interval_ns_;
  drift_nsps_ += random_.Gaussian(0.0, 0.25 * std::sqrt(scenario_.interval_s));
  const double rate = 1e-9 * drift_nsps_;
  const double gained_ns = static_cast<double>(interval_ns_) * rate / (1.0 + rate);
  clock_advance_ns_ += gained_ns;
  const double fraction_ns = true_fraction_ns_ - gained_ns;
  const double whole_ns = std::floor(fraction_ns);
  true_gps_ns_ += interval_ns_ + static_cast<std::int64_t>(whole_ns);
  true_fraction_ns_ = fraction_ns - whole_ns;
}

void Simulator::ReportClock(AndroidClock* clock) {
  *clock = {};
  clock->time_ns = hardware_ns_;
  // GPS time is time - (full bias + bias); the phone knows it to some nanoseconds.
  const double believed_ns =
      true_fraction_ns_ + time_error_ns_.Step(scenario_.interval_s, &random_);
  const double whole_ns = std::round(believed_ns);
  clock->full_bias_ns = hardware_ns_ - true_gps_ns_ - static_cast<std::int64_t>(whole_ns);
  clock->bias_ns = whole_ns - believed_ns;
  clock->bias_uncertainty_ns = 15.0;
  clock->drift_nsps = drift_nsps_ + random_.Gaussian(0.0, 0.4);
  clock->drift_uncertainty_nsps = 0.8;
  clock->leap_second = LeapSecondsAtGps(true_gps_ns_);
  clock->elapsed_realtime_ns = hardware_ns_ + 41'512'733;
  clock->present = kClockHasLeapSecond | kClockHasFullBias | kClockHasBias |
                   kClockHasBiasUncertainty | kClockHasDrift | kClockHasDriftUncertainty |
                   kClockHasElapsedRealtime;
}

// Geometric range less c times the satellite clock, for a signal received offset_s after the
// epoch.
double Simulator::ClockLessRange(const SimulatedSatellite& satellite, double offset_s) const {
  const double since_start_s =
      1e-9 * (static_cast<double>(true_gps_ns_ - scenario_.start_gps_ns) + true_fraction_ns_);
  const Eigen::Vector3d receiver =
      frame_.ToEcef(path_.At(since_start_s + offset_s).position_in_enu);
  const double fraction_s = 1e-9 * true_fraction_ns_ + offset_s;
  double travel_s = 0.075;
  double range_m = 0.0;
  TrueSatelliteState state;
  for (int iteration = 0; iteration < 4; ++iteration) {
    state = satellite.At(true_gps_ns_, fraction_s - travel_s);
    // The earth turns while the signal travels.
    const Eigen::AngleAxisd turn(-kEarthRotation_radps * travel_s, Eigen::Vector3d::UnitZ());
    range_m = (turn * state.position_in_ecef - receiver).norm();
    travel_s = range_m / kSpeedOfLight_mps;
  }
  return range_m - kSpeedOfLight_mps * state.clock_bias_s;
}

Simulator::Sight Simulator::SightOf(const SimulatedSatellite& satellite) const {
  constexpr double kHalfStep_s = 0.05;
  const double since_start_s =
      1e-9 * (static_cast<double>(true_gps_ns_ - scenario_.start_gps_ns) + true_fraction_ns_);
  const ReceiverState state = path_.At(since_start_s);
  const Eigen::Vector3d receiver = frame_.ToEcef(state.position_in_enu);
  const Geodetic place = GeodeticFromEcef(receiver);
  Sight sight;
  sight.look = LookAnglesTo(satellite.At(true_gps_ns_, -0.075).position_in_ecef, receiver,
                            EnuFromEcefRotation(place));
  if (sight.look.elevation_rad < 0.0) return sight;
  sight.range_m = ClockLessRange(satellite, 0.0);
  sight.rate_mps =
      (ClockLessRange(satellite, kHalfStep_s) - ClockLessRange(satellite, -kHalfStep_s)) /
      (2.0 * kHalfStep_s);
  // A day somewhat wetter than the climate's mean.
  const Troposphere troposphere(place, true_gps_ns_);
  const MappingFactors mapping = troposphere.Mapping(sight.look.elevation_rad);
  sight.troposphere_m = 1.002 * troposphere.zenith().hydrostatic_m * mapping.hydrostatic +
                        1.2 * troposphere.zenith().wet_m * mapping.wet;
  sight.paths =
      surroundings_.To(state.position_in_enu, state.velocity_in_enu,
                       DirectionFromAngles(sight.look.azimuth_rad, sight.look.elevation_rad),
                       kSpeedOfLight_mps / kGpsL1_hz);
  return sight;
}

void Simulator::Measure(const Sight& sight, Channel* channel, AndroidEpoch* raw) {
  const SimulatedSatellite& satellite = *channel->satellite;
  const ReceivedPaths received =
      Receive(sight.paths, kSpeedOfLight_mps / channel->frequency_hz, ChipLength(channel->signal));
  const SignalDisturbance disturbance =
      channel->errors.Step(sight.look.elevation_rad, received, scenario_.interval_s);
  const double needed_dbhz = channel->tracked ? kLost_dbhz : kAcquired_dbhz;
  const bool above = sight.look.elevation_rad > scenario_.elevation_mask_deg * kRadiansPerDegree;
  channel->tracked = above && disturbance.cn0_dbhz > needed_dbhz;
  const bool slip = random_.Uniform() < 0.001;
  if (!channel->tracked) {
    channel->phase_locked = false;
    return;
  }
  const double ionosphere_m =
      disturbance.ionosphere_scale *
      KlobucharDelay(ionosphere_, scenario_.place, sight.look, true_gps_ns_, channel->frequency_hz);
  const double delay_m = HardwareDelay(satellite.id, channel->signal, satellite.glonass_channel) -
                         kSpeedOfLight_mps * satellite.GroupDelay(channel->signal);
  const double shared_m = sight.range_m + sight.troposphere_m + delay_m;
  const double code_m = shared_m + ionosphere_m + disturbance.code_error_m;
  // On the hardware clock the range grows with the clock's advance as well.
  const double phase_m = shared_m - ionosphere_m + disturbance.phase_error_m +
                         1e-9 * kSpeedOfLight_mps * clock_advance_ns_;

  AndroidMeasurement m;
  m.svid = satellite.id.number;
  m.constellation_type = ConstellationType(satellite.id.system);
  m.state = TrackingState(satellite.id.system, channel->signal);
  // Integers first: only the travel time, below 0.2 s, is a double.
  const double sent_ns = true_fraction_ns_ - code_m / kSpeedOfLight_mps * 1e9;
  m.received_sv_time_ns = SystemTimeOf(satellite.id.system, true_gps_ns_ + std::llround(sent_ns));
  m.received_sv_time_uncertainty_ns =
      std::max<std::int64_t>(2, std::llround(disturbance.code_sigma_m / kSpeedOfLight_mps * 1.3e9));
  m.cn0_dbhz = RoundedTo(disturbance.cn0_dbhz, 0.1);
  m.baseband_cn0_dbhz = RoundedTo(disturbance.cn0_dbhz - 3.6, 0.1);
  m.pseudorange_rate_mps =
      sight.rate_mps + 1e-9 * kSpeedOfLight_mps * drift_nsps_ + disturbance.rate_error_mps;
  m.pseudorange_rate_uncertainty_mps = disturbance.rate_sigma_mps;

  // From the straight way to the one off a wall, or back, the phase does not carry on.
  const bool was_locked = channel->phase_locked && channel->on_reflection == received.is_reflection;
  channel->on_reflection = received.is_reflection;
  channel->phase_locked = disturbance.cn0_dbhz > kPhaseLocked_dbhz;
  constexpr std::int32_t kValid = 1, kReset = 2, kSlip = 4, kHalfCycleResolved = 8;
  if (channel->phase_locked && !was_locked) {
    channel->phase_origin_m = phase_m;
    m.accumulated_delta_range_state = kValid | kReset | kHalfCycleResolved;
  } else if (channel->phase_locked && slip) {
    channel->phase_origin_m += 11.0 * kSpeedOfLight_mps / channel->frequency_hz;
    m.accumulated_delta_range_state = kValid | kSlip | kHalfCycleResolved;
  } else if (channel->phase_locked) {
    m.accumulated_delta_range_state = kValid | kHalfCycleResolved;
  }
  m.accumulated_delta_range_m = channel->phase_locked ? phase_m - channel->phase_origin_m : 0.0;
  m.accumulated_delta_range_uncertainty_m = disturbance.phase_sigma_m;
  m.carrier_frequency_hz = static_cast<double>(static_cast<float>(channel->frequency_hz));
  m.agc_db = channel->signal.band == '5' ? 31.5 : 43.0;
  std::strncpy(m.code_type,
               channel->signal.attribute == 'Q'   ? "Q"
               : channel->signal.attribute == 'I' ? "I"
                                                  : "C",
               sizeof m.code_type - 1);
  m.present = kMeasurementHasCarrierFrequency | kMeasurementHasAccumulatedDeltaRange |
              kMeasurementHasAgc | kMeasurementHasBasebandCn0 | kMeasurementHasCodeType |
              kMeasurementHasReceivedTimeUncertainty | kMeasurementHasRangeRate |
              kMeasurementHasRangeRateUncertainty | kMeasurementHasCn0;
  raw->measurements.push_back(m);
}

bool Simulator::Next(SimulatedEpoch* epoch) {
  if (epoch_ >= scenario_.epochs) return false;
  StepClock();
  epoch->true_gps_ns = true_gps_ns_;
  epoch->true_fraction_ns = true_fraction_ns_;
  epoch->receiver = path_.At(
      1e-9 * (static_cast<double>(true_gps_ns_ - scenario_.start_gps_ns) + true_fraction_ns_));
  epoch->raw.measurements.clear();
  epoch->paths.clear();
  ReportClock(&epoch->raw.clock);
  const SimulatedSatellite* current = nullptr;
  Sight sight;
  for (Channel& channel : channels_) {
    if (channel.satellite != current) {
      current = channel.satellite;
      sight = SightOf(*current);
      if (sight.look.elevation_rad > scenario_.elevation_mask_deg * kRadiansPerDegree) {
        epoch->paths.push_back({current->id, sight.look, sight.paths});
      }
    }
    if (sight.look.elevation_rad > 0.0) Measure(sight, &channel, &epoch->raw);
  }
  ++epoch_;
  return true;
}

}  // namespace lodemark
