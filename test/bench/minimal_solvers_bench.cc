// Time of one call of each minimal solver, all its poses included, over many random scenes.

#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "core/resection/minimal_solvers.h"
#include "test/unit/resection/random_scenes.h"

namespace lodemark {
namespace {

constexpr std::size_t kScenes = 1024;

template <std::size_t Count>
std::vector<Scene<Count>> RandomScenes() {
  Random random(1);
  std::vector<Scene<Count>> scenes;
  for (std::size_t i = 0; i < kScenes; ++i) {
    std::array<Eigen::Vector3d, Count> points;
    for (Eigen::Vector3d& point : points) point = PointInFront(random);
    scenes.push_back(SceneOf(points, 30.0, random));
  }
  return scenes;
}

void ThreePoints(benchmark::State& state) {
  const std::vector<Scene<3>> scenes = RandomScenes<3>();
  std::size_t i = 0;
  for (auto _ : state) {
    const Scene<3>& scene = scenes[i++ % kScenes];
    benchmark::DoNotOptimize(PoseFromThreePoints(scene.bearings, scene.points_in_world));
  }
}
BENCHMARK(ThreePoints);

void TwoPointsAndGravity(benchmark::State& state) {
  const std::vector<Scene<2>> scenes = RandomScenes<2>();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::vector<Eigen::Vector3d> ups_in_camera;
  for (const Scene<2>& scene : scenes) {
    ups_in_camera.push_back(scene.camera_from_world.rotation() * up);
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % kScenes;
    benchmark::DoNotOptimize(PoseFromTwoPointsAndGravity(
        scenes[k].bearings, scenes[k].points_in_world, ups_in_camera[k], up));
  }
}
BENCHMARK(TwoPointsAndGravity);

// A square of 10 m, 20 m away, its corners turned a little out of the image plane.
void Plane(benchmark::State& state) {
  const Eigen::Index count = state.range(0);
  Random random(1);
  Eigen::Matrix3Xd points(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double x = random.Uniform(-5.0, 5.0);
    points.col(i) << x, random.Uniform(-5.0, 5.0), 20.0 + 0.5 * x;
  }
  const Eigen::Matrix3Xd bearings = points.colwise().normalized();
  for (auto _ : state) benchmark::DoNotOptimize(PoseFromPlane(bearings, points));
}
BENCHMARK(Plane)->Arg(4)->Arg(100);

void FourPointsAndFocalLength(benchmark::State& state) {
  const std::vector<Scene<4>> scenes = RandomScenes<4>();
  std::vector<std::array<Eigen::Vector2d, 4>> pixels(kScenes);
  for (std::size_t k = 0; k < kScenes; ++k) {
    for (std::size_t j = 0; j < 4; ++j) {
      pixels[k][j] = 1000.0 * scenes[k].bearings[j].hnormalized();
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % kScenes;
    benchmark::DoNotOptimize(PoseAndFocalFromFourPoints(pixels[k], scenes[k].points_in_world));
  }
}
BENCHMARK(FourPointsAndFocalLength);

}  // namespace
}  // namespace lodemark

BENCHMARK_MAIN();
