// How much each code range is trusted: noise by C/N0 and elevation, the chance of a reflection by
// how much weaker a signal is than the strongest, and what past epochs taught about both.
#pragma once

#include <array>
#include <cstdint>

#include "core/adjustment/variance_components.h"
#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"
#include "core/session/session.h"

namespace lodemark {

// What is known of one signal at one epoch.
struct SignalQuality {
  double cn0_dbhz = 0.0;  // 0 if unknown
  double elevation_rad = 0.0;
  double reported_sigma_m = 0.0;     // 0 if unknown
  double model_sigma_m = 0.0;        // of orbit, clock and atmosphere
  double rate_disagreement_m = 0.0;  // code against Doppler, 0 if unknown
  bool wideband = false;             // a code of ten times the C/A rate
  bool multipath_reported = false;
  // That the straight path is free, as a map of buildings has it; 1 without one.
  double sight_probability = 1.0;
};

// An error model with the parts it was made of.
struct WeightedModel {
  RangeErrorModel error;
  double noise_variance_m2 = 0.0;  // of the signal itself, before the learned factor
  double other_variance_m2 = 0.0;  // of models and disagreements
  double elevation_rad = 0.0;
  double amplification = 1.0;  // of the variance, by combining bands
};

class RangeWeights {
 public:
  explicit RangeWeights(const SessionOptions& options);

  // To be called with every signal of an epoch before ErrorModel is asked.
  void NoteStrength(int clock_group, double cn0_dbhz);

  WeightedModel ErrorModel(int clock_group, const SignalQuality& quality) const;

  // The model of two bands combined so that the ionosphere cancels. factor: how many times the
  // delay of the first the second has; own_variance_m2: of orbit, clock and troposphere.
  WeightedModel Combined(int clock_group, const WeightedModel& first, const WeightedModel& second,
                         double factor, double own_variance_m2) const;

  // The receiver tracks what only surveying receivers track (GPS L2): finer code, better antenna.
  void NoteSurveyingReceiver() { surveying_ = true; }
  bool surveying() const { return surveying_; }

  // Variance of the signal's noise against the prior's, as learned.
  double NoiseFactor(int clock_group) const;

  // Learns from one range of an adjusted epoch. redundancy_share: expected square of a residual
  // over its variance; core_share and late_share: the posterior over the error model.
  void Learn(int clock_group, const WeightedModel& model, double residual_m,
             double redundancy_share, double core_share, double late_share);
  // To be called once after the ranges of an epoch were learned.
  void FinishEpoch();
  void Forget();

  // a^2 and b^2 of the elevation law at present.
  const VarianceLaw& elevation_law() const { return law_; }

 private:
  double ElevationVariance(double elevation_rad) const;

  struct Group {
    double strongest_dbhz = 0.0;
    double squares = 0.0;
    double count = 0.0;
  };
  bool by_elevation_ = false;
  bool learn_law_ = false;
  VarianceLaw stated_law_;
  VarianceLaw law_;
  VarianceComponents components_;
  std::array<Group, kMaxClockGroups> groups_ = {};
  bool surveying_ = false;
  double late_found_ = 0.0;     // posterior number of reflections
  double late_expected_ = 0.0;  // what the prior had expected
};

}  // namespace lodemark
