// Cost of one epoch's position: clean, with reflections, and with a gross error that has to be
// found.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/fusion/point_adjustment.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

constexpr int kSatellites = 12;
constexpr double kClock_m = 54'321.0;

struct Epoch {
  Epoch(double late_probability, bool draw_reflections) {
    const EnuFrame frame({0.84, 0.28, 180.0});
    Random random(12);
    for (int i = 0; i < kSatellites; ++i) {
      const double azimuth_rad = 2.0 * kPi * i / kSatellites;
      const double elevation_rad = (i % 3 == 0 ? 60.0 : 15.0 + 2.0 * i) * kRadiansPerDegree;
      const Eigen::Vector3d direction(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                      std::cos(azimuth_rad) * std::cos(elevation_rad),
                                      std::sin(elevation_rad));
      RangeObservation range;
      range.point_in_ecef = frame.ToEcef(2.2e7 * direction);
      range.error = {4.0, late_probability, 30.0};
      range.clock_group = i % 2;
      range.range_m = (range.point_in_ecef - frame.origin_in_ecef()).norm() + kClock_m +
                      random.Gaussian(0.0, range.error.sigma_m);
      if (draw_reflections && i % 3 == 1) range.range_m += random.Exponential(30.0);
      ranges.push_back(range);
    }
    start_in_ecef = frame.ToEcef({20.0, -10.0, 5.0});
    biases.Set(1, {0.0, 1.0});
  }

  std::vector<RangeObservation> ranges;
  Eigen::Vector3d start_in_ecef;
  ClockBiases biases;
};

void Solve(benchmark::State& run, const Epoch& epoch) {
  PointAdjustment adjustment;
  PointEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  for (auto _ : run) {
    const PointStatus status = adjustment.Solve(epoch.ranges, epoch.start_in_ecef, epoch.biases,
                                                PointOptions(), &estimate, &verdicts);
    if (status != PointStatus::kGood) run.SkipWithError("no position");
    benchmark::DoNotOptimize(estimate);
  }
}

void Clean(benchmark::State& run) { Solve(run, Epoch(0.01, false)); }
void Reflections(benchmark::State& run) { Solve(run, Epoch(0.3, true)); }
void GrossErrors(benchmark::State& run) {
  Epoch epoch(0.01, false);
  epoch.ranges[3].range_m -= 700.0;
  epoch.ranges[8].range_m += 3e5;
  epoch.ranges[10].range_m += 4e3;
  Solve(run, epoch);
}

BENCHMARK(Clean);
BENCHMARK(Reflections);
BENCHMARK(GrossErrors);

}  // namespace
}  // namespace lodemark

BENCHMARK_MAIN();
