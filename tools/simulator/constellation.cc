#include "tools/simulator/constellation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/group_delay.h"

namespace lodemark {
namespace {

constexpr double kErrorPeriod_s = 43'000.0;  // broadcast errors turn about once per orbit

double EarthRotation(System system) {
  return system == System::kBeidou ? 7.2921150e-5 : 7.2921151467e-5;
}

// A Walker constellation with a little disorder, and the size of its broadcast errors.
struct Design {
  System system;
  MessageType type;
  int planes;
  int per_plane;
  double phasing_deg;  // between neighbours in adjacent planes
  double axis_m;
  double inclination_deg;
  double largest_eccentricity;
  double node_rate_radps;
  double motion_difference_radps;
  double radial_m, along_m, cross_m, clock_m;  // 1 sigma
  std::int64_t set_every_ns;
  std::int64_t sent_before_toe_ns;
};

constexpr std::int64_t kHour_ns = 3600 * kSecond_ns;

// IS-GPS-200, Galileo OS SIS ICD, GLONASS ICD and BDS ICD give the orbits; sizes of errors are
// those of the systems' performance reports.
constexpr std::array<Design, 4> kDesigns = {{
    {System::kGps, MessageType::kLnav, 6, 5, 24.0, 26'559.7e3, 55.0, 0.012, -8.1e-9, 4.6e-9, 0.20,
     0.9, 0.5, 0.45, 2 * kHour_ns, 2 * kHour_ns},
    {System::kGalileo, MessageType::kInav, 3, 8, 15.0, 29'600.3e3, 56.0, 0.0004, -5.4e-9, 3.1e-9,
     0.10, 0.3, 0.2, 0.15, kHour_ns, kHour_ns / 6},
    {System::kBeidou, MessageType::kD1, 3, 8, 15.0, 27'906.1e3, 55.0, 0.0009, -6.8e-9, 3.9e-9, 0.10,
     0.4, 0.4, 0.40, kHour_ns, 0},
    {System::kGlonass, MessageType::kFdma, 3, 8, 15.0, 25'508.0e3, 64.8, 0.002, 0.0, 0.0, 0.40, 1.4,
     0.9, 1.20, kHour_ns / 2, kHour_ns / 4},
}};

// PRNs of Galileo and BeiDou-3 in medium orbits, and the GPS satellites that send L5.
constexpr std::array<std::uint8_t, 24> kGalileoNumbers = {
    2, 3, 4, 5, 7, 8, 9, 10, 11, 12, 13, 15, 19, 21, 24, 25, 26, 27, 30, 31, 33, 34, 36, 6};
constexpr std::array<std::uint8_t, 24> kBeidouNumbers = {
    19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 32, 33, 34, 35, 36, 37, 41, 42, 43, 44, 45, 46};
constexpr std::array<std::uint8_t, 18> kGpsWithL5 = {1,  3,  4,  6,  8,  9,  10, 11, 14,
                                                     18, 23, 24, 25, 26, 27, 28, 30, 32};
constexpr std::array<std::int8_t, 24> kGlonassChannels = {1,  -4, 5, 6,  1, -4, 5, 6, -2, -7, 0, -1,
                                                          -2, -7, 0, -1, 4, -3, 3, 2, 4,  -3, 3, 2};

SatelliteId IdOf(System system, int index) {
  const std::size_t place = static_cast<std::size_t>(index);
  if (system == System::kGalileo) return {system, kGalileoNumbers[place]};
  if (system == System::kBeidou) return {system, kBeidouNumbers[place]};
  return {system, static_cast<std::uint8_t>(index + 1)};
}

std::vector<SignalCode> SignalsOf(SatelliteId id) {
  switch (id.system) {
    case System::kGps:
      if (std::find(kGpsWithL5.begin(), kGpsWithL5.end(), id.number) != kGpsWithL5.end()) {
        return {{'1', 'C'}, {'5', 'Q'}};
      }
      return {{'1', 'C'}};
    case System::kGalileo:
      return {{'1', 'C'}, {'5', 'Q'}};
    case System::kBeidou:
      return {{'2', 'I'}};
    default:
      return {{'1', 'C'}};
  }
}

// A multiple of step, as messages carry fixed-point numbers.
double Quantised(double value, double step) { return std::round(value / step) * step; }

std::int64_t FloorTo(std::int64_t time_ns, std::int64_t step_ns) {
  return time_ns - FloorModulo(time_ns, step_ns);
}

}  // namespace

// Fills SimulatedSatellite, whose errors are private to what At gives.
class ConstellationMaker {
 public:
  ConstellationMaker(const Scenario& scenario, const Design& design)
      : scenario_(scenario), design_(design) {}

  SimulatedSatellite Make(int plane, int slot) const {
    const int index = plane * design_.per_plane + slot;
    SimulatedSatellite satellite;
    satellite.id = IdOf(design_.system, index);
    satellite.signals = SignalsOf(satellite.id);
    // A stream of its own for every satellite.
    Random random(scenario_.seed * 1'000'003 + static_cast<std::uint64_t>(design_.system) * 1000 +
                  satellite.id.number);
    const std::int64_t length_ns =
        std::llround(static_cast<double>(scenario_.epochs) * scenario_.interval_s * 1e9);
    const std::int64_t end_ns = scenario_.start_gps_ns + length_ns;
    const KeplerEphemeris first = FirstSet(satellite.id, plane, slot, &random);
    satellite.reference_gps_ns_ = first.toe_gps_ns;
    if (design_.system == System::kGlonass) {
      satellite.glonass_channel = kGlonassChannels[static_cast<std::size_t>(index)];
      AddStateSets(first, end_ns, &random, &satellite);
    } else {
      for (std::int64_t shift_ns = 0;
           first.toe_gps_ns + shift_ns - design_.sent_before_toe_ns <= end_ns;
           shift_ns += design_.set_every_ns) {
        satellite.kepler_.push_back(Rereferenced(first, shift_ns));
      }
    }
    const auto wave = [&random](double sigma) {
      // A wave of amplitude a has the mean square a^2 / 2.
      const double amplitude = std::sqrt(2.0) * std::abs(sigma);
      return SimulatedSatellite::Wave{amplitude, random.Uniform(0.0, 2.0 * kPi)};
    };
    satellite.radial_m_ = wave(design_.radial_m);
    satellite.along_m_ = wave(design_.along_m);
    satellite.cross_m_ = wave(design_.cross_m);
    satellite.clock_s_ = wave(design_.clock_m / kSpeedOfLight_mps);
    return satellite;
  }

 private:
  KeplerEphemeris FirstSet(SatelliteId id, int plane, int slot, Random* random) const {
    KeplerEphemeris e;
    e.satellite = id;
    e.type = design_.type;
    // The set whose reference time was last before the start, on the system's own clock.
    const TimeScale scale = design_.system == System::kBeidou    ? TimeScale::kBeidou
                            : design_.system == System::kGlonass ? TimeScale::kGlonass
                                                                 : TimeScale::kGps;
    // GLONASS refers to the middle of its half hours: 15 and 45 minutes past.
    const std::int64_t shift_ns = design_.system == System::kGlonass ? kHour_ns / 4 : 0;
    const std::int64_t start_ns = ScaleFromGps(scenario_.start_gps_ns, scale) - shift_ns;
    e.toe_gps_ns = GpsFromScale(FloorTo(start_ns, design_.set_every_ns) + shift_ns, scale);
    e.toc_gps_ns = e.toe_gps_ns;
    e.transmitted_gps_ns = e.toe_gps_ns - design_.sent_before_toe_ns;
    e.issue_of_data = static_cast<std::int32_t>(FloorModulo(e.toe_gps_ns, kDay_ns) /
                                                (15 * 60 * kSecond_ns) % 255);
    e.issue_of_clock = e.issue_of_data;
    e.accuracy_m = design_.system == System::kGalileo ? 3.12 : 2.0;  // SISA, URA
    e.fit_interval_s = design_.system == System::kGps ? 4.0 * 3600.0 : 0.0;
    e.clock_bias_s = Quantised(random->Uniform(-4e-4, 4e-4), std::ldexp(1.0, -34));
    e.clock_drift_sps = Quantised(random->Uniform(-8e-12, 8e-12), std::ldexp(1.0, -46));
    e.semi_major_axis_m = design_.axis_m + random->Uniform(-3e3, 3e3);
    e.eccentricity = random->Uniform(0.1, 1.0) * design_.largest_eccentricity;
    e.argument_of_perigee_rad = random->Uniform(-kPi, kPi);
    const double latitude_deg =
        360.0 / design_.per_plane * slot + design_.phasing_deg * plane + random->Uniform(-4.0, 4.0);
    // The planes drift by a turn in eighteen days relative to the ground; any date's place will do.
    const double days = static_cast<double>(e.toe_gps_ns / kDay_ns % 3650);
    e.mean_anomaly_rad = std::remainder(
        latitude_deg * kRadiansPerDegree - e.argument_of_perigee_rad + 1.7 * days, 2.0 * kPi);
    e.mean_motion_difference_radps = design_.motion_difference_radps * random->Uniform(0.9, 1.1);
    e.inclination_rad = (design_.inclination_deg + random->Uniform(-0.8, 0.8)) * kRadiansPerDegree;
    e.inclination_rate_radps = random->Uniform(-4e-10, 4e-10);
    e.ascending_node_rad = std::remainder(
        2.0 * kPi * plane / design_.planes + random->Uniform(-0.03, 0.03) + 0.3, 2.0 * kPi);
    e.ascending_node_rate_radps = design_.node_rate_radps * random->Uniform(0.97, 1.03);
    if (design_.system == System::kGlonass) return e;
    e.cuc_rad = random->Uniform(-5e-6, 5e-6);
    e.cus_rad = random->Uniform(2e-6, 1e-5);
    e.cic_rad = random->Uniform(-1e-7, 1e-7);
    e.cis_rad = random->Uniform(-1e-7, 1e-7);
    e.crc_m = random->Uniform(120.0, 320.0);
    e.crs_m = random->Uniform(-100.0, 100.0);
    switch (design_.system) {
      case System::kGps:
        e.group_delays.tgd_s = Quantised(random->Uniform(-1.6e-8, 5e-9), std::ldexp(1.0, -31));
        break;
      case System::kGalileo:
        e.group_delays.bgd_e5a_e1_s = Quantised(random->Uniform(-6e-9, 6e-9), std::ldexp(1.0, -32));
        e.group_delays.bgd_e5b_e1_s = Quantised(random->Uniform(-6e-9, 6e-9), std::ldexp(1.0, -32));
        break;
      default:
        e.group_delays.tgd1_s = Quantised(random->Uniform(-9e-9, 9e-9), 1e-10);
        e.group_delays.tgd2_s = Quantised(random->Uniform(-9e-9, 9e-9), 1e-10);
        break;
    }
    return e;
  }

  // GLONASS: the Keplerian set gives position and velocity at the first reference time; later sets
  // follow by integration, so that they tell one orbit.
  void AddStateSets(const KeplerEphemeris& first, std::int64_t end_ns, Random* random,
                    SimulatedSatellite* satellite) const {
    const BroadcastState start = KeplerState(first, first.toe_gps_ns, 0.0);
    StateEphemeris set;
    set.satellite = first.satellite;
    set.toe_gps_ns = first.toe_gps_ns;
    set.glonass_channel = satellite->glonass_channel;
    set.clock_bias_s = Quantised(random->Uniform(-1e-4, 1e-4), std::ldexp(1.0, -30));
    set.frequency_bias = Quantised(random->Uniform(-2e-12, 2e-12), std::ldexp(1.0, -40));
    set.accuracy_m = 4.0;
    set.position_in_ecef = start.position_in_ecef;
    set.velocity_in_ecef = start.velocity_in_ecef;
    // Sun and moon pull with some 3e-6 m/s^2.
    for (int axis = 0; axis < 3; ++axis) {
      set.acceleration_in_ecef[axis] = Quantised(random->Uniform(-3e-6, 3e-6), 9.3132e-10);
    }
    while (set.toe_gps_ns - design_.sent_before_toe_ns <= end_ns) {
      set.transmitted_gps_ns = set.toe_gps_ns - design_.sent_before_toe_ns;
      satellite->states_.push_back(set);
      satellite->orbits_.emplace_back(set);
      const std::int64_t next_ns = set.toe_gps_ns + design_.set_every_ns;
      const BroadcastState next = satellite->orbits_.back().At(next_ns, 0.0);
      set.toe_gps_ns = next_ns;
      set.position_in_ecef = next.position_in_ecef;
      set.velocity_in_ecef = next.velocity_in_ecef;
      set.clock_bias_s = next.clock_bias_s;
    }
  }

  const Scenario& scenario_;
  const Design& design_;
};

double SimulatedSatellite::Wave::At(double turns) const {
  return amplitude * std::sin(2.0 * kPi * turns + phase_rad);
}

BroadcastState SimulatedSatellite::BroadcastAt(std::int64_t time_gps_ns, double fraction_s) const {
  if (!kepler_.empty()) return KeplerState(kepler_.front(), time_gps_ns, fraction_s);
  const StateOrbit* nearest = &orbits_.front();
  for (const StateOrbit& orbit : orbits_) {
    if (std::abs(orbit.ephemeris().toe_gps_ns - time_gps_ns) <
        std::abs(nearest->ephemeris().toe_gps_ns - time_gps_ns)) {
      nearest = &orbit;
    }
  }
  return nearest->At(time_gps_ns, fraction_s);
}

TrueSatelliteState SimulatedSatellite::At(std::int64_t time_gps_ns, double fraction_s) const {
  const BroadcastState broadcast = BroadcastAt(time_gps_ns, fraction_s);
  const Eigen::Vector3d radial = broadcast.position_in_ecef.normalized();
  const Eigen::Vector3d cross = radial.cross(broadcast.velocity_in_ecef).normalized();
  const Eigen::Vector3d along = cross.cross(radial);
  const double turns =
      (1e-9 * static_cast<double>(time_gps_ns - reference_gps_ns_) + fraction_s) / kErrorPeriod_s;
  TrueSatelliteState state;
  state.position_in_ecef = broadcast.position_in_ecef + radial_m_.At(turns) * radial +
                           along_m_.At(turns) * along + cross_m_.At(turns) * cross;
  state.clock_bias_s = broadcast.clock_bias_s + clock_s_.At(turns);
  return state;
}

double SimulatedSatellite::GroupDelay(SignalCode signal) const {
  if (kepler_.empty()) return 0.0;
  const KeplerEphemeris& set = kepler_.front();
  return GroupDelayCorrection(id, signal, ClockSource::kBroadcast, set.type, set.group_delays);
}

KeplerEphemeris Rereferenced(const KeplerEphemeris& ephemeris, std::int64_t shift_ns) {
  KeplerEphemeris moved = ephemeris;
  const double shift_s = 1e-9 * static_cast<double>(shift_ns);
  const double gm_m3ps2 = ephemeris.satellite.system == System::kGps ? 3.986005e14 : 3.986004418e14;
  const double axis_m = ephemeris.semi_major_axis_m;
  const double motion_radps =
      std::sqrt(gm_m3ps2 / (axis_m * axis_m * axis_m)) + ephemeris.mean_motion_difference_radps;
  moved.mean_anomaly_rad =
      std::remainder(ephemeris.mean_anomaly_rad + motion_radps * shift_s, 2.0 * kPi);
  moved.inclination_rad += ephemeris.inclination_rate_radps * shift_s;
  const TimeScale scale =
      ephemeris.satellite.system == System::kBeidou ? TimeScale::kBeidou : TimeScale::kGps;
  moved.toe_gps_ns += shift_ns;
  moved.toc_gps_ns += shift_ns;
  moved.transmitted_gps_ns += shift_ns;
  // The node is told as of the start of the week: each new week turns it by a week of rotation.
  const std::int64_t weeks = ScaleFromGps(moved.toe_gps_ns, scale) / kWeek_ns -
                             ScaleFromGps(ephemeris.toe_gps_ns, scale) / kWeek_ns;
  moved.ascending_node_rad = std::remainder(
      ephemeris.ascending_node_rad + ephemeris.ascending_node_rate_radps * shift_s -
          EarthRotation(ephemeris.satellite.system) * 604'800.0 * static_cast<double>(weeks),
      2.0 * kPi);
  moved.clock_bias_s +=
      shift_s * (ephemeris.clock_drift_sps + shift_s * ephemeris.clock_drift_rate_sps2);
  moved.clock_drift_sps += 2.0 * ephemeris.clock_drift_rate_sps2 * shift_s;
  moved.issue_of_data = static_cast<std::int32_t>(FloorModulo(moved.toe_gps_ns, kDay_ns) /
                                                  (15 * 60 * kSecond_ns) % 255);
  moved.issue_of_clock = moved.issue_of_data;
  return moved;
}

std::vector<SimulatedSatellite> MakeConstellation(const Scenario& scenario) {
  std::vector<SimulatedSatellite> satellites;
  for (const Design& design : kDesigns) {
    if (scenario.systems.find(SystemLetter(design.system)) == std::string::npos) continue;
    const ConstellationMaker maker(scenario, design);
    for (int plane = 0; plane < design.planes; ++plane) {
      for (int slot = 0; slot < design.per_plane; ++slot) {
        satellites.push_back(maker.Make(plane, slot));
      }
    }
  }
  return satellites;
}

KlobucharParameters SimulatedIonosphere() {
  KlobucharParameters parameters;
  parameters.system = System::kGps;
  parameters.alpha = {2.2352e-08, 1.4901e-08, -1.1921e-07, -5.9605e-08};
  parameters.beta = {1.2288e+05, 1.6384e+04, -2.6214e+05, 1.9661e+05};
  return parameters;
}

}  // namespace lodemark
