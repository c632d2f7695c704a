// Cost of asking, for one epoch, whether thirty satellites are in sight among a thousand buildings.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/sightline/reflection.h"
#include "core/sightline/sight_chance.h"

namespace lodemark {
namespace {

constexpr int kSatellites = 30;
constexpr int kBuildings = 1000;
constexpr double kL1_m = 0.190293672798;

// A town of 32 x 32 plots of 40 m less a few, each with a turned house of 10 to 40 m; the receiver
// stands in a street in its middle. Satellites over the whole sky, as many low as a sphere has.
struct Town {
  Town() {
    Random random(7);
    std::vector<BuildingPrism> parts;
    for (int plot = 0; plot < 32 * 32 && parts.size() < kBuildings; ++plot) {
      const Eigen::Vector2d middle(40.0 * (plot % 32 - 15.5), 40.0 * (plot / 32 - 15.5));
      const double turn_rad = random.Uniform(0.0, 0.5);
      const double side_m = random.Uniform(10.0, 15.0);
      BuildingPrism prism;
      prism.building = static_cast<std::uint32_t>(parts.size());
      for (int i = 0; i < 4; ++i) {
        const double angle_rad = turn_rad + 0.5 * kPi * (i + 0.5);
        prism.footprint.emplace_back(middle +
                                     std::sqrt(2.0) * side_m *
                                         Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
      }
      prism.top_m = random.Uniform(10.0, 40.0);
      prism.top_sigma_m = 2.0;
      parts.push_back(prism);
    }
    scene = *BuildingScene::Make(parts);
    for (int i = 0; i < kSatellites; ++i) {
      const double sine = (i + 0.5) / kSatellites;
      directions.push_back(DirectionFromAngles(2.4 * i, std::asin(sine)));
    }
  }

  BuildingScene scene;
  std::vector<Eigen::Vector3d> directions;
  Eigen::Vector3d here = {0.0, 0.0, 1.5};
};

void PlainRays(benchmark::State& run) {
  const Town town;
  int free = 0;
  for (auto _ : run) {
    free = 0;
    for (const Eigen::Vector3d& direction : town.directions) {
      if (town.scene.IsFree({town.here, direction})) ++free;
    }
    benchmark::DoNotOptimize(free);
  }
  run.counters["free"] = free;
}

void FirstBlockers(benchmark::State& run) {
  const Town town;
  for (auto _ : run) {
    for (const Eigen::Vector3d& direction : town.directions) {
      benchmark::DoNotOptimize(town.scene.FirstBlocker({town.here, direction}));
    }
  }
}

// What the tree saves.
void PlainRaysOnePartAfterAnother(benchmark::State& run) {
  const Town town;
  int free = 0;
  for (auto _ : run) {
    free = 0;
    for (const Eigen::Vector3d& direction : town.directions) {
      bool is_free = true;
      for (std::size_t part = 0; is_free && part < town.scene.part_count(); ++part) {
        const Chord chord = town.scene.ClipLine(part, town.here, direction);
        is_free = chord.exit_m - std::max(chord.enter_m, 0.0) <= 1e-6;
      }
      if (is_free) ++free;
    }
    benchmark::DoNotOptimize(free);
  }
  run.counters["free"] = free;
}

void Chances(benchmark::State& run) {
  const Town town;
  UncertainViewpoint viewpoint(&town.scene);
  const double sigma_m = static_cast<double>(run.range(0));
  double sum = 0.0;
  for (auto _ : run) {
    viewpoint.Stand(town.here, sigma_m * sigma_m * Eigen::Matrix3d::Identity());
    sum = 0.0;
    for (const Eigen::Vector3d& direction : town.directions) {
      sum += viewpoint.Towards(direction, kL1_m).probability;
    }
    benchmark::DoNotOptimize(sum);
  }
  run.counters["expected_free"] = sum;
}

void Reflections(benchmark::State& run) {
  const Town town;
  std::array<Reflection, 16> out;
  for (auto _ : run) {
    for (const Eigen::Vector3d& direction : town.directions) {
      benchmark::DoNotOptimize(FindReflections(town.scene, {town.here, direction}, 300.0, out));
    }
  }
}

BENCHMARK(PlainRays)->Unit(benchmark::kMicrosecond);
BENCHMARK(FirstBlockers)->Unit(benchmark::kMicrosecond);
BENCHMARK(PlainRaysOnePartAfterAnother)->Unit(benchmark::kMicrosecond);
BENCHMARK(Chances)->Arg(1)->Arg(5)->Arg(15)->Unit(benchmark::kMicrosecond);
BENCHMARK(Reflections)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lodemark

BENCHMARK_MAIN();
