// Cost of one adjustment of 12 satellites and 50 landmarks, ours and, where it is installed,
// Ceres's of the same problem.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <vector>

#include "core/fusion/bearing_group.h"
#include "core/fusion/combined_adjustment.h"
#include "test/unit/fusion/camera_scene.h"

#ifdef LODEMARK_HAS_CERES
#include "test/unit/fusion/ceres_misfits.h"
#endif

namespace lodemark {
namespace {

constexpr int kSatellites = 12;
constexpr int kLandmarks = 50;

struct Scene {
  Scene() : camera(&ranges) {
    ranges.AddSky(kSatellites, 0, kClock_m, {3.0, 0.01, 30.0});
    Random random(2);
    for (RangeObservation& range : ranges.ranges) range.range_m += random.Gaussian(0.0, 3.0);
    camera.AddWalls(kLandmarks, &random);
  }
  RangeScene ranges;
  CameraScene camera;
};

void Ours(benchmark::State& run) {
  const Scene scene;
  BearingGroup group;
  CombinedAdjustment adjustment;
  CombinedEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  const Eigen::Vector3d start = scene.ranges.Beside({0.3, -0.2, 0.2});
  for (auto _ : run) {
    group.Set(scene.camera.bearings, {}, scene.camera.camera_from_ecef, {});
    const PointStatus status = adjustment.Solve(scene.ranges.ranges, start, ClockBiases(),
                                                CombinedOptions(), &group, &estimate, &verdicts);
    if (status != PointStatus::kGood || estimate.witness != WitnessVerdict::kUsed) {
      run.SkipWithError("no position");
    }
    benchmark::DoNotOptimize(estimate);
  }
  run.counters["rounds"] = estimate.rounds;
}
BENCHMARK(Ours)->Unit(benchmark::kMicrosecond);

#ifdef LODEMARK_HAS_CERES
// The same unknowns and a robust loss; no covariance, protection levels or comparison of groups.
void Ceres(benchmark::State& run) {
  const Scene scene;
  const Eigen::Vector3d origin = scene.ranges.Beside({0.3, -0.2, 0.2});
  const Eigen::Matrix3d camera_from_ecef = scene.camera.camera_from_ecef.toRotationMatrix();
  for (auto _ : run) {
    double offset[3] = {};
    double clock[1] = {kClock_m + 5.0};
    double turn[3] = {};
    ceres::Problem problem;
    for (const RangeObservation& range : scene.ranges.ranges) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<RangeMisfit, 1, 3, 1>(new RangeMisfit{range, origin}),
          new ceres::CauchyLoss(3.0), offset, clock);
    }
    for (const BearingObservation& bearing : scene.camera.bearings) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<BearingMisfit, 2, 3, 3>(
                                   new BearingMisfit{bearing, origin, camera_from_ecef}),
                               new ceres::CauchyLoss(3.0), offset, turn);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    benchmark::DoNotOptimize(offset);
  }
}
BENCHMARK(Ceres)->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
}  // namespace lodemark

BENCHMARK_MAIN();
