#include "tools/mapping/colmap_map.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/camera/colmap_camera.h"
#include "core/map/descriptor.h"
#include "tools/mapping/colmap_database.h"
#include "tools/mapping/colmap_model.h"

namespace lodemark {
namespace {

// COLMAP's scale is the sigma of the blur; OpenCV's size, which weighs features, twice that.
constexpr float kSizeOfScale = 2.0F;
constexpr float kUsualSize_px = 4.0F;

struct ModelWithFeatures {
  Reconstruction reconstruction;
  std::vector<FeatureTrack> tracks;  // one for each point
  std::vector<Eigen::Vector3d> places;
};

// The features that points are seen as, of each image, with their descriptors.
Result<ReconstructedImage> TakeImage(const ColmapModel& model, const ColmapImage& image,
                                     ColmapDatabase* database,
                                     std::vector<std::uint32_t>* index_of_feature) {
  const ColmapCamera& camera = *model.CameraById(image.camera_id);
  const Result<LensParameters> parameters =
      LensFromColmap(camera.model, camera.width_px, camera.height_px, camera.parameters);
  if (!parameters) {
    return Error{parameters.error().code,
                 "camera " + std::to_string(camera.id) + ": " + parameters.error().message};
  }
  const Result<Lens> lens = Lens::Create(*parameters);
  if (!lens) {
    return Error{lens.error().code,
                 "camera " + std::to_string(camera.id) + ": " + lens.error().message};
  }
  const Result<ColmapImageFeatures> stored = database->Features(image);
  if (!stored) return stored.error();

  ReconstructedImage taken{image.name, *lens, image.camera_from_world, {}};
  const std::size_t bytes = DescriptorBytes(DescriptorKind::kRootSift);
  index_of_feature->assign(image.features.size(), 0);
  for (std::size_t i = 0; i < image.features.size(); ++i) {
    const ColmapFeature& feature = image.features[i];
    if (feature.point_id == ColmapFeature::kNoPoint) continue;
    (*index_of_feature)[i] = static_cast<std::uint32_t>(taken.features.keypoints.size());
    Keypoint keypoint;
    keypoint.x_px = static_cast<float>(feature.x_px - kColmapPixelShift_px);
    keypoint.y_px = static_cast<float>(feature.y_px - kColmapPixelShift_px);
    keypoint.size_px =
        stored->scale_px.empty() ? kUsualSize_px : kSizeOfScale * stored->scale_px[i];
    taken.features.keypoints.push_back(keypoint);
    const std::uint8_t* const from = stored->descriptors.data() + i * bytes;
    taken.features.descriptors.insert(taken.features.descriptors.end(), from, from + bytes);
  }
  return taken;
}

Result<ModelWithFeatures> TakeModel(const ColmapModel& model, ColmapDatabase* database,
                                    const StageProgress& progress) {
  ModelWithFeatures result;
  std::vector<std::vector<std::uint32_t>> index_of_feature(model.images.size());
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    progress("Reading features", static_cast<double>(i) / static_cast<double>(model.images.size()));
    Result<ReconstructedImage> image =
        TakeImage(model, model.images[i], database, &index_of_feature[i]);
    if (!image) return image.error();
    result.reconstruction.images.push_back(std::move(image).value());
  }
  for (const ColmapPoint& point : model.points) {
    FeatureTrack track;
    for (const ColmapSight& sight : point.sights) {
      const auto image =
          static_cast<std::size_t>(model.ImageById(sight.image_id) - model.images.data());
      if (model.images[image].features[sight.feature].point_id != point.id) {
        return Error{ErrorCode::kBadData,
                     "point " + std::to_string(point.id) + " says it is feature " +
                         std::to_string(sight.feature) + " of image " +
                         std::to_string(sight.image_id) + ", which says otherwise"};
      }
      track.push_back({static_cast<std::uint32_t>(image), index_of_feature[image][sight.feature]});
    }
    result.tracks.push_back(std::move(track));
    result.places.push_back(point.position);
  }
  return result;
}

// What the tables and photographs say of places on the earth.
struct Places {
  std::vector<SurveyedPoint> points;
  std::vector<ImageMark> marks;
  std::vector<CameraPlace> cameras;
  std::vector<CameraPlace> exif;

  bool any() const { return !points.empty() || !cameras.empty() || !exif.empty(); }
};

Result<Places> ReadPlaces(const ColmapMapInput& input, const ColmapModel& model) {
  Places places;
  PlaceOptions options = input.places;
  options.local = input.frame.local;
  if (!input.control_points.empty()) {
    Result<std::vector<SurveyedPoint>> points = ReadSurveyTable(input.control_points, options);
    if (!points) return points.error();
    places.points = std::move(points).value();
    Result<std::vector<ImageMark>> marks =
        ReadImageMarks(input.marks.empty() ? input.control_points : input.marks);
    if (!marks) return marks.error();
    places.marks = std::move(marks).value();
  }
  if (!input.camera_positions.empty()) {
    Result<std::vector<CameraPlace>> cameras = ReadCameraPlaces(input.camera_positions, options);
    if (!cameras) return cameras.error();
    places.cameras = std::move(cameras).value();
  }
  if (!input.image_gps.empty()) {
    std::vector<std::string> names;
    for (const ColmapImage& image : model.images) names.push_back(image.name);
    Result<std::vector<CameraPlace>> exif = ReadExifPlaces(input.image_gps, names, input.sigmas);
    if (!exif) return exif.error();
    places.exif = std::move(exif).value();
  }
  return places;
}

Result<MapFrame> ChooseFrame(const ColmapMapInput& input, const Places& places) {
  std::vector<TablePlace> all;
  for (const SurveyedPoint& point : places.points) all.push_back(point.place);
  for (const CameraPlace& camera : places.cameras) all.push_back(camera.place);
  for (const CameraPlace& camera : places.exif) all.push_back(camera.place);
  if (all.empty() && !input.frame.origin && !input.frame.local) {
    return Error{ErrorCode::kInvalidArgument,
                 "say where the model lies: --gcp, --image-gps or --camera-positions; --origin if "
                 "its frame is east-north-up in metres; --local if nowhere"};
  }
  return MapFrame::Choose(input.frame, all);
}

}  // namespace

Result<BuiltMap> ImportColmap(const ColmapMapInput& input, const StageProgress& progress) {
  const Result<ColmapModel> model =
      ReadColmapModel(input.model, [&](double share) { progress("Reading the model", share); });
  if (!model) return model.error();
  if (model->points.empty()) return Error{ErrorCode::kBadData, input.model + ": holds no points"};
  const Result<Places> places = ReadPlaces(input, *model);
  if (!places) return places.error();
  const Result<MapFrame> frame = ChooseFrame(input, *places);
  if (!frame) return frame.error();
  Result<std::unique_ptr<ColmapDatabase>> database = ColmapDatabase::Open(input.database);
  if (!database) return database.error();
  Result<ModelWithFeatures> taken = TakeModel(*model, database->get(), progress);
  if (!taken) return Error{taken.error().code, input.model + ": " + taken.error().message};
  Reconstruction& reconstruction = taken->reconstruction;
  AppraiseTracks(
      taken->tracks, taken->places, input.triangulation,
      [&](double share) { progress("Weighing points", share); }, &reconstruction);

  BuiltMap built;
  if (reconstruction.points.size() < model->points.size()) {
    built.notes.push_back(std::to_string(model->points.size() - reconstruction.points.size()) +
                          " of " + std::to_string(model->points.size()) +
                          " points are seen from too nearly one side and were left out");
  }
  Similarity3 enu_from_world;
  if (places->any()) {
    std::vector<PosedCamera> cameras;
    for (const ReconstructedImage& image : reconstruction.images) {
      cameras.push_back({image.name, &image.lens, &image.camera_from_world});
    }
    std::vector<TiePoint> ties =
        TiesOfMarks(places->points, places->marks, cameras, *frame, input.sigmas, &built.notes);
    for (const auto* const more : {&places->cameras, &places->exif}) {
      for (TiePoint& tie : TiesOfCameras(*more, cameras, *frame, input.sigmas.camera_m)) {
        ties.push_back(std::move(tie));
      }
    }
    Result<Georegistration> found = Georegister(ties, input.registration);
    if (!found) return Error{found.error().code, input.model + ": " + found.error().message};
    for (const TiePoint& tie : ties) built.tie_names.push_back(tie.name);
    enu_from_world = found->enu_from_model;
    built.registration = std::move(found).value();
  }
  built.noise_px = reconstruction.noise_px;
  built.info = InfoFor(*frame, input.labels, DescriptorKind::kRootSift);
  built.content = ContentFrom(reconstruction, enu_from_world);
  return built;
}

}  // namespace lodemark
