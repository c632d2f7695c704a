// One GNSS epoch on its way from receiver observations to fusion's observations.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_orbits.h"
#include "core/session/code_rate_check.h"
#include "core/session/phase_changes.h"
#include "core/session/range_weights.h"
#include "core/session/session.h"
#include "core/session/sight_source.h"

namespace lodemark {

// Numbers the clocks that a receiver's signals show: one per system and band.
class ClockGroups {
 public:
  // The group of a band, or of two bands combined (second_band not blank), made if it is new; -1
  // once there are too many.
  int Group(System system, char band, char second_band);
  int size() const { return count_; }
  void Forget() { count_ = 0; }

 private:
  struct Key {
    System system;
    char band;
    char second_band;
  };
  std::array<Key, kMaxClockGroups> keys_ = {};
  int count_ = 0;
};

// A signal with what is known of its satellite.
struct PreparedSignal {
  std::size_t index = 0;  // into ObservationEpoch::signals
  SatelliteId satellite_id;
  char band = '1';
  int clock_group = 0;
  double frequency_hz = 0.0;  // carrier
  SatelliteState satellite;
  Eigen::Vector3d satellite_in_ecef = Eigen::Vector3d::Zero();  // in the frame at reception
  Eigen::Vector3d satellite_velocity_in_ecef = Eigen::Vector3d::Zero();  // likewise
  double elevation_rad = 0.0;
  double azimuth_rad = 0.0;
  double ionosphere_m = 0.0;
  double troposphere_m = 0.0;
  double ionosphere_variance_m2 = 0.0;  // of the whole model error, common part included
  double own_variance_m2 = 0.0;         // of orbit, clock and troposphere
  WeightedModel weight;
  bool combined = false;  // with a signal of another band
  bool merged = false;    // into another signal of the satellite
};

// Whose range it is, as far as its errors are alike from epoch to epoch.
struct RangeSource {
  SatelliteId satellite;
  char band = '1';
  double sigma_m = 1.0;  // of ordinary noise
};

// A signal that became part of another's range; both indices into ObservationEpoch::signals.
struct MergedSignal {
  std::size_t index = 0;
  std::size_t into = 0;
};

// Turns an epoch into ranges and range rates. Keeps its workspace.
class GnssEpochModel {
 public:
  explicit GnssEpochModel(const SessionOptions& options) : options_(options) {}

  // Asked for the chance that each satellite is in plain sight; null: nobody.
  void UseSights(SightSource* sights) { sights_ = sights; }

  // Finds orbits; signals that cannot be used get their verdict in *statuses (one per signal).
  void FindSatellites(const ObservationEpoch& epoch, const SatelliteOrbits& orbits,
                      std::vector<SatelliteStatus>* statuses);

  // Tells the weights how strong the signals of this epoch are.
  void NoteStrengths(const ObservationEpoch& epoch, RangeWeights* weights) const;

  // Ranges without atmosphere, for a first position from nothing.
  const std::vector<RangeObservation>& CoarseRanges(const ObservationEpoch& epoch);

  // Ranges and rates as seen from a place near the receiver. Signals that fall out (elevation,
  // C/N0) get their verdict in *statuses.
  void Model(const ObservationEpoch& epoch, const Eigen::Vector3d& place_in_ecef,
             const IonosphereModel& ionosphere, const RangeWeights& weights,
             const std::vector<double>& rate_disagreements_m,
             std::vector<SatelliteStatus>* statuses);

  const std::vector<PreparedSignal>& used_signals() const { return used_; }
  const std::vector<MergedSignal>& merged_signals() const { return merged_; }
  const std::vector<RangeObservation>& ranges() const { return ranges_; }  // of used_signals
  const std::vector<RangeRateObservation>& rates() const { return rates_; }
  const std::vector<std::size_t>& rate_signals() const { return rate_signals_; }  // of the epoch
  const std::vector<TrackedPhase>& phases() const { return phases_; }
  const Eigen::Vector3d& place_in_ecef() const { return place_in_ecef_; }  // seen from

  void Forget() { groups_.Forget(); }

 private:
  void NoteSight(const PreparedSignal& prepared, SatelliteStatus* status) const;
  SignalQuality QualityOf(const SignalObservation& signal, const PreparedSignal& prepared,
                          double ionosphere_share) const;
  void AddRate(const SignalObservation& signal, const PreparedSignal& prepared,
               const Eigen::Vector3d& place_in_ecef);

  void AddPhase(const SignalObservation& signal, const PreparedSignal& prepared);

  // Replaces the signals of a satellite by one range free of the ionosphere, where two bands
  // allow it.
  void CombineBands(const RangeWeights& weights);

  SessionOptions options_;
  SightSource* sights_ = nullptr;
  ClockGroups groups_;
  std::vector<PreparedSignal> prepared_;
  std::vector<PreparedSignal> used_;
  std::vector<MergedSignal> merged_;
  std::vector<RangeObservation> ranges_;
  std::vector<RangeRateObservation> rates_;
  std::vector<std::size_t> rate_signals_;
  std::vector<TrackedPhase> phases_;
  Eigen::Vector3d place_in_ecef_ = Eigen::Vector3d::Zero();
};

}  // namespace lodemark
