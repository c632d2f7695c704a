#include "core/session/error_persistence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace lodemark {
namespace {

// Variance of a mean, summed over the whole covariance of new and passing errors.
double Summed(const RangedErrors& errors, int epochs, double seconds) {
  double sum = 0.0;
  for (int i = 0; i < epochs; ++i) {
    for (int k = 0; k < epochs; ++k) {
      sum += errors.passing * std::exp(-std::abs(i - k) * seconds / kPassing_s);
      if (i == k) sum += errors.white;
    }
  }
  return sum / (epochs * epochs);
}

const std::vector<RangedErrors> kKinds = {
    {0.4, 0.4, 0.2}, {1.0, 0.0, 0.0}, {0.1, 0.9, 0.0}, {0.3, 0.1, 0.6}};

TEST(RangedErrors, AMeanVariesAsItsCovarianceSums) {
  for (const RangedErrors& errors : kKinds) {
    for (const int epochs : {1, 2, 7, 60, 500}) {
      for (const double seconds : {0.1, 1.0, 5.0, 30.0, 300.0}) {
        EXPECT_NEAR(errors.OfMean(epochs, seconds) / Summed(errors, epochs, seconds), 1.0, 1e-6)
            << epochs << " " << seconds;
      }
    }
  }
}

TEST(RangedErrors, VeryManyEpochsCountAsTheirLimit) {
  for (const RangedErrors& errors : kKinds) {
    for (const double seconds : {0.1, 1.0, 30.0, 300.0}) {
      EXPECT_NEAR(errors.OfMean(1e6, seconds) * 1e6 / errors.AlikeEpochs(seconds), 1.0, 1e-3);
      // No epoch tells more than one that is independent of the others.
      EXPECT_GE(errors.AlikeEpochs(seconds), errors.white + errors.passing);
    }
  }
}

// What one satellite's ranges err by, in units of one sigma.
class Source {
 public:
  Source(const RangedErrors& shares, Random* random)
      : shares_(shares),
        random_(random),
        passing_(random->Gaussian()),
        lasting_(random->Gaussian()) {}
  double Next(double seconds) {
    const double kept = std::exp(-seconds / kPassing_s);
    passing_ = kept * passing_ + std::sqrt(1.0 - kept * kept) * random_->Gaussian();
    return std::sqrt(shares_.white) * random_->Gaussian() + std::sqrt(shares_.passing) * passing_ +
           std::sqrt(shares_.lasting) * lasting_;
  }

 private:
  RangedErrors shares_;
  Random* random_;
  double passing_;
  double lasting_;
};

RangedErrors LearnedFrom(const RangedErrors& truth, double seconds, double weight = 1.0) {
  constexpr std::size_t kSatellites = 30;
  Random random(17);
  std::vector<RangeSource> ranges(kSatellites);
  std::vector<ObservationVerdict> verdicts(kSatellites);
  std::vector<Source> sources;
  for (std::size_t i = 0; i < kSatellites; ++i) {
    ranges[i].satellite = {System::kGps, static_cast<std::uint8_t>(i + 1)};
    ranges[i].sigma_m = 2.0 + static_cast<double>(i);
    sources.emplace_back(truth, &random);
  }
  ErrorPersistence persistence;
  for (double second = 0.0; second < 400.0; second += seconds) {
    for (std::size_t i = 0; i < kSatellites; ++i) {
      verdicts[i].residual_m = ranges[i].sigma_m * sources[i].Next(seconds);
      verdicts[i].weight = weight;
    }
    persistence.Learn(seconds, ranges, verdicts);
  }
  return persistence.Shares();
}

TEST(ErrorPersistence, FindsTheSharesThatErrorsWereDrawnWith) {
  for (const double seconds : {0.5, 1.0}) {
    const RangedErrors white = LearnedFrom({1.0, 0.0, 0.0}, seconds);
    EXPECT_GT(white.white, 0.8) << seconds;
    const RangedErrors passing = LearnedFrom({0.0, 1.0, 0.0}, seconds);
    EXPECT_GT(passing.passing, 0.65) << seconds;
    const RangedErrors lasting = LearnedFrom({0.0, 0.0, 1.0}, seconds);
    EXPECT_GT(lasting.lasting, 0.75) << seconds;
    const RangedErrors mixed = LearnedFrom({0.6, 0.1, 0.3}, seconds);
    EXPECT_NEAR(mixed.white, 0.6, 0.12) << seconds;
    EXPECT_NEAR(mixed.lasting, 0.3, 0.12) << seconds;
    for (const RangedErrors& shares : {white, passing, lasting, mixed}) {
      EXPECT_NEAR(shares.white + shares.passing + shares.lasting, 1.0, 1e-9);
    }
  }
}

TEST(ErrorPersistence, OutliersTeachNothing) {
  const RangedErrors usual;
  const RangedErrors learned = LearnedFrom({0.0, 0.0, 1.0}, 1.0, 0.3);
  EXPECT_NEAR(learned.white, usual.white, 1e-6);
  EXPECT_NEAR(learned.passing, usual.passing, 1e-6);
  EXPECT_NEAR(learned.lasting, usual.lasting, 1e-6);
}

TEST(ErrorPersistence, TimesThatDoNotAdvanceTeachNothing) {
  ErrorPersistence persistence;
  const std::vector<RangeSource> ranges(3);
  const std::vector<ObservationVerdict> verdicts(3, ObservationVerdict{5.0, 1.0, 0.0, true, true});
  for (const double seconds : {0.0, -1e9, std::nan("")}) {
    persistence.Learn(seconds, ranges, verdicts);
  }
  EXPECT_NEAR(persistence.Shares().white, RangedErrors().white, 1e-9);
}

TEST(ErrorPersistence, EpochsFarApartTeachNothing) {
  for (const double seconds : {5.0, 30.0, 60.0, 119.0}) {
    const RangedErrors learned = LearnedFrom({0.0, 0.0, 1.0}, seconds);
    EXPECT_NEAR(learned.white, RangedErrors().white, 1e-9) << seconds;
    EXPECT_NEAR(learned.passing, RangedErrors().passing, 1e-9) << seconds;
    EXPECT_NEAR(learned.lasting, RangedErrors().lasting, 1e-9) << seconds;
  }
}

}  // namespace
}  // namespace lodemark
