// Epochs with reflected satellites and mismatched landmarks: how often an answer errs by more than
// its protection level, and how large those levels are.
//
//   integrity_tables [EPOCHS]    a row; default 10000; docs/experiments.md holds what it prints
//
// Exits with 1 if any answer errs by more than its protection level.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/fusion/visual_range_group.h"
#include "core/resection/resection.h"
#include "core/resection/visual_ranges.h"
#include "test/experiments/square_draws.h"
#include "test/unit/fusion/faulty_epoch.h"

namespace lodemark {
namespace {

constexpr std::uint64_t kSeed = 5;

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

struct Levels {
  std::vector<double> level_m;
  std::vector<double> error_m;  // of the same
  int misleading = 0;
  double worst = 0.0;  // error over level

  void Add(double error, double level) {
    if (!(level > 0.0)) return;
    level_m.push_back(level);
    error_m.push_back(error);
    misleading += error > level ? 1 : 0;
    worst = std::max(worst, error / level);
  }
  void Print(int epochs) const {
    std::printf(" %d | %.2f | %.1f %% | %.1f, %.1f | %.1f, %.1f |", misleading, worst,
                100.0 * static_cast<double>(level_m.size()) / epochs, Quantile(error_m, 0.5),
                Quantile(error_m, 0.99), Quantile(level_m, 0.5), Quantile(level_m, 0.99));
  }
};

// The scheme tight: landmarks as ranges from where resection puts the camera.
std::optional<FaultyAnswer> AnswerTight(const FaultyEpochs& epochs, int number) {
  const FaultyScene scene(epochs, kSeed, number);
  const Lens lens = SquareLens();
  std::vector<LandmarkSight> sights;
  for (const BearingObservation& bearing : scene.camera.bearings) {
    const std::optional<Eigen::Vector2d> pixel = lens.Project(bearing.direction_in_camera);
    if (!pixel) continue;
    LandmarkSight sight;
    sight.pixel = *pixel;
    sight.pixel_sigma_px = kBearingSigma_rad * lens.parameters().fx_px;
    sight.landmark_in_enu_m = scene.ranges.ErrorInEnu(bearing.point_in_ecef);
    sights.push_back(sight);
  }
  ResectionPriors priors;
  priors.gravity =
      GravityPrior{scene.attitude.gravity->up_in_camera, scene.attitude.gravity->sigma_rad};
  const Result<ResectedPose> pose = Resect(sights, lens, priors, {});
  if (!pose || (pose->verdict != PoseVerdict::kPose && pose->verdict != PoseVerdict::kWeak)) {
    return std::nullopt;
  }
  const VisualRanges visual = VisualRangesFrom(*pose, sights, lens);
  if (visual.ranges.size() < 3) return std::nullopt;
  std::vector<Eigen::Vector3d> points_in_ecef;
  std::vector<double> distances_m;
  Eigen::MatrixX3d directions(static_cast<Eigen::Index>(visual.ranges.size()), 3);
  for (const VisualRange& range : visual.ranges) {
    directions.row(static_cast<Eigen::Index>(distances_m.size())) =
        range.direction_in_enu.transpose();
    points_in_ecef.push_back(scene.ranges.Beside(sights[range.sight].landmark_in_enu_m));
    distances_m.push_back(range.range_m);
  }
  VisualRangeGroup group;
  group.Set(points_in_ecef, distances_m,
            directions * visual.centre_covariance_m2 * directions.transpose());
  return Answer(scene, epochs, scene.ranges.Beside(pose->centre_in_enu_m()), &group);
}

enum class Way { kJoint, kTight };

int Run(const char* label, const FaultyEpochs& faults, int epochs, Way way = Way::kJoint) {
  Levels horizontal;
  Levels vertical;
  int answered = 0;
  int faulty = 0;
  int several = 0;
  for (int i = 0; i < epochs; ++i) {
    const std::optional<FaultyAnswer> answer =
        way == Way::kTight ? AnswerTight(faults, i) : AnswerFaultyEpoch(faults, kSeed, i);
    if (!answer) continue;
    ++answered;
    const int wrong = answer->reflected + answer->mismatched + answer->repeated;
    faulty += wrong > 0 ? 1 : 0;
    several += wrong > 1 ? 1 : 0;
    horizontal.Add(answer->horizontal_m(), answer->estimate.protection_level_m);
    vertical.Add(answer->up_m(), answer->estimate.vertical_protection_level_m);
  }
  std::printf("| %s | %d | %d | %.1f %% | %.1f %% | %.1f %% |", label, faults.satellites,
              faults.landmarks, 100.0 * answered / epochs, 100.0 * faulty / std::max(answered, 1),
              100.0 * several / std::max(answered, 1));
  horizontal.Print(epochs);
  vertical.Print(epochs);
  std::printf("\n");
  std::fflush(stdout);
  return horizontal.misleading + vertical.misleading;
}

int Main(int epochs) {
  std::printf(
      "%d epochs a row, seed %d\n\n| faults | satellites | landmarks | answered | with a fault | "
      "with several | misleading | worst error / level | with a level | error m, 50 and 99 %% | "
      "level m, 50 and 99 %% | misleading, up | worst, up | with a level, up | error up m | level "
      "up m |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
      "| --- | --- |\n",
      epochs, static_cast<int>(kSeed));
  struct Kind {
    const char* label;
    double reflected;
    double mismatched;
  };
  const Kind kinds[] = {{"none", 0.0, 0.0},
                        {"reflections", 0.05, 0.0},
                        {"mismatches", 0.0, 0.05},
                        {"both", 0.05, 0.05}};
  int misleading = 0;
  // Told that no wall is taken for its repeat.
  const DisplacementRisk kNever = {0.0, 0.0};
  for (const Kind& kind : kinds) {
    for (const auto& [satellites, landmarks] :
         {std::pair(10, 0), std::pair(10, 12), std::pair(10, 6), std::pair(5, 12), std::pair(3, 12),
          std::pair(0, 12)}) {
      if (satellites == 0 && kind.reflected > 0.0) continue;
      if (landmarks == 0 && kind.mismatched > 0.0) continue;
      FaultyEpochs faults;
      faults.satellites = satellites;
      faults.landmarks = landmarks;
      faults.reflected = kind.reflected;
      faults.mismatched = kind.mismatched;
      faults.stated_displacement = kNever;
      misleading += Run(kind.label, faults, epochs);
    }
  }
  // Walls taken for their repeat, and no faults with what an adjustment is told by itself.
  DisplacementRisk often = CombinedOptions().displacement;
  often.probability = 0.05;
  for (const auto& [satellites, landmarks] : {std::pair(10, 12), std::pair(10, 6), std::pair(5, 12),
                                              std::pair(3, 12), std::pair(0, 12)}) {
    FaultyEpochs faults;
    faults.satellites = satellites;
    faults.landmarks = landmarks;
    misleading += Run("none, repeats feared", faults, epochs);
    faults.repeated = 0.05;
    faults.stated_displacement = often;
    misleading += Run("repeats", faults, epochs);
    faults.mismatched = 0.05;
    faults.reflected = satellites > 0 ? 0.05 : 0.0;
    misleading += Run("repeats and others", faults, epochs);
  }
  for (const int satellites : {10, 5, 3, 0}) {
    FaultyEpochs faults;
    faults.satellites = satellites;
    misleading += Run("none, tight", faults, epochs, Way::kTight);
    faults.mismatched = 0.05;
    faults.reflected = satellites > 0 ? 0.05 : 0.0;
    misleading += Run("both, tight", faults, epochs, Way::kTight);
  }
  std::printf("\nmisleading answers: %d\n", misleading);
  return misleading > 0 ? 1 : 0;
}

}  // namespace
}  // namespace lodemark

int main(int argc, char** argv) {
  const int epochs = argc > 1 ? std::atoi(argv[1]) : 10'000;
  if (epochs < 1) {
    std::fprintf(stderr, "usage: integrity_tables [EPOCHS]\n");
    return 2;
  }
  return lodemark::Main(epochs);
}
