#include "tools/mapping/posed_map.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "tools/mapping/poses_table.h"
#include "tools/mapping/ties.h"
#include "tools/mapping/track_building.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

// Finds features in the photographs that are there; the others are noted.
Result<std::vector<ReconstructedImage>> DetectInImages(const PosedMapInput& input,
                                                       const std::vector<PosedImage>& poses,
                                                       const StageProgress& progress,
                                                       std::vector<std::string>* notes) {
  std::vector<ReconstructedImage> images;
  std::size_t missing = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    progress("Finding features", static_cast<double>(i) / static_cast<double>(poses.size()));
    const PosedImage& pose = poses[i];
    const std::string path = (fs::path(input.images) / pose.name).string();
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
      ++missing;
      continue;
    }
    if (!input.lens && !pose.pinhole) {
      return Error{ErrorCode::kInvalidArgument,
                   input.poses + ": has no columns fx .. height: name the camera, --camera"};
    }
    const Result<Lens> lens = Lens::Create(input.lens ? *input.lens : *pose.pinhole);
    if (!lens) return Error{lens.error().code, pose.name + ": " + lens.error().message};
    const Result<Photo> photo = ReadPhoto(path);
    if (!photo) return photo.error();
    if (photo->width_px != lens->parameters().width_px ||
        photo->height_px != lens->parameters().height_px) {
      return Error{ErrorCode::kBadData, path + ": is " + std::to_string(photo->width_px) + " x " +
                                            std::to_string(photo->height_px) +
                                            " pixels, its camera takes " +
                                            std::to_string(lens->parameters().width_px) + " x " +
                                            std::to_string(lens->parameters().height_px)};
    }
    Result<Features> features = DetectFeatures(
        {photo->pixels.data(), photo->width_px, photo->height_px, photo->width_px}, input.detector);
    if (!features) return Error{features.error().code, path + ": " + features.error().message};
    images.push_back({pose.name, *lens, pose.camera_from_world, std::move(features).value()});
  }
  if (missing > 0) {
    notes->push_back(std::to_string(missing) + " of " + std::to_string(poses.size()) +
                     " images with a pose are not in " + input.images + " and were passed over");
  }
  if (images.size() < 2) {
    return Error{ErrorCode::kBadData, input.images + ": holds fewer than two of the images that " +
                                          input.poses + " has poses of"};
  }
  return images;
}

// The similarity from the poses' world to the map's frame by the places of the cameras.
Result<Georegistration> RegisterByCameras(const PosedMapInput& input, const MapFrame& frame,
                                          const std::vector<CameraPlace>& places,
                                          const std::vector<PosedImage>& poses,
                                          std::vector<std::string>* tie_names) {
  std::vector<PosedCamera> cameras;
  for (const PosedImage& pose : poses) {
    cameras.push_back({pose.name, nullptr, &pose.camera_from_world});
  }
  const std::vector<TiePoint> ties = TiesOfCameras(places, cameras, frame, input.position_sigma_m);
  for (const TiePoint& tie : ties) tie_names->push_back(tie.name);
  const Result<Georegistration> found = Georegister(ties, input.registration);
  if (!found) {
    return Error{found.error().code, input.camera_positions + ": " + found.error().message};
  }
  return found;
}

}  // namespace

Result<BuiltMap> BuildPosedMap(const PosedMapInput& input, const StageProgress& progress) {
  Result<std::vector<PosedImage>> poses = ReadPosesTable(input.poses);
  if (!poses) return poses.error();
  BuiltMap built;
  std::vector<TablePlace> places;
  std::vector<CameraPlace> cameras;
  if (!input.camera_positions.empty()) {
    PlaceOptions options = input.places;
    options.local = input.frame.local;
    Result<std::vector<CameraPlace>> read = ReadCameraPlaces(input.camera_positions, options);
    if (!read) return read.error();
    cameras = std::move(read).value();
    for (const CameraPlace& camera : cameras) places.push_back(camera.place);
  }
  const Result<MapFrame> frame = MapFrame::Choose(input.frame, places);
  if (!frame) return frame.error();
  Similarity3 enu_from_world;
  if (!cameras.empty()) {
    Result<Georegistration> registration =
        RegisterByCameras(input, *frame, cameras, *poses, &built.tie_names);
    if (!registration) return registration.error();
    enu_from_world = registration->enu_from_model;
    built.registration = std::move(registration).value();
  }
  if (!input.role.empty()) {
    std::set<std::string> wanted;
    for (const CameraPlace& camera : cameras) {
      if (camera.role == input.role) wanted.insert(camera.name);
    }
    std::erase_if(*poses, [&](const PosedImage& pose) { return !wanted.contains(pose.name); });
    if (poses->empty()) {
      return Error{ErrorCode::kInvalidArgument,
                   input.camera_positions + ": no image there has the role '" + input.role + "'"};
    }
  }

  Result<std::vector<ReconstructedImage>> images =
      DetectInImages(input, *poses, progress, &built.notes);
  if (!images) return images.error();
  Reconstruction reconstruction;
  reconstruction.kind = input.detector.kind;
  reconstruction.images = std::move(images).value();
  const std::vector<FeatureTrack> tracks = BuildTracks(
      reconstruction.images, input.matching, [&](double share) { progress("Matching", share); });
  TriangulateTracks(
      tracks, input.triangulation, [&](double share) { progress("Triangulating", share); },
      &reconstruction);
  if (reconstruction.points.empty()) {
    return Error{ErrorCode::kBadData,
                 "no point was seen in two images: do the poses belong to the images, world to "
                 "camera, and the camera to both?"};
  }
  built.noise_px = reconstruction.noise_px;
  built.info = InfoFor(*frame, input.labels, input.detector.kind);
  built.content = ContentFrom(reconstruction, enu_from_world);
  return built;
}

}  // namespace lodemark
