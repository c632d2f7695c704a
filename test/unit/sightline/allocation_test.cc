// A program of its own, since it replaces operator new: asking about sight lines allocates nothing.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "core/sightline/reflection.h"
#include "core/sightline/sight_chance.h"
#include "core/sightline/sight_volume.h"
#include "core/sightline/skyline.h"
#include "test/unit/sightline/town.h"

namespace {

std::int64_t allocations = 0;

void* Allocate(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return Allocate(size); }
void* operator new[](std::size_t size) { return Allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace lodemark {
namespace {

TEST(SightlineAllocation, QueriesMakeNone) {
  const BuildingScene scene = SceneOf(Town(91, 20));
  UncertainViewpoint viewpoint(&scene);
  std::array<Reflection, 8> reflections;
  const std::int64_t before = allocations;
  double sum = 0.0;
  for (double azimuth_rad = 0.0; azimuth_rad < 6.0; azimuth_rad += 0.3) {
    const SightPath path = SightPath::Towards({3, 2, 1.5}, DirectionFromAngles(azimuth_rad, 0.6));
    viewpoint.Stand({3, 2, 1.5}, 25.0 * Eigen::Matrix3d::Identity());
    sum += viewpoint.Towards(path.direction, 0.19).probability;
    sum += viewpoint.To(path.At(70.0), 0.0, 0.2).probability;
    sum += scene.IsFree(path) ? 1.0 : 0.0;
    sum += scene.FirstBlocker(path) ? 1.0 : 0.0;
    sum += static_cast<double>(FindReflections(scene, path, 200.0, reflections));
    sum += SkylineElevation(scene, {3, 2, 1.5}, azimuth_rad);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace lodemark
