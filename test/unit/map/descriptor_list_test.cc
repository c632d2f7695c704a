// The packed lists of core/map/descriptor_index.h, and what a scope lets through.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/map/descriptor_index.h"

namespace lodemark {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kPi = 3.14159265358979;

Bytes RandomBytes(std::size_t count, Random& random) {
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.NextBits() >> 56);
  return bytes;
}

Eigen::Vector3f RandomDirection(Random& random) {
  const Eigen::Vector3d v(random.Gaussian(), random.Gaussian(), random.Gaussian());
  return v.normalized().cast<float>();
}

double AngleDeg(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return 180.0 / kPi *
         std::atan2(a.cast<double>().cross(b.cast<double>()).norm(),
                    a.cast<double>().dot(b.cast<double>()));
}

// Some descriptors and a quantiser of them.
struct Scene {
  Scene(DescriptorKind which, std::size_t count, int lists) : kind(which) {
    Random random(17);
    descriptors = RandomBytes(count * DescriptorBytes(kind), random);
    for (std::size_t i = 0; i < count; ++i) {
      DescriptorOrigin origin;
      origin.landmark_id = static_cast<std::uint32_t>(random.NextBits() >> 33);
      origin.image_id = static_cast<std::uint32_t>(random.NextBits() >> 32);
      origin.direction_to_camera = RandomDirection(random);
      origin.distance_m = static_cast<float>(std::exp(random.Uniform(std::log(0.02), 11.0)));
      origins.push_back(origin);
    }
    quantizer.emplace(DescriptorQuantizer::Train(kind, descriptors, {.lists = lists}));
    block = quantizer->PackList(0, origins, descriptors);
  }

  DescriptorKind kind;
  Bytes descriptors;
  std::vector<DescriptorOrigin> origins;
  std::optional<DescriptorQuantizer> quantizer;
  Bytes block;
};

TEST(DescriptorList, GivesBackWhatWasPacked) {
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    for (const int lists : {1, 4}) {
      const Scene scene(kind, 77, lists);
      // Nothing relies on alignment.
      Bytes shifted(1, 0);
      shifted.insert(shifted.end(), scene.block.begin(), scene.block.end());
      const auto view = DescriptorListView::Parse(kind, std::span(shifted).subspan(1));
      ASSERT_TRUE(view.ok());
      ASSERT_EQ(view->size(), 77U);
      EXPECT_EQ(view->kind(), kind);
      EXPECT_EQ(view->codes() != nullptr, kind == DescriptorKind::kRootSift && lists > 1);
      for (std::size_t i = 0; i < 77; ++i) {
        const DescriptorOrigin origin = view->origin(i);
        EXPECT_EQ(origin.landmark_id, scene.origins[i].landmark_id);
        EXPECT_EQ(view->landmark_id(i), scene.origins[i].landmark_id);
        EXPECT_EQ(origin.image_id, scene.origins[i].image_id);
        const std::size_t bytes_each = DescriptorBytes(kind);
        EXPECT_TRUE(std::equal(view->descriptor(i), view->descriptor(i) + bytes_each,
                               scene.descriptors.data() + i * bytes_each));
      }
    }
  }
}

TEST(DescriptorList, OriginsAreCloseToWhatTheyWere) {
  const Scene scene(DescriptorKind::kRootSift, 5'000, 1);
  const auto view = DescriptorListView::Parse(scene.kind, scene.block);
  ASSERT_TRUE(view.ok());
  std::vector<DescriptorOrigin> unpacked;
  for (std::size_t i = 0; i < view->size(); ++i) {
    const DescriptorOrigin origin = view->origin(i);
    EXPECT_LT(AngleDeg(origin.direction_to_camera, scene.origins[i].direction_to_camera), 1.0);
    EXPECT_NEAR(origin.direction_to_camera.norm(), 1.0F, 1e-5F);
    EXPECT_NEAR(origin.distance_m / scene.origins[i].distance_m, 1.0F, 2e-4F);
    unpacked.push_back(origin);
  }
  // Packing again changes nothing more.
  const Bytes again = scene.quantizer->PackList(0, unpacked, scene.descriptors);
  const auto second = DescriptorListView::Parse(scene.kind, again);
  ASSERT_TRUE(second.ok());
  for (std::size_t i = 0; i < second->size(); ++i) {
    EXPECT_LT(AngleDeg(second->origin(i).direction_to_camera, unpacked[i].direction_to_camera),
              1e-3);
    EXPECT_EQ(second->origin(i).distance_m, unpacked[i].distance_m);
  }
}

TEST(DescriptorList, AnOriginNobodyNotedStaysUnknown) {
  const float infinite = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<DescriptorOrigin> origins(5);
  origins[1].direction_to_camera = Eigen::Vector3f(nan, 0.0F, 1.0F);
  origins[1].distance_m = nan;
  origins[2].direction_to_camera = Eigen::Vector3f(infinite, 0.0F, 1.0F);
  origins[2].distance_m = infinite;
  origins[3].distance_m = -4.0F;
  origins[4].direction_to_camera = -Eigen::Vector3f::UnitZ();
  origins[4].distance_m = 1e30F;
  const Bytes descriptors(5 * 32, 1);
  const auto quantizer = DescriptorQuantizer::Train(DescriptorKind::kOrb, descriptors, {});
  const Bytes block = quantizer.PackList(0, origins, descriptors);
  const auto view = DescriptorListView::Parse(DescriptorKind::kOrb, block);
  ASSERT_TRUE(view.ok());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(view->origin(i).direction_to_camera.isZero()) << i;
    EXPECT_EQ(view->origin(i).distance_m, 0.0F) << i;
  }
  EXPECT_LT(AngleDeg(view->origin(4).direction_to_camera, -Eigen::Vector3f::UnitZ()), 1e-3);
  EXPECT_NEAR(view->origin(4).distance_m, 1e6F, 1.0F);
}

TEST(DescriptorList, TakesAtMost160BytesADescriptor) {
  const Scene scene(DescriptorKind::kRootSift, 256, 2);
  EXPECT_LE(static_cast<double>(scene.block.size()) / 256.0, 160.0);
}

TEST(DescriptorList, IsNotBelievedWhenItSaysMoreThanItHolds) {
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    const Scene scene(kind, 40, 3);
    const auto other =
        kind == DescriptorKind::kOrb ? DescriptorKind::kRootSift : DescriptorKind::kOrb;
    EXPECT_FALSE(DescriptorListView::Parse(other, scene.block).ok());
    for (std::size_t size = 0; size < scene.block.size(); ++size) {
      EXPECT_FALSE(DescriptorListView::Parse(kind, std::span(scene.block).first(size)).ok());
    }
    Bytes longer = scene.block;
    longer.push_back(0);
    EXPECT_FALSE(DescriptorListView::Parse(kind, longer).ok());
    // A size that wraps around 32 bits when multiplied by the bytes of a descriptor.
    for (const std::uint32_t count : {41U, 0x80000000U, 0xffffffffU, 0x0ccccccdU}) {
      Bytes more = scene.block;
      for (int i = 0; i < 4; ++i) {
        more[static_cast<std::size_t>(8 + i)] = static_cast<std::uint8_t>(count >> (8 * i));
      }
      const auto view = DescriptorListView::Parse(kind, more);
      ASSERT_FALSE(view.ok());
      EXPECT_FALSE(view.error().message.empty());
    }
  }
}

// One landmark 100 m north of the origin, photographed from there.
struct OneLandmark {
  OneLandmark() {
    origins[0].landmark_id = 0;
    origins[0].direction_to_camera = Eigen::Vector3f(0.0F, -1.0F, 0.0F);
    origins[0].distance_m = 100.0F;
  }

  bool FoundFrom(const Eigen::Vector3f& camera_m, float sigma_m = 0.0F) const {
    const Bytes descriptor(128, 9);
    const auto quantizer = DescriptorQuantizer::Train(DescriptorKind::kRootSift, descriptor, {});
    const Bytes block = quantizer.PackList(0, origins, descriptor);
    const auto view = DescriptorListView::Parse(DescriptorKind::kRootSift, block);
    DescriptorSearch search(quantizer, descriptor, {});
    SearchScope scope;
    scope.landmark_positions_m = positions;
    scope.camera_in_enu_m = camera_m;
    scope.camera_sigma_m = sigma_m;
    search.Visit(0, *view, scope);
    return search.nearest()[0].landmark_id == 0;
  }

  std::vector<DescriptorOrigin> origins = std::vector<DescriptorOrigin>(1);
  std::vector<Eigen::Vector3f> positions = {Eigen::Vector3f(0.0F, 100.0F, 0.0F)};
};

// A camera at a distance from the landmark, turned about it from where the photograph was taken.
Eigen::Vector3f Turned(double angle_deg, double distance_m) {
  const double angle_rad = angle_deg * kPi / 180.0;
  return Eigen::Vector3d(distance_m * std::sin(angle_rad), 100.0 - distance_m * std::cos(angle_rad),
                         0.0)
      .cast<float>();
}

TEST(SearchScope, PassesOverViewsFromAnotherSide) {
  const OneLandmark landmark;
  EXPECT_TRUE(landmark.FoundFrom(Turned(0.0, 100.0)));
  EXPECT_TRUE(landmark.FoundFrom(Turned(58.0, 100.0)));  // the widest turn is 60.2 degrees
  EXPECT_TRUE(landmark.FoundFrom(Turned(-58.0, 100.0)));
  EXPECT_FALSE(landmark.FoundFrom(Turned(62.5, 100.0)));
  EXPECT_FALSE(landmark.FoundFrom(Turned(180.0, 100.0)));
}

TEST(SearchScope, PassesOverViewsFromMuchNearerOrFurther) {
  const OneLandmark landmark;
  EXPECT_TRUE(landmark.FoundFrom(Turned(10.0, 299.0)));
  EXPECT_FALSE(landmark.FoundFrom(Turned(10.0, 301.0)));
  EXPECT_TRUE(landmark.FoundFrom(Turned(10.0, 33.5)));
  EXPECT_FALSE(landmark.FoundFrom(Turned(10.0, 33.2)));
}

TEST(SearchScope, AllowsForNotKnowingWhereTheCameraIs) {
  const OneLandmark landmark;
  // Three sigmas of 10 m at 100 m are asin(0.3) = 17.5 degrees.
  EXPECT_TRUE(landmark.FoundFrom(Turned(76.0, 100.0), 10.0F));
  EXPECT_FALSE(landmark.FoundFrom(Turned(80.0, 100.0), 10.0F));
  EXPECT_TRUE(landmark.FoundFrom(Turned(0.0, 329.0), 10.0F));
  EXPECT_FALSE(landmark.FoundFrom(Turned(0.0, 331.0), 10.0F));
  EXPECT_TRUE(landmark.FoundFrom(Turned(180.0, 100.0), 40.0F));  // could be anywhere
}

TEST(SearchScope, LetsThroughWhatNobodyNoted) {
  OneLandmark landmark;
  landmark.origins[0].direction_to_camera.setZero();
  EXPECT_TRUE(landmark.FoundFrom(Turned(180.0, 100.0)));
  EXPECT_FALSE(landmark.FoundFrom(Turned(180.0, 400.0)));
  landmark.origins[0].distance_m = 0.0F;
  EXPECT_TRUE(landmark.FoundFrom(Turned(180.0, 400.0)));
  landmark.origins[0].landmark_id = 0;
  landmark.positions[0].setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(landmark.FoundFrom(Turned(180.0, 400.0)));
}

}  // namespace
}  // namespace lodemark
