#include "tools/mapping/ties.h"

#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "core/base/units.h"
#include "tools/mapping/exif.h"
#include "tools/mapping/triangulation.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

// A photograph without altitude still says where it is on the ground.
constexpr double kUnknownHeightSigma_m = 1000.0;
constexpr double kLeastMarkParallax_rad = 0.01;
// Marks are made by people: points that do not fit within this many sigmas are mismarked.
constexpr double kLargestMarkResidual = 10.0;

CameraPlace PlaceOf(const std::string& name, const ExifPosition& position,
                    const TieSigmas& sigmas) {
  CameraPlace place;
  place.name = name;
  place.place.point_m = EcefFromGeodetic({position.latitude_deg * kRadiansPerDegree,
                                          position.longitude_deg * kRadiansPerDegree,
                                          position.altitude_m.value_or(0.0)});
  // A radius that holds 68 % is 1.5 sigmas of each axis.
  const double level_m =
      position.horizontal_error_m ? *position.horizontal_error_m / 1.5 : sigmas.gps_horizontal_m;
  place.place.sigma_enu_m = {level_m, level_m,
                             position.altitude_m ? sigmas.gps_vertical_m : kUnknownHeightSigma_m};
  return place;
}

}  // namespace

Result<std::vector<CameraPlace>> ReadExifPlaces(const std::string& folder,
                                                const std::vector<std::string>& names,
                                                const TieSigmas& sigmas) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure)) {
    return Error{ErrorCode::kIo, folder + ": is no folder of photographs"};
  }
  std::vector<CameraPlace> places;
  for (const std::string& name : names) {
    const std::string path = (fs::path(folder) / name).string();
    if (!fs::is_regular_file(path, failure)) continue;
    const Result<Exif> exif = ReadExif(path);
    if (!exif) return exif.error();
    if (exif->position) places.push_back(PlaceOf(name, *exif->position, sigmas));
  }
  if (!places.empty()) return places;
  return Error{ErrorCode::kBadData,
               folder + ": none of the model's photographs there says in EXIF where it was taken"};
}

std::vector<TiePoint> TiesOfCameras(const std::vector<CameraPlace>& places,
                                    const std::vector<PosedCamera>& cameras, const MapFrame& frame,
                                    double default_sigma_m) {
  std::map<std::string, const CameraPlace*> by_name;
  for (const CameraPlace& place : places) by_name[place.name] = &place;
  std::vector<TiePoint> ties;
  for (const PosedCamera& camera : cameras) {
    const auto place = by_name.find(camera.name);
    if (place == by_name.end()) continue;
    TiePoint tie;
    tie.name = camera.name;
    tie.in_model = camera.camera_from_world->Inverse().translation();
    tie.in_enu_m = frame.InEnu(place->second->place);
    tie.covariance_m2 = CovarianceOf(place->second->place, default_sigma_m);
    ties.push_back(std::move(tie));
  }
  return ties;
}

std::vector<TiePoint> TiesOfMarks(const std::vector<SurveyedPoint>& points,
                                  const std::vector<ImageMark>& marks,
                                  const std::vector<PosedCamera>& cameras, const MapFrame& frame,
                                  const TieSigmas& sigmas, std::vector<std::string>* notes) {
  std::map<std::string, const PosedCamera*> by_name;
  for (const PosedCamera& camera : cameras) by_name[camera.name] = &camera;
  std::map<std::string, std::vector<PointView>> views_of;
  for (const ImageMark& mark : marks) {
    const auto camera = by_name.find(mark.image);
    if (camera == by_name.end()) continue;
    const Eigen::Vector2d pixel(mark.x_px, mark.y_px);
    const std::optional<Eigen::Vector3d> bearing = camera->second->lens->Unproject(pixel);
    if (!bearing) continue;
    views_of[mark.point].push_back({camera->second->lens, camera->second->camera_from_world, pixel,
                                    *bearing,
                                    mark.sigma_px > 0.0 ? mark.sigma_px : sigmas.mark_px});
  }
  TriangulationOptions options;
  options.largest_residual_px = kLargestMarkResidual;
  options.least_parallax_rad = kLeastMarkParallax_rad;
  std::vector<TiePoint> ties;
  for (const SurveyedPoint& point : points) {
    const std::vector<PointView>& views = views_of[point.name];
    const std::optional<TriangulatedPoint> found = Triangulate(views, options);
    if (!found) {
      notes->push_back("point '" + point.name + "' is marked in " + std::to_string(views.size()) +
                       " images of the model, which do not say where it is; passed over");
      continue;
    }
    TiePoint tie;
    tie.name = point.name;
    tie.in_model = found->in_world;
    tie.covariance_in_model = found->unit_covariance;
    tie.in_enu_m = frame.InEnu(point.place);
    tie.covariance_m2 = CovarianceOf(point.place, sigmas.survey_m);
    ties.push_back(std::move(tie));
  }
  return ties;
}

}  // namespace lodemark
