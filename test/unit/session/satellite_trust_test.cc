#include "core/session/satellite_trust.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lodemark {
namespace {

constexpr SatelliteId kSatellite = {System::kGalileo, 7};
constexpr SatelliteId kOther = {System::kGps, 7};

// So many seconds of one verdict a second.
void Learn(double weight, double late_share, int seconds, SatelliteTrust* trust) {
  const std::vector<RangeSource> sources = {{kSatellite}};
  const std::vector<ObservationVerdict> verdicts = {{0.0, weight, late_share, weight >= 0.5, true}};
  for (int i = 0; i < seconds; ++i) trust->Learn(1.0, sources, verdicts);
}

TEST(SatelliteTrust, AStrangerIsNeitherBelievedNorRefused) {
  const SatelliteTrust nobody;
  EXPECT_GT(nobody.SigmaFactor(kSatellite), 1.5);
  EXPECT_LT(nobody.SigmaFactor(kSatellite), 4.0);
}

TEST(SatelliteTrust, RisesAndFallsWithinSeconds) {
  SatelliteTrust trust;
  Learn(1.0, 0.0, 10, &trust);
  EXPECT_NEAR(trust.SigmaFactor(kSatellite), 1.0, 0.05);
  double before = trust.SigmaFactor(kSatellite);
  for (int i = 0; i < 4; ++i) {
    Learn(0.0, 0.0, 1, &trust);
    EXPECT_GT(trust.SigmaFactor(kSatellite), before);
    before = trust.SigmaFactor(kSatellite);
  }
  EXPECT_GT(before, 5.0);
  Learn(0.0, 0.0, 1000, &trust);
  EXPECT_LE(trust.SigmaFactor(kSatellite), 1000.0);  // never nothing at all
  Learn(1.0, 0.0, 10, &trust);
  EXPECT_LT(trust.SigmaFactor(kSatellite), 1.1);
}

TEST(SatelliteTrust, AReflectionIsWorthALittleMoreThanNonsense) {
  SatelliteTrust late;
  SatelliteTrust gross;
  Learn(0.0, 1.0, 3, &late);
  Learn(0.0, 0.0, 3, &gross);
  EXPECT_LT(late.SigmaFactor(kSatellite), gross.SigmaFactor(kSatellite));
  EXPECT_GT(late.SigmaFactor(kSatellite), 3.0);
}

TEST(SatelliteTrust, ItsSignalsAreHeardTogetherAndOthersNot) {
  const std::vector<RangeSource> sources = {{kSatellite}, {kOther}, {kSatellite}};
  const std::vector<ObservationVerdict> verdicts = {
      {0.0, 1.0, 0.0, true, true}, {0.0, 1.0, 0.0, true, true}, {0.0, 0.0, 0.0, false, true}};
  SatelliteTrust trust;
  for (int i = 0; i < 30; ++i) trust.Learn(1.0, sources, verdicts);
  EXPECT_NEAR(trust.SigmaFactor(kSatellite), 2.0, 0.01);
  EXPECT_NEAR(trust.SigmaFactor(kOther), 1.0, 0.01);
}

TEST(SatelliteTrust, WhoIsGoneIsAStranger) {
  SatelliteTrust trust;
  Learn(1.0, 0.0, 10, &trust);
  trust.Learn(1.0, {}, {});
  EXPECT_EQ(trust.SigmaFactor(kSatellite), SatelliteTrust().SigmaFactor(kSatellite));
}

TEST(SatelliteTrust, TimesThatDoNotAdvanceTeachNothing) {
  for (const double seconds : {0.0, -3600.0, -1e12}) {
    SatelliteTrust trust;
    Learn(1.0, 0.0, 10, &trust);
    const double before = trust.SigmaFactor(kSatellite);
    const std::vector<RangeSource> sources = {{kSatellite}};
    const std::vector<ObservationVerdict> gross(1);
    trust.Learn(seconds, sources, gross);
    EXPECT_EQ(trust.SigmaFactor(kSatellite), before) << seconds;
  }
}

}  // namespace
}  // namespace lodemark
