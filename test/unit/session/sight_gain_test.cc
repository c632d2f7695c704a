// What a map of buildings is worth to a fix in a street, and what is left of that where it is
// wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/base/random.h"
#include "core/session/epoch_solver.h"
#include "core/session/sight_source.h"
#include "test/unit/session/session_scene.h"

namespace lodemark {
namespace {

using test::SessionScene;

// A street from south to north, the receiver in its middle.
constexpr double kToWall_m = 9.0;
constexpr double kWall_m = 22.0;  // above the receiver
constexpr double kNoise_m = 2.5;

// Whether the walls leave a satellite in sight.
bool InSight(const LookAngles& look) {
  return std::tan(look.elevation_rad) > kWall_m * std::abs(std::sin(look.azimuth_rad)) / kToWall_m;
}

// Says of each satellite whether it is in sight, and is wrong as often as told.
class Labels : public SightSource {
 public:
  Labels(double wrong, std::uint64_t seed) : wrong_(wrong), random_(seed) {}

  std::optional<double> ProbabilityOfSight(SatelliteId satellite, const LookAngles& look,
                                           double) override {
    const auto [found, is_new] = labels_.emplace(satellite, InSight(look));
    if (is_new && random_.Uniform() < wrong_) found->second = !found->second;
    return found->second ? 1.0 : 0.0;
  }

 private:
  double wrong_;
  Random random_;
  std::map<SatelliteId, bool> labels_;
};

// What the receiver measures: a hidden satellite by way of the wall across, as far as it is heard
// at all, weaker, and at times by two walls more.
ObservationEpoch MeasureInStreet(const SessionScene& scene, Random* random) {
  const Eigen::Vector3d place = scene.PlaceAt(0.0);
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(scene.place);
  std::map<SatelliteId, LookAngles> looks;
  for (const KeplerEphemeris& set : scene.sets) {
    const BroadcastState state = KeplerState(set, test::kSceneStart_ns, -0.07);
    looks[set.satellite] = LookAnglesTo(state.position_in_ecef, place, enu_from_ecef);
  }
  ObservationEpoch epoch = scene.Epoch(0.0);
  std::erase_if(epoch.signals, [&](const SignalObservation& signal) {
    return !InSight(looks.at(signal.satellite)) && random->Uniform() < 0.3;
  });
  for (SignalObservation& signal : epoch.signals) {
    const LookAngles& look = looks.at(signal.satellite);
    signal.cn0_dbhz = 45.0 + 2.0 * random->Gaussian();
    signal.pseudorange_m += kNoise_m * random->Gaussian();
    if (InSight(look)) continue;
    const double walls = random->Uniform() < 0.7 ? 1.0 : 3.0;
    signal.pseudorange_m += 2.0 * walls * kToWall_m * std::abs(std::sin(look.azimuth_rad)) *
                            std::cos(look.elevation_rad);
    signal.cn0_dbhz -= std::abs(8.0 + 5.0 * random->Gaussian());
  }
  return epoch;
}

// Horizontal error of a fix, or nothing. No error counts for more than 100 m: a handful of fixes
// that are lost altogether would drown the others.
std::optional<double> Error_m(const SessionScene& scene, const ObservationEpoch& epoch,
                              SightSource* sights) {
  EpochSolver solver(scene.options);
  for (const KeplerEphemeris& set : scene.sets) solver.orbits().Add(set);
  solver.UseSights(sights);
  SessionEstimate estimate;
  std::vector<SatelliteStatus> statuses;
  solver.Solve(epoch, {}, &estimate, &statuses);
  if (estimate.status != EstimateStatus::kFix) return std::nullopt;
  const Eigen::Vector3d error_m =
      EnuFromEcefRotation(scene.place) * (estimate.position_in_ecef - scene.PlaceAt(0.0));
  return std::min(error_m.head<2>().norm(), 100.0);
}

// In many streets, which differ in noise, sky and place.
TEST(SightLinesInAStreet, KeepTwoThirdsOfTheirGainWithEverySeventhLabelWrong) {
  constexpr int kDraws = 1000;
  double without_m = 0.0;
  double right_m = 0.0;
  double wrong_m = 0.0;
  int fixes = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Random random(static_cast<std::uint64_t>(1000 + draw));
    SessionScene scene;
    scene.place.longitude_rad = 2.0 * kPi * draw / kDraws - kPi;
    scene.place.latitude_rad = 0.6 + 0.4 * draw / kDraws;
    const ObservationEpoch epoch = MeasureInStreet(scene, &random);
    Labels right(0.0, 1);
    Labels wrong(0.15, static_cast<std::uint64_t>(5000 + draw));
    const std::optional<double> alone = Error_m(scene, epoch, nullptr);
    const std::optional<double> with_map = Error_m(scene, epoch, &right);
    const std::optional<double> with_wrong_map = Error_m(scene, epoch, &wrong);
    if (!alone || !with_map || !with_wrong_map) continue;
    without_m += *alone;
    right_m += *with_map;
    wrong_m += *with_wrong_map;
    ++fixes;
  }
  EXPECT_GT(fixes, 0.97 * kDraws);
  EXPECT_LT(right_m, 0.85 * without_m);
  EXPECT_GT(without_m - wrong_m, (without_m - right_m) * 2.0 / 3.0)
      << without_m / fixes << " m without a map, " << right_m / fixes << " m with it, "
      << wrong_m / fixes << " m with wrong labels";
}

}  // namespace
}  // namespace lodemark
