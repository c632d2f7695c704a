#include "tools/mapping/map_content.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "core/map/feature_map_writer.h"

namespace lodemark {
namespace {

constexpr std::size_t kDescriptorsAtOnce = 100'000;

template <typename Thing>
const Thing* ById(const std::vector<Thing>& things, std::uint32_t id) {
  const auto at =
      std::lower_bound(things.begin(), things.end(), id,
                       [](const Thing& thing, std::uint32_t x) { return thing.id < x; });
  return at != things.end() && at->id == id ? &*at : nullptr;
}

Status Fill(const MapContent& content, std::size_t descriptor_bytes, const Progress& progress,
            FeatureMapWriter* writer) {
  // Learning the index when all is there takes about as long as everything before.
  const double work = 2.0 * static_cast<double>(content.landmarks.size() + content.origins.size());
  std::size_t done = 0;
  for (const DatabaseImage& image : content.images) {
    const Status status = writer->AddImage(image);
    if (!status.ok()) return status;
  }
  for (const Landmark& landmark : content.landmarks) {
    const Status status = writer->AddLandmark(landmark);
    if (!status.ok()) return status;
    if (++done % 1024 == 0) progress(static_cast<double>(done) / work);
  }
  for (const BuildingPart& part : content.building_parts) {
    const Status status = writer->AddBuildingPart(part);
    if (!status.ok()) return status;
  }
  const std::span<const DescriptorOrigin> origins = content.origins;
  const std::span<const std::uint8_t> descriptors = content.descriptors;
  for (std::size_t at = 0; at < origins.size(); at += kDescriptorsAtOnce) {
    const std::size_t count = std::min(kDescriptorsAtOnce, origins.size() - at);
    const Status status = writer->AddDescriptors(
        origins.subspan(at, count),
        descriptors.subspan(at * descriptor_bytes, count * descriptor_bytes));
    if (!status.ok()) return status;
    done += count;
    progress(static_cast<double>(done) / work);
  }
  return writer->Commit();
}

}  // namespace

MapContent ContentFrom(const Reconstruction& reconstruction, const Similarity3& enu_from_world) {
  MapContent content;
  for (std::size_t i = 0; i < reconstruction.images.size(); ++i) {
    const ReconstructedImage& image = reconstruction.images[i];
    const Rigid3 camera_from_enu = CameraFromTarget(image.camera_from_world, enu_from_world);
    DatabaseImage row;
    row.id = static_cast<std::uint32_t>(i) + 1;
    row.name = image.name;
    row.position_in_enu_m = camera_from_enu.Inverse().translation();
    row.camera_from_enu = camera_from_enu.rotation();
    row.pose_known = true;
    content.images.push_back(std::move(row));
  }
  const Eigen::Matrix3d turn = enu_from_world.scale * enu_from_world.rotation.toRotationMatrix();
  const std::size_t bytes = DescriptorBytes(reconstruction.kind);
  for (std::size_t p = 0; p < reconstruction.points.size(); ++p) {
    const ReconstructedPoint& point = reconstruction.points[p];
    Landmark landmark;
    landmark.id = static_cast<std::uint32_t>(p) + 1;
    landmark.position_in_enu_m = enu_from_world * point.in_world;
    const Eigen::Matrix3d covariance = turn * point.covariance * turn.transpose();
    landmark.covariance_m2 = 0.5 * (covariance + covariance.transpose());
    content.landmarks.push_back(landmark);
    for (const ImageFeature& seen : point.seen) {
      const ReconstructedImage& image = reconstruction.images[seen.image];
      const LensParameters& lens = image.lens.parameters();
      const Keypoint& keypoint = image.features.keypoints[seen.feature];
      DescriptorOrigin origin;
      origin.landmark_id = landmark.id;
      origin.image_id = seen.image + 1;
      content.origins.push_back(origin);
      content.places_in_image.emplace_back(
          (keypoint.x_px + 0.5F) / static_cast<float>(lens.width_px),
          (keypoint.y_px + 0.5F) / static_cast<float>(lens.height_px));
      const std::uint8_t* const from = image.features.descriptors.data() + seen.feature * bytes;
      content.descriptors.insert(content.descriptors.end(), from, from + bytes);
    }
  }
  NoteViewingDirections(&content);
  return content;
}

MapContent ContentFrom(const std::vector<TableLandmark>& landmarks,
                       const std::vector<Eigen::Vector3d>& landmarks_in_enu_m,
                       const std::vector<Eigen::Matrix3d>& covariances_m2,
                       LandmarkDescriptors descriptors) {
  MapContent content;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    content.landmarks.push_back({landmarks[i].id, landmarks_in_enu_m[i], covariances_m2[i]});
  }
  for (const std::uint32_t id : descriptors.landmark_ids) {
    DescriptorOrigin origin;
    origin.landmark_id = id;
    content.origins.push_back(origin);
  }
  content.descriptors = std::move(descriptors.descriptors);
  return content;
}

void NoteViewingDirections(MapContent* content) {
  for (DescriptorOrigin& origin : content->origins) {
    const DatabaseImage* const image = ById(content->images, origin.image_id);
    const Landmark* const landmark = ById(content->landmarks, origin.landmark_id);
    if (image == nullptr || landmark == nullptr || !image->pose_known) continue;
    const Eigen::Vector3d to_camera = image->position_in_enu_m - landmark->position_in_enu_m;
    const double distance_m = to_camera.norm();
    if (!(distance_m > 0.0)) continue;
    origin.direction_to_camera = (to_camera / distance_m).cast<float>();
    origin.distance_m = static_cast<float>(distance_m);
  }
}

Status WriteMap(const std::string& path, const MapInfo& info, const MapContent& content,
                const Progress& progress) {
  Result<std::unique_ptr<FeatureMapWriter>> writer = FeatureMapWriter::Create(path, info);
  if (!writer) return writer.error();
  const Status status =
      Fill(content, DescriptorBytes(info.descriptor_kind), progress, writer->get());
  if (status.ok()) {
    progress(1.0);
    return status;
  }
  writer->reset();
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return status;
}

}  // namespace lodemark
