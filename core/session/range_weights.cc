#include "core/session/range_weights.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Values below describe phones and single-frequency modules in open, suburban and canyon
// recordings; one set serves them all, and what past epochs teach moves each receiver from it.

// Code noise: multipath that even strong signals have, and thermal noise at 40 dBHz.
constexpr double kMultipath_m = 2.0;
constexpr double kThermalAt40_m = 2.4;
constexpr double kUsualCn0_dbhz = 40.0;  // of a receiver that reports none

// Codes of ten times the C/A rate see that much less of both.
constexpr double kWidebandShare = 0.35;

// Receivers state what their loops do, at times with much caution: this share of it is believed
// where it is more than what the strength says.
constexpr double kReportedShare = 0.5;

// A surveying receiver's antenna and correlators: share of the variance, and of the odds that a
// weak signal, weak for its low elevation, came by a longer way.
constexpr double kSurveyNoiseShare = 0.05;
constexpr double kSurveyLateShare = 0.05;

// Variance by elevation beyond what C/N0 already tells: share that grows with 1 / sin^2.
constexpr double kElevationShare = 0.1;
constexpr double kSmallestSine = 0.1;

// Chance of a reflection against the deficit in C/N0: even odds at the middle, e times more for
// every width.
constexpr double kDeficitMiddle_db = 16.5;
constexpr double kDeficitWidth_db = 3.5;
constexpr double kFewestLate = 0.01;
constexpr double kMostLate = 0.9;
constexpr double kMultipathReported = 0.2;  // added where the receiver reports multipath

// How often a map of buildings is wrong about one path: new houses, trees, its own errors. The odds
// of a reflection by the deficit alone are those of a receiver that knows no map, to which that
// share of signals comes by longer ways too.
constexpr double kMapWrong = 0.15;

// Mean extra path of a reflection: grows with the deficit, as long ways cost power.
constexpr double kLateScaleAtNoDeficit_m = 3.0;
constexpr double kLateScalePerDb_m = 1.8;
constexpr double kSmallestLateScale_m = 8.0;
constexpr double kLargestLateScale_m = 60.0;

// A receiver whose strongest signal is weaker than this is indoors, not reference.
constexpr double kLowestReference_dbhz = 30.0;
constexpr double kReferenceDecay_db = 0.02;  // an epoch

// Share of a disagreement between code and Doppler that counts as code noise, as a variance.
constexpr double kDisagreementShare = 0.5;

// How many ranges the prior on noise and the prior on reflections are worth, and how fast what
// was learned fades, an epoch.
constexpr double kNoisePriorCount = 120.0;
constexpr double kLatePriorCount = 5.0;
constexpr double kNoiseFading = 0.995;
constexpr double kLateFading = 0.99;

// Redundancy from which the elevation law is estimated instead of the stated one, and how fast past
// epochs fade from it.
constexpr double kFewestForLaw = 30.0;
constexpr double kLawFading = 0.999;
constexpr double kSmallestLawVariance_m2 = 1e-4;

// 1 / sin^2 of the elevation.
double Obliquity(double elevation_rad) {
  const double sine = std::max(std::sin(elevation_rad), kSmallestSine);
  return 1.0 / (sine * sine);
}

// What a map makes of the odds of a reflection: they are multiplied by those it states over those
// without it, after Bayes, as the strength of a signal and the walls around the receiver are two
// witnesses. It is believed so far as it is right: 1 where the path is free for sure, and 32 where
// it is blocked for sure.
double OddsFactor(double sight_probability) {
  const double blocked = kMapWrong + (1.0 - 2.0 * kMapWrong) * (1.0 - sight_probability);
  return blocked / (1.0 - blocked) * (1.0 - kMapWrong) / kMapWrong;
}

}  // namespace

RangeWeights::RangeWeights(const SessionOptions& options)
    : by_elevation_(options.weight == WeightChoice::kElevation),
      learn_law_(by_elevation_ && options.estimate_variance_components),
      stated_law_({options.elevation_a_m * options.elevation_a_m,
                   options.elevation_b_m * options.elevation_b_m}),
      law_(stated_law_) {}

double RangeWeights::ElevationVariance(double elevation_rad) const {
  return std::max(law_.constant + law_.proportional * Obliquity(elevation_rad),
                  kSmallestLawVariance_m2);
}

void RangeWeights::NoteStrength(int clock_group, double cn0_dbhz) {
  Group& group = groups_[static_cast<std::size_t>(clock_group)];
  group.strongest_dbhz = std::max(group.strongest_dbhz, cn0_dbhz);
}

double RangeWeights::NoiseFactor(int clock_group) const {
  if (by_elevation_) return 1.0;
  const Group& group = groups_[static_cast<std::size_t>(clock_group)];
  return (kNoisePriorCount + group.squares) / (kNoisePriorCount + group.count);
}

WeightedModel RangeWeights::ErrorModel(int clock_group, const SignalQuality& quality) const {
  const Group& group = groups_[static_cast<std::size_t>(clock_group)];
  const double cn0_dbhz = quality.cn0_dbhz > 0.0 ? quality.cn0_dbhz : kUsualCn0_dbhz;
  const double thermal_m = kThermalAt40_m * std::pow(10.0, (40.0 - cn0_dbhz) / 20.0);
  const double share = quality.wideband ? kWidebandShare : 1.0;
  WeightedModel model;
  model.noise_variance_m2 =
      share * share * (surveying_ ? kSurveyNoiseShare : 1.0) *
      (kMultipath_m * kMultipath_m + thermal_m * thermal_m) *
      (1.0 - kElevationShare + kElevationShare * Obliquity(quality.elevation_rad));
  const double reported_m = kReportedShare * quality.reported_sigma_m;
  model.noise_variance_m2 = std::max(model.noise_variance_m2, reported_m * reported_m);
  model.other_variance_m2 =
      quality.model_sigma_m * quality.model_sigma_m +
      kDisagreementShare * quality.rate_disagreement_m * quality.rate_disagreement_m;
  model.elevation_rad = quality.elevation_rad;
  if (by_elevation_) model.noise_variance_m2 = ElevationVariance(quality.elevation_rad);
  model.error.sigma_m =
      std::sqrt(NoiseFactor(clock_group) * model.noise_variance_m2 + model.other_variance_m2);

  const double deficit_db =
      std::max(0.0, std::max(group.strongest_dbhz, kLowestReference_dbhz) - cn0_dbhz);
  double odds = std::exp((deficit_db - kDeficitMiddle_db) / kDeficitWidth_db) *
                (surveying_ ? kSurveyLateShare : 1.0) * (kLatePriorCount + late_found_) /
                (kLatePriorCount + late_expected_);
  if (quality.sight_probability < 1.0) odds *= OddsFactor(quality.sight_probability);
  model.error.late_probability = std::clamp(odds / (1.0 + odds), kFewestLate, kMostLate);
  if (quality.multipath_reported) {
    model.error.late_probability =
        std::min(kMostLate, model.error.late_probability + kMultipathReported);
  }
  model.error.late_scale_m = std::clamp(kLateScaleAtNoDeficit_m + kLateScalePerDb_m * deficit_db,
                                        kSmallestLateScale_m, kLargestLateScale_m);
  return model;
}

WeightedModel RangeWeights::Combined(int clock_group, const WeightedModel& first,
                                     const WeightedModel& second, double factor,
                                     double own_variance_m2) const {
  const double share = 1.0 / ((factor - 1.0) * (factor - 1.0));
  WeightedModel model = first;
  model.noise_variance_m2 =
      share * (factor * factor * first.noise_variance_m2 + second.noise_variance_m2);
  model.other_variance_m2 = own_variance_m2;
  model.amplification = share * (factor * factor + 1.0);
  model.error.sigma_m =
      std::sqrt(NoiseFactor(clock_group) * model.noise_variance_m2 + model.other_variance_m2);
  return model;
}

void RangeWeights::Learn(int clock_group, const WeightedModel& model, double residual_m,
                         double redundancy_share, double core_share, double late_share) {
  Group& group = groups_[static_cast<std::size_t>(clock_group)];
  const double u = residual_m / model.error.sigma_m;
  group.squares += core_share * u * u * NoiseFactor(clock_group);
  group.count += core_share * redundancy_share;
  if (learn_law_) {
    // What the models leave is in the residual too.
    const double noise_m2 = residual_m * residual_m - redundancy_share * model.other_variance_m2;
    components_.Add(Obliquity(model.elevation_rad), core_share * noise_m2 / model.amplification,
                    core_share * redundancy_share);
  }
  late_found_ += late_share;
  late_expected_ += model.error.late_probability;
}

void RangeWeights::FinishEpoch() {
  for (Group& group : groups_) {
    group.squares *= kNoiseFading;
    group.count *= kNoiseFading;
    group.strongest_dbhz = std::max(0.0, group.strongest_dbhz - kReferenceDecay_db);
  }
  late_found_ *= kLateFading;
  late_expected_ *= kLateFading;
  if (!learn_law_) return;
  if (components_.redundancy() >= kFewestForLaw) {
    law_ = components_.Estimate(law_).value_or(law_);
  }
  components_.Fade(kLawFading);
}

void RangeWeights::Forget() {
  law_ = stated_law_;
  components_ = VarianceComponents();
  groups_ = {};
  surveying_ = false;
  late_found_ = 0.0;
  late_expected_ = 0.0;
}

}  // namespace lodemark
