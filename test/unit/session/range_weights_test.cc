#include "core/session/range_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lodemark {
namespace {

SignalQuality Strong() {
  SignalQuality quality;
  quality.cn0_dbhz = 45.0;
  quality.elevation_rad = 1.0;
  return quality;
}

TEST(RangeWeights, TrustStrongHighSignalsMost) {
  RangeWeights weights{SessionOptions()};
  weights.NoteStrength(0, 48.0);
  const RangeErrorModel best = weights.ErrorModel(0, Strong()).error;
  SignalQuality weak = Strong();
  weak.cn0_dbhz = 25.0;
  SignalQuality low = Strong();
  low.elevation_rad = 0.1;
  SignalQuality jumpy = Strong();
  jumpy.rate_disagreement_m = -30.0;
  SignalQuality modelled = Strong();
  modelled.model_sigma_m = 5.0;
  for (const SignalQuality& worse : {weak, low, jumpy, modelled}) {
    EXPECT_GT(weights.ErrorModel(0, worse).error.sigma_m, best.sigma_m);
  }
  EXPECT_GT(weights.ErrorModel(0, weak).error.late_probability, best.late_probability);
  EXPECT_GT(weights.ErrorModel(0, weak).error.late_scale_m, best.late_scale_m);
  SignalQuality wide = Strong();
  wide.wideband = true;
  EXPECT_LT(weights.ErrorModel(0, wide).error.sigma_m, best.sigma_m);
  SignalQuality reflected = Strong();
  reflected.multipath_reported = true;
  EXPECT_GT(weights.ErrorModel(0, reflected).error.late_probability, best.late_probability);
}

TEST(RangeWeights, DoubtSignalsFromBehindAWallWithoutGivingThemUp) {
  RangeWeights weights{SessionOptions()};
  weights.NoteStrength(0, 45.0);
  const auto late = [&](double sight_probability, double cn0_dbhz) {
    SignalQuality quality = Strong();
    quality.sight_probability = sight_probability;
    quality.cn0_dbhz = cn0_dbhz;
    return weights.ErrorModel(0, quality).error.late_probability;
  };
  // A strong signal is doubted even so, a weak one more; none for certain.
  EXPECT_LT(late(1.0, 45.0), 0.02);
  EXPECT_GT(late(0.0, 45.0), 0.15);
  EXPECT_GT(late(0.0, 37.0), 0.6);
  EXPECT_LE(late(0.0, 20.0), 0.9);
  double before = 0.0;
  for (const double probability : {1.0, 0.9, 0.5, 0.1, 0.0}) {
    EXPECT_GE(late(probability, 40.0), before);
    before = late(probability, 40.0);
  }
  // As Bayes has it: the odds of two witnesses multiply.
  const auto odds = [&](double sight, double cn0_dbhz) {
    const double probability = late(sight, cn0_dbhz);
    return probability / (1.0 - probability);
  };
  EXPECT_NEAR(odds(0.5, 35.0) / odds(1.0, 35.0), 0.85 / 0.15, 1e-6);
}

TEST(RangeWeights, BelieveHalfOfAReportedUncertaintyWhereItIsMore) {
  RangeWeights weights{SessionOptions()};
  SignalQuality quality = Strong();
  const double usual_m = weights.ErrorModel(0, quality).error.sigma_m;
  quality.reported_sigma_m = usual_m;
  EXPECT_EQ(weights.ErrorModel(0, quality).error.sigma_m, usual_m);
  quality.reported_sigma_m = 60.0;
  EXPECT_NEAR(weights.ErrorModel(0, quality).error.sigma_m, 30.0, 1e-9);
}

TEST(RangeWeights, LearnTheNoiseOfEachGroup) {
  RangeWeights weights{SessionOptions()};
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (int epoch = 0; epoch < 500; ++epoch) {
    for (int i = 0; i < 8; ++i) {
      for (const int group : {0, 1}) {
        const WeightedModel model = weights.ErrorModel(group, Strong());
        const double truth = group == 0 ? 1.0 : 3.0;
        const double prior_sigma_m = std::sqrt(model.noise_variance_m2);
        weights.Learn(group, model, truth * prior_sigma_m * std::sqrt(0.5) * normal(random), 0.5,
                      1.0, 0.0);
      }
    }
    weights.FinishEpoch();
  }
  EXPECT_NEAR(std::sqrt(weights.NoiseFactor(0)), 1.0, 0.15);
  EXPECT_NEAR(std::sqrt(weights.NoiseFactor(1)), 3.0, 0.45);
  EXPECT_EQ(weights.NoiseFactor(2), 1.0);
  weights.Forget();
  EXPECT_EQ(weights.NoiseFactor(1), 1.0);
}

TEST(RangeWeights, LearnHowOftenSignalsAreReflected) {
  RangeWeights open{SessionOptions()};
  RangeWeights canyon{SessionOptions()};
  SignalQuality quality = Strong();
  quality.cn0_dbhz = 32.0;
  for (int epoch = 0; epoch < 200; ++epoch) {
    for (RangeWeights* weights : {&open, &canyon}) {
      weights->NoteStrength(0, 46.0);
      const WeightedModel model = weights->ErrorModel(0, quality);
      const double late = weights == &canyon ? 0.8 : 0.0;
      weights->Learn(0, model, 0.0, 0.7, 1.0 - late, late);
      weights->FinishEpoch();
    }
  }
  EXPECT_GT(canyon.ErrorModel(0, quality).error.late_probability,
            2.0 * open.ErrorModel(0, quality).error.late_probability);
}

SessionOptions ByElevation() {
  SessionOptions options;
  options.weight = WeightChoice::kElevation;
  options.elevation_a_m = 2.0;
  options.elevation_b_m = 3.0;
  return options;
}

TEST(RangeWeights, FollowTheElevationLawWhenChosen) {
  const RangeWeights weights{ByElevation()};
  SignalQuality quality = Strong();
  for (const double elevation_rad : {0.2, 0.6, 1.5}) {
    quality.elevation_rad = elevation_rad;
    quality.cn0_dbhz = 30.0 + 10.0 * elevation_rad;  // has no say
    const double sine = std::sin(elevation_rad);
    EXPECT_NEAR(weights.ErrorModel(0, quality).error.sigma_m, std::sqrt(4.0 + 9.0 / (sine * sine)),
                1e-9);
  }
}

TEST(RangeWeights, EstimateTheElevationLawWhenAsked) {
  SessionOptions options = ByElevation();
  options.estimate_variance_components = true;
  RangeWeights weights{options};
  RangeWeights stated{ByElevation()};
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> sine(0.15, 1.0);
  for (int epoch = 0; epoch < 1500; ++epoch) {
    for (int i = 0; i < 8; ++i) {
      SignalQuality quality = Strong();
      const double s = sine(random);
      quality.elevation_rad = std::asin(s);
      quality.model_sigma_m = 0.8;
      const double variance_m2 = 0.64 + 1.0 + 0.25 / (s * s);
      const double residual_m = std::sqrt(0.6 * variance_m2) * normal(random);
      weights.Learn(0, weights.ErrorModel(0, quality), residual_m, 0.6, 1.0, 0.0);
      stated.Learn(0, stated.ErrorModel(0, quality), residual_m, 0.6, 1.0, 0.0);
    }
    weights.FinishEpoch();
    stated.FinishEpoch();
  }
  EXPECT_NEAR(weights.elevation_law().constant, 1.0, 0.15);
  EXPECT_NEAR(weights.elevation_law().proportional, 0.25, 0.04);
  EXPECT_EQ(stated.elevation_law().constant, 4.0);
  weights.Forget();
  EXPECT_EQ(weights.elevation_law().constant, 4.0);
}

}  // namespace
}  // namespace lodemark
