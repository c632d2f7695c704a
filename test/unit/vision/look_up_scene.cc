#include "test/unit/vision/look_up_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/unit/map/map_scene.h"

namespace lodemark::test {
namespace {

// Bytes of a histogram's square roots, of norm 512.
Look RootsOf(const std::vector<double>& histogram) {
  double sum = 0.0;
  for (const double value : histogram) sum += value;
  Look look;
  for (const double value : histogram) {
    look.push_back(
        static_cast<std::uint8_t>(std::min(255.0, 512.0 * std::sqrt(value / sum) + 0.5)));
  }
  return look;
}

}  // namespace

Look RandomLook(DescriptorKind kind, Random& random) {
  if (kind == DescriptorKind::kOrb) {
    Look look(32);
    for (std::uint8_t& byte : look) byte = static_cast<std::uint8_t>(random.NextBits());
    return look;
  }
  std::vector<double> histogram(128);
  for (double& value : histogram) value = std::pow(random.Uniform(), 4.0);
  return RootsOf(histogram);
}

Look SeenAgain(DescriptorKind kind, const Look& look, Random& random) {
  Look again = look;
  if (kind == DescriptorKind::kOrb) {
    for (int i = 0; i < 12; ++i) {
      again[random.Index(32)] ^= static_cast<std::uint8_t>(1U << random.Index(8));
    }
    return again;
  }
  for (std::uint8_t& byte : again) {
    byte = static_cast<std::uint8_t>(std::clamp(byte + random.Gaussian(0.0, 6.0), 0.0, 255.0));
  }
  return again;
}

void MapDraft::Add(std::uint32_t id, const Eigen::Vector3d& position_in_enu_m,
                   const std::vector<Look>& looks, const Eigen::Vector3d& seen_from_m) {
  Landmark landmark;
  landmark.id = id;
  landmark.position_in_enu_m = position_in_enu_m;
  landmark.covariance_m2 = Eigen::Vector3d(1e-4, 2e-4, 3e-4).asDiagonal();
  landmarks_.push_back(landmark);
  const Eigen::Vector3d to_camera_m = seen_from_m - position_in_enu_m;
  for (const Look& look : looks) {
    origins_.push_back(
        {id, 0, to_camera_m.normalized().cast<float>(), static_cast<float>(to_camera_m.norm())});
    descriptors_.insert(descriptors_.end(), look.begin(), look.end());
  }
}

std::unique_ptr<FeatureMap> MapDraft::Open() const {
  // Opened files outlive their names.
  const ScratchFolder folder;
  const std::string path = folder.File("look_up.map");
  MapInfo info;
  info.origin = {0.8, 0.1, 200.0};
  info.datum = "WGS84 (G2139)";
  info.descriptor_kind = kind_;
  info.provenance = "made up";
  Result<std::unique_ptr<FeatureMapWriter>> writer = FeatureMapWriter::Create(path, info);
  if (!writer) {
    ADD_FAILURE() << writer.error().message;
    return nullptr;
  }
  DatabaseImage image;
  image.name = "0.jpg";
  EXPECT_TRUE((*writer)->AddImage(image).ok());
  for (const Landmark& landmark : landmarks_) EXPECT_TRUE((*writer)->AddLandmark(landmark).ok());
  EXPECT_TRUE((*writer)->AddDescriptors(origins_, descriptors_).ok());
  const Status committed = (*writer)->Commit();
  EXPECT_TRUE(committed.ok()) << (committed ? "" : committed.error().message);
  writer->reset();
  Result<std::unique_ptr<FeatureMap>> map = FeatureMap::Open(path);
  EXPECT_TRUE(map.ok()) << (map ? "" : map.error().message);
  return map ? std::move(*map) : nullptr;
}

Lens SceneLens() {
  LensParameters parameters;
  parameters.width_px = 640;
  parameters.height_px = 480;
  parameters.fx_px = 490.0;
  parameters.fy_px = 490.0;
  parameters.cx_px = 319.5;
  parameters.cy_px = 239.5;
  return Lens::Create(parameters).value();
}

Rigid3 LookingNorth(const Eigen::Vector3d& camera_in_enu_m) {
  Eigen::Matrix3d rotation;
  rotation << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0;
  return {Eigen::Quaterniond(rotation), -(rotation * camera_in_enu_m)};
}

Eigen::Vector3d PlaceAhead(Random& random) {
  const double ahead_m = random.Uniform(15.0, 40.0);
  return {ahead_m * random.Uniform(-0.6, 0.6), ahead_m, ahead_m * random.Uniform(-0.45, 0.45)};
}

void AddFeature(const Eigen::Vector2d& pixel, const Look& look, Features* features) {
  Keypoint keypoint;
  keypoint.x_px = static_cast<float>(pixel.x());
  keypoint.y_px = static_cast<float>(pixel.y());
  keypoint.size_px = 4.0F;
  features->keypoints.push_back(keypoint);
  features->descriptors.insert(features->descriptors.end(), look.begin(), look.end());
}

}  // namespace lodemark::test
