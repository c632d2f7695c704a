// Cost of one moment of the filter: the time update of its state, and a whole epoch of a session.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/fusion/inertial_filter.h"
#include "core/fusion/motion_filter.h"
#include "test/unit/fusion/inertial_scene.h"
#include "test/unit/fusion/motion_scene.h"
#include "test/unit/session/filter_scene.h"

namespace lodemark::test {
namespace {

constexpr int kSatellites = 30;

void TimeUpdate(benchmark::State& state) {
  const std::vector<Eigen::Vector3d> sky = SkyDirections(kSatellites);
  const Eigen::Vector3d velocity_mps(8.0, -3.0, 1.0);
  Random random(4);
  const std::vector<RangeRateObservation> rates =
      RatesOf(sky, velocity_mps, 80.0, 0.05, 1.0, &random);
  const std::vector<RangeChangeObservation> changes =
      ChangesOf(sky, velocity_mps, 75.0, 0.01, 1.0, &random);
  MotionFilter started;
  started.Start(MotionStart(), Eigen::Matrix3d::Identity());
  MotionVerdicts verdicts;
  started.Advance(1.0, rates, changes, MotionModel(), &verdicts);
  for (auto _ : state) {
    MotionFilter filter = started;
    filter.Advance(1.0, rates, changes, MotionModel(), &verdicts);
    benchmark::DoNotOptimize(filter);
  }
}
BENCHMARK(TimeUpdate);

// The same by an inertial sensor of a hundred samples a second.
void InertialUpdate(benchmark::State& state) {
  const InertialScene scene;
  Random random(4);
  std::vector<RangeRateObservation> rates;
  while (rates.size() < kSatellites) {
    for (const RangeRateObservation& rate : scene.RatesAt(1.0, 0.05, &random)) {
      if (rates.size() < kSatellites) rates.push_back(rate);
    }
  }
  const std::vector<InertialSample> samples = scene.Felt(0.0, 1.0);
  InertialFilter started;
  started.Start(scene.StateAt(0.0), Eigen::Matrix<double, 6, 6>::Identity(),
                1e-4 * Eigen::Matrix<double, 9, 9>::Identity());
  MotionVerdicts verdicts;
  for (auto _ : state) {
    InertialFilter filter = started;
    filter.Advance(samples, rates, {}, &verdicts);
    benchmark::DoNotOptimize(filter);
  }
}
BENCHMARK(InertialUpdate);

// With and without the filter, to compare; the satellites of three systems in view.
void SessionEpoch(benchmark::State& state) {
  FilterScene filter_scene({12.0, -7.0, 0.0});
  const SessionOptions options = filter_scene.scene.options;
  filter_scene.scene = SessionScene({kSceneGps, kSceneGalileo, kSceneBeidou});
  filter_scene.scene.options = options;
  filter_scene.scene.velocity_enu_mps = {12.0, -7.0, 0.0};
  filter_scene.scene.options.estimator =
      state.range(0) == 0 ? Estimator::kEpoch : Estimator::kFilter;
  const std::vector<ObservationEpoch> drive = filter_scene.Drive(60);
  std::size_t most = 0;
  for (const ObservationEpoch& epoch : drive) most = std::max(most, epoch.signals.size());
  const std::unique_ptr<Session> session = filter_scene.scene.Open();
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == drive.size()) {
      state.PauseTiming();
      session->Reset();
      next = 0;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(ProcessEpoch(session.get(), drive[next++]));
  }
  state.counters["satellites"] = static_cast<double>(most);
}
BENCHMARK(SessionEpoch)->ArgName("filter")->Arg(0)->Arg(1);

}  // namespace
}  // namespace lodemark::test

BENCHMARK_MAIN();
