// A feature map made on the spot, and what a camera at its origin that looks north sees of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/map/feature_map.h"
#include "core/map/feature_map_writer.h"
#include "core/vision/features.h"

namespace lodemark::test {

using Look = std::vector<std::uint8_t>;  // one descriptor

// Descriptors as SIFT or ORB gives them, of nothing in particular.
Look RandomLook(DescriptorKind kind, Random& random);

// The same thing seen again.
Look SeenAgain(DescriptorKind kind, const Look& look, Random& random);

// Collects landmarks and writes them as a map.
class MapDraft {
 public:
  explicit MapDraft(DescriptorKind kind = DescriptorKind::kRootSift) : kind_(kind) {}

  // With as many descriptors as looks, all noted from the place given; 0 looks are none.
  void Add(std::uint32_t id, const Eigen::Vector3d& position_in_enu_m,
           const std::vector<Look>& looks,
           const Eigen::Vector3d& seen_from_m = Eigen::Vector3d::Zero());

  // Written to a file that has no name any more, and opened.
  std::unique_ptr<FeatureMap> Open() const;

 private:
  DescriptorKind kind_;
  std::vector<Landmark> landmarks_;
  std::vector<DescriptorOrigin> origins_;
  std::vector<std::uint8_t> descriptors_;
};

// 640 x 480, 66 degrees wide.
Lens SceneLens();

// Axes to the east, down and to the north; at a place on the ground plane.
Rigid3 LookingNorth(const Eigen::Vector3d& camera_in_enu_m = Eigen::Vector3d::Zero());

// In front of such a camera, all in its image.
Eigen::Vector3d PlaceAhead(Random& random);

void AddFeature(const Eigen::Vector2d& pixel, const Look& look, Features* features);

}  // namespace lodemark::test
