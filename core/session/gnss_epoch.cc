#include "core/session/gnss_epoch.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "core/session/atmosphere_above.h"

namespace lodemark {
namespace {

constexpr double kEarthRotation_radps = 7.2921151467e-5;

// Orbit and clock errors of broadcast sets projected on the line of sight, where no accuracy is
// stated, and the share of a stated URA, an upper bound, that is real.
constexpr double kUnstatedOrbitSigma_m = 1.0;
constexpr double kUraShare = 0.4;
constexpr double kPreciseOrbitSigma_m = 0.1;

// What an ionosphere model leaves is mostly common to all satellites and goes into the receiver
// clock; this share of its sigma differs between them.
constexpr double kIonosphereOwnShare = 0.4;

// Of a carrier phase at 40 dBHz and above, reflections included.
constexpr double kPhaseSigma_m = 0.008;

// Code delay of a receiver differs between FDMA channels.
constexpr double kGlonassChannelSigma_m = 2.0;

// Band pairs whose satellites' group delays the messages tell well enough to multiply them by the
// factors of the combination: GPS clocks are defined by L1 and L2, Galileo's by E1 with E5a or E5b,
// BeiDou's by B3. GPS L5 would need CNAV's corrections; GLONASS channels differ by metres.
bool CanCombine(const PreparedSignal& first, const PreparedSignal& second) {
  if (first.satellite_id.system == System::kGalileo ||
      first.satellite_id.system == System::kBeidou) {
    return std::abs(first.frequency_hz - second.frequency_hz) > 200e6;
  }
  return (first.satellite_id.system == System::kGps ||
          first.satellite_id.system == System::kQzss) &&
         first.band == '1' && second.band == '2';
}

// Turns a vector by the earth's rotation during the flight of the signal.
Eigen::Vector3d RotateByFlight(const Eigen::Vector3d& vector, double flight_s) {
  const double angle = kEarthRotation_radps * flight_s;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * vector.x() + s * vector.y(), -s * vector.x() + c * vector.y(), vector.z()};
}

SatelliteVerdict VerdictOf(OrbitVerdict verdict) {
  switch (verdict) {
    case OrbitVerdict::kTooOld:
      return SatelliteVerdict::kEphemerisTooOld;
    case OrbitVerdict::kUnhealthy:
      return SatelliteVerdict::kUnhealthy;
    case OrbitVerdict::kNoEphemeris:
    case OrbitVerdict::kGood:
      break;
  }
  return SatelliteVerdict::kNoEphemeris;
}

double OrbitSigma(const SatelliteState& state) {
  if (state.precise) return kPreciseOrbitSigma_m;
  if (state.accuracy_m <= 0.0) return kUnstatedOrbitSigma_m;
  return std::clamp(kUraShare * state.accuracy_m, 0.5, 100.0);
}

}  // namespace

int ClockGroups::Group(System system, char band, char second_band) {
  for (int i = 0; i < count_; ++i) {
    const Key& key = keys_[static_cast<std::size_t>(i)];
    if (key.system == system && key.band == band && key.second_band == second_band) return i;
  }
  if (count_ == kMaxClockGroups) return -1;
  keys_[static_cast<std::size_t>(count_)] = {system, band, second_band};
  return count_++;
}

void GnssEpochModel::FindSatellites(const ObservationEpoch& epoch, const SatelliteOrbits& orbits,
                                    std::vector<SatelliteStatus>* statuses) {
  prepared_.clear();
  used_.clear();
  ranges_.clear();
  rates_.clear();
  rate_signals_.clear();
  phases_.clear();
  for (std::size_t i = 0; i < epoch.signals.size(); ++i) {
    const SignalObservation& signal = epoch.signals[i];
    SatelliteStatus& status = (*statuses)[i];
    status = SatelliteStatus();
    status.satellite = signal.satellite;
    status.signal = signal.signal;
    status.cn0_dbhz = signal.Has(kHasCn0) ? signal.cn0_dbhz : 0.0;
    if ((options_.systems >> static_cast<int>(signal.satellite.system) & 1u) == 0) {
      status.verdict = SatelliteVerdict::kSystemOff;
      continue;
    }
    if (!signal.Has(kHasPseudorange)) {
      status.verdict = SatelliteVerdict::kNotTracking;
      continue;
    }
    PreparedSignal prepared;
    prepared.index = i;
    prepared.satellite_id = signal.satellite;
    prepared.band = signal.signal.band;
    const OrbitVerdict verdict =
        orbits.AtTransmission(signal.satellite, signal.signal, epoch.time_gps_ns,
                              signal.pseudorange_m, 0.0, &prepared.satellite);
    if (verdict != OrbitVerdict::kGood) {
      status.verdict = VerdictOf(verdict);
      continue;
    }
    // Old files do not say which FDMA channel a GLONASS slot uses; its ephemeris does.
    prepared.frequency_hz = signal.frequency_hz > 0.0
                                ? signal.frequency_hz
                                : CarrierFrequency(signal.satellite.system, signal.signal.band,
                                                   prepared.satellite.glonass_channel)
                                      .value_or(0.0);
    if (!(prepared.frequency_hz > 0.0)) {
      status.verdict = SatelliteVerdict::kUnknownSignal;
      continue;
    }
    prepared.clock_group = groups_.Group(signal.satellite.system, signal.signal.band, ' ');
    if (prepared.clock_group < 0) {
      status.verdict = SatelliteVerdict::kUnknownSignal;
      continue;
    }
    prepared_.push_back(prepared);
  }
}

void GnssEpochModel::NoteStrengths(const ObservationEpoch& epoch, RangeWeights* weights) const {
  for (const PreparedSignal& prepared : prepared_) {
    const SignalObservation& signal = epoch.signals[prepared.index];
    if (signal.Has(kHasCn0)) weights->NoteStrength(prepared.clock_group, signal.cn0_dbhz);
    if (signal.satellite.system == System::kGps && signal.signal.band == '2') {
      weights->NoteSurveyingReceiver();
    }
  }
}

const std::vector<RangeObservation>& GnssEpochModel::CoarseRanges(const ObservationEpoch& epoch) {
  ranges_.clear();
  for (const PreparedSignal& prepared : prepared_) {
    const SignalObservation& signal = epoch.signals[prepared.index];
    RangeObservation range;
    // A usual flight time turns the satellite to within some hundred metres.
    constexpr double kUsualFlight_s = 0.075;
    range.point_in_ecef = RotateByFlight(prepared.satellite.position_in_ecef, kUsualFlight_s);
    range.range_m = signal.pseudorange_m + kSpeedOfLight_mps * prepared.satellite.clock_bias_s;
    range.clock_group = prepared.clock_group;
    range.error.sigma_m = 10.0;
    ranges_.push_back(range);
  }
  return ranges_;
}

void GnssEpochModel::Model(const ObservationEpoch& epoch, const Eigen::Vector3d& place_in_ecef,
                           const IonosphereModel& ionosphere, const RangeWeights& weights,
                           const std::vector<double>& rate_disagreements_m,
                           std::vector<SatelliteStatus>* statuses) {
  used_.clear();
  ranges_.clear();
  rates_.clear();
  rate_signals_.clear();
  phases_.clear();
  merged_.clear();
  place_in_ecef_ = place_in_ecef;
  const Geodetic place = GeodeticFromEcef(place_in_ecef);
  const AtmosphereAbove atmosphere(options_, ionosphere, place, place_in_ecef, epoch.time_gps_ns);
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(place);
  // Beside ranges free of the ionosphere, what it leaves in the others is not common any more.
  const bool combine = weights.surveying() && options_.ionosphere != IonosphereChoice::kNone;
  const double ionosphere_share = combine ? 1.0 : kIonosphereOwnShare;
  for (PreparedSignal prepared : prepared_) {
    const SignalObservation& signal = epoch.signals[prepared.index];
    SatelliteStatus& status = (*statuses)[prepared.index];
    const double flight_s =
        (prepared.satellite.position_in_ecef - place_in_ecef).norm() / kSpeedOfLight_mps;
    prepared.satellite_in_ecef = RotateByFlight(prepared.satellite.position_in_ecef, flight_s);
    prepared.satellite_velocity_in_ecef =
        RotateByFlight(prepared.satellite.velocity_in_ecef, flight_s);
    const LookAngles look = LookAnglesTo(prepared.satellite_in_ecef, place_in_ecef, enu_from_ecef);
    prepared.elevation_rad = look.elevation_rad;
    prepared.azimuth_rad = look.azimuth_rad;
    status.elevation_rad = look.elevation_rad;
    status.azimuth_rad = look.azimuth_rad;
    status.has_direction = true;
    NoteSight(prepared, &status);
    if (look.elevation_rad < options_.elevation_mask_rad) {
      status.verdict = SatelliteVerdict::kLowElevation;
      continue;
    }
    if (signal.Has(kHasCn0) && signal.cn0_dbhz < options_.smallest_cn0_dbhz) {
      status.verdict = SatelliteVerdict::kWeakSignal;
      continue;
    }
    const AtmosphereDelays air =
        atmosphere.At(prepared.satellite_in_ecef, look, prepared.frequency_hz);
    prepared.ionosphere_m = air.ionosphere_m;
    prepared.troposphere_m = air.troposphere_m;
    const double orbit_sigma_m = OrbitSigma(prepared.satellite);
    prepared.ionosphere_variance_m2 = air.ionosphere_sigma_m * air.ionosphere_sigma_m;
    const double channel_sigma_m =
        signal.satellite.system == System::kGlonass ? kGlonassChannelSigma_m : 0.0;
    prepared.own_variance_m2 = orbit_sigma_m * orbit_sigma_m +
                               air.troposphere_sigma_m * air.troposphere_sigma_m +
                               channel_sigma_m * channel_sigma_m;

    RangeObservation range;
    range.point_in_ecef = prepared.satellite_in_ecef;
    range.range_m = signal.pseudorange_m + kSpeedOfLight_mps * prepared.satellite.clock_bias_s -
                    prepared.ionosphere_m - prepared.troposphere_m;
    range.clock_group = prepared.clock_group;
    range.zenith_delay_factor = air.wet_mapping;
    SignalQuality quality = QualityOf(signal, prepared, ionosphere_share);
    quality.rate_disagreement_m = rate_disagreements_m[prepared.index];
    if (status.has_sight) quality.sight_probability = status.sight_probability;
    prepared.weight = weights.ErrorModel(prepared.clock_group, quality);
    range.error = prepared.weight.error;
    status.sigma_m = range.error.sigma_m;

    if (signal.Has(kHasDoppler)) AddRate(signal, prepared, place_in_ecef);
    // Only a filter asks for them.
    if (options_.estimator != Estimator::kEpoch && signal.Has(kHasCarrierPhase)) {
      AddPhase(signal, prepared);
    }
    used_.push_back(prepared);
    ranges_.push_back(range);
  }
  if (combine) CombineBands(weights);
}

void GnssEpochModel::NoteSight(const PreparedSignal& prepared, SatelliteStatus* status) const {
  if (sights_ == nullptr || !(prepared.elevation_rad > 0.0)) return;
  const std::optional<double> probability = sights_->ProbabilityOfSight(
      prepared.satellite_id, {prepared.azimuth_rad, prepared.elevation_rad},
      kSpeedOfLight_mps / prepared.frequency_hz);
  status->has_sight = probability.has_value();
  status->sight_probability = probability.value_or(0.0);
}

SignalQuality GnssEpochModel::QualityOf(const SignalObservation& signal,
                                        const PreparedSignal& prepared,
                                        double ionosphere_share) const {
  SignalQuality quality;
  quality.cn0_dbhz = signal.Has(kHasCn0) ? signal.cn0_dbhz : 0.0;
  quality.elevation_rad = prepared.elevation_rad;
  quality.reported_sigma_m = signal.Has(kHasPseudorangeSigma) ? signal.pseudorange_sigma_m : 0.0;
  quality.model_sigma_m = std::sqrt(prepared.own_variance_m2 + ionosphere_share * ionosphere_share *
                                                                   prepared.ionosphere_variance_m2);
  quality.wideband =
      signal.signal.band == '5' || signal.signal.band == '7' || signal.signal.band == '8';
  quality.multipath_reported = (signal.flags & kMultipathDetected) != 0;
  return quality;
}

void GnssEpochModel::AddRate(const SignalObservation& signal, const PreparedSignal& prepared,
                             const Eigen::Vector3d& place_in_ecef) {
  RangeRateObservation rate;
  rate.direction_in_ecef = (prepared.satellite_in_ecef - place_in_ecef).normalized();
  const double wavelength_m = kSpeedOfLight_mps / prepared.frequency_hz;
  // The satellite's part of the rate moves over; the time of flight changes with the rate too.
  const double satellite_rate_mps = prepared.satellite_velocity_in_ecef.dot(rate.direction_in_ecef);
  rate.rate_mps = -signal.doppler_hz * wavelength_m -
                  satellite_rate_mps * (1.0 - satellite_rate_mps / kSpeedOfLight_mps) +
                  kSpeedOfLight_mps * prepared.satellite.clock_drift_sps;
  const double cn0_dbhz = signal.Has(kHasCn0) && signal.cn0_dbhz > 0.0 ? signal.cn0_dbhz : 40.0;
  const double noise_mps = 0.1 * std::pow(10.0, (40.0 - cn0_dbhz) / 20.0);
  rate.sigma_mps = std::hypot(0.05, noise_mps);
  if (signal.Has(kHasRangeRateSigma)) {
    rate.sigma_mps = std::max(rate.sigma_mps, signal.range_rate_sigma_mps);
  }
  rates_.push_back(rate);
  rate_signals_.push_back(prepared.index);
}

void GnssEpochModel::AddPhase(const SignalObservation& signal, const PreparedSignal& prepared) {
  const double wavelength_m = kSpeedOfLight_mps / prepared.frequency_hz;
  TrackedPhase phase;
  phase.index = prepared.index;
  phase.satellite = signal.satellite;
  phase.signal = signal.signal;
  phase.satellite_in_ecef = prepared.satellite_in_ecef;
  // The ionosphere is as early in the phase as it is late in the code.
  phase.phase_m = signal.carrier_phase_cycles * wavelength_m +
                  kSpeedOfLight_mps * prepared.satellite.clock_bias_s + prepared.ionosphere_m -
                  prepared.troposphere_m;
  const double cn0_dbhz = signal.Has(kHasCn0) && signal.cn0_dbhz > 0.0 ? signal.cn0_dbhz : 40.0;
  phase.sigma_m = kPhaseSigma_m * std::pow(10.0, std::max(0.0, 40.0 - cn0_dbhz) / 20.0);
  if (signal.Has(kHasCarrierPhaseSigma)) {
    phase.sigma_m = std::max(phase.sigma_m, signal.carrier_phase_sigma_m);
  }
  if (signal.Has(kHasDoppler)) {
    phase.rate_mps =
        -signal.doppler_hz * wavelength_m + kSpeedOfLight_mps * prepared.satellite.clock_drift_sps;
  }
  phase.orbit_gps_ns = prepared.satellite.precise ? 0 : prepared.satellite.reference_gps_ns;
  phase.lost_lock = (signal.flags & kLossOfLock) != 0;
  phase.half_cycle = (signal.flags & kHalfCycleAmbiguous) != 0;
  phases_.push_back(phase);
}

void GnssEpochModel::CombineBands(const RangeWeights& weights) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (used_[i].merged) continue;
    PreparedSignal& first = used_[i];
    for (std::size_t k = i + 1; k < used_.size(); ++k) {
      const PreparedSignal& second = used_[k];
      if (second.satellite_id != first.satellite_id || !CanCombine(first, second)) continue;
      const int group = groups_.Group(first.satellite_id.system, first.band, second.band);
      if (group < 0) break;
      // How many times the delay of the first band the second one has.
      const double ratio = first.frequency_hz / second.frequency_hz;
      const double factor = ratio * ratio;
      const double amplification = 1.0 / (factor - 1.0);
      RangeObservation& range = ranges_[i];
      range.range_m = amplification * (factor * (range.range_m + first.ionosphere_m) -
                                       (ranges_[k].range_m + second.ionosphere_m));
      range.clock_group = group;
      first.weight =
          weights.Combined(group, first.weight, second.weight, factor, first.own_variance_m2);
      range.error = first.weight.error;
      first.combined = true;
      first.clock_group = group;
      break;
    }
    for (std::size_t k = i + 1; first.combined && k < used_.size(); ++k) {
      if (used_[k].merged || used_[k].satellite_id != first.satellite_id) continue;
      used_[k].merged = true;
      merged_.push_back({used_[k].index, first.index});
    }
    if (kept != i) {
      used_[kept] = used_[i];
      ranges_[kept] = ranges_[i];
    }
    ++kept;
  }
  used_.resize(kept);
  ranges_.resize(kept);
}

}  // namespace lodemark
