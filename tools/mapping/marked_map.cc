#include "tools/mapping/marked_map.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/resection/collinearity.h"
#include "core/resection/resection.h"
#include "tools/mapping/survey_table.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

// A look-up finds only what the detector finds, so a mark is described by the features at it, of
// every size and direction: those nearer than this, or than this share of their size.
constexpr float kNearMark_px = 1.5F;
constexpr float kNearMarkOfSize = 0.2F;
constexpr std::size_t kMostOfMark = 6;

constexpr std::size_t kLeastMarksForPose = 4;

// The features at a mark, nearest first.
std::vector<std::size_t> FeaturesAt(const ImageMark& mark, const std::vector<Keypoint>& keypoints) {
  std::vector<std::pair<float, std::size_t>> near;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const float off_px = std::hypot(keypoints[i].x_px - static_cast<float>(mark.x_px),
                                    keypoints[i].y_px - static_cast<float>(mark.y_px));
    if (off_px <= std::max(kNearMark_px, kNearMarkOfSize * keypoints[i].size_px)) {
      near.emplace_back(off_px, i);
    }
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), kMostOfMark));
  std::vector<std::size_t> indices;
  for (const auto& [off_px, index] : near) indices.push_back(index);
  return indices;
}

// How far the feature at that pixel lies from the landmark, across the line of sight and any way
// round. Nothing where the lens does not show the landmark.
std::optional<Eigen::Matrix3d> CovarianceOfOffset(const Keypoint& keypoint,
                                                  const Landmark& landmark,
                                                  const DatabaseImage& image, const Lens& lens) {
  const Rigid3 camera_from_enu(image.camera_from_enu,
                               -(image.camera_from_enu * image.position_in_enu_m));
  LandmarkSight sight;
  sight.pixel = {keypoint.x_px, keypoint.y_px};
  sight.landmark_in_enu_m = landmark.position_in_enu_m;
  LinearSight linear;
  if (!Linearise(sight, CameraPose(camera_from_enu), lens, &linear)) return std::nullopt;
  const Eigen::Matrix2d product = linear.by_landmark * linear.by_landmark.transpose();
  const Eigen::Matrix<double, 3, 2> by_pixel = linear.by_landmark.transpose() * product.inverse();
  const Eigen::Matrix3d covariance =
      0.5 * linear.residual_px.squaredNorm() * by_pixel * by_pixel.transpose();
  if (!covariance.allFinite()) return std::nullopt;
  return covariance;
}

class MarkedMap {
 public:
  MarkedMap(const MarkedMapInput& input, const MapFrame& frame,
            const std::vector<SurveyedPoint>& points)
      : input_(input), off_marks_(points.size()) {
    for (const SurveyedPoint& point : points) {
      Landmark landmark;
      landmark.id = static_cast<std::uint32_t>(ids_.size()) + 1;
      landmark.position_in_enu_m = frame.InEnu(point.place);
      landmark.covariance_m2 = CovarianceOf(point.place, input.default_sigma_m);
      ids_[point.name] = landmark.id;
      content_.landmarks.push_back(landmark);
    }
  }

  // Marks of points nobody surveyed are a fault of the tables.
  Status CheckMarks(const std::vector<ImageMark>& marks) const {
    for (const ImageMark& mark : marks) {
      if (ids_.contains(mark.point)) continue;
      return Error{ErrorCode::kBadData, input_.marks + ": point '" + mark.point + "' in " +
                                            mark.image + " is not in " + input_.survey};
    }
    return {};
  }

  Status AddImage(const std::string& name, const std::vector<ImageMark>& marks) {
    const std::string path = (fs::path(input_.images) / name).string();
    const Result<Photo> photo = ReadPhoto(path);
    if (!photo) return photo.error();
    const Result<Features> features =
        DetectFeatures({photo->pixels.data(), photo->width_px, photo->height_px, photo->width_px},
                       input_.detector);
    if (!features) return Error{features.error().code, path + ": " + features.error().message};

    DatabaseImage image;
    image.id = static_cast<std::uint32_t>(content_.images.size()) + 1;
    image.name = name;
    const Status posed = FindPose(path, *photo, marks, &image);
    if (!posed.ok()) return posed;
    content_.images.push_back(image);

    const std::size_t bytes = DescriptorBytes(features->kind);
    for (const ImageMark& mark : marks) {
      if (!(mark.x_px >= -0.5 && mark.x_px <= photo->width_px - 0.5 && mark.y_px >= -0.5 &&
            mark.y_px <= photo->height_px - 0.5)) {
        return Error{ErrorCode::kBadData, input_.marks + ": point '" + mark.point + "' in " + name +
                                              " is marked outside the image"};
      }
      const std::vector<std::size_t> indices = FeaturesAt(mark, features->keypoints);
      if (indices.empty()) ++marks_without_feature_;
      for (const std::size_t index : indices) {
        DescriptorOrigin origin;
        origin.landmark_id = ids_.at(mark.point);
        NoteOffset(features->keypoints[index], origin.landmark_id, image);
        origin.image_id = image.id;
        content_.origins.push_back(origin);
        content_.places_in_image.emplace_back(
            (features->keypoints[index].x_px + 0.5F) / static_cast<float>(photo->width_px),
            (features->keypoints[index].y_px + 0.5F) / static_cast<float>(photo->height_px));
        const std::uint8_t* const from = features->descriptors.data() + index * bytes;
        content_.descriptors.insert(content_.descriptors.end(), from, from + bytes);
      }
    }
    return {};
  }

  // Landmarks that look like nothing fall away.
  MapContent Finish(std::vector<std::string>* notes) {
    std::set<std::uint32_t> described;
    for (const DescriptorOrigin& origin : content_.origins) described.insert(origin.landmark_id);
    const std::size_t all = content_.landmarks.size();
    for (Landmark& landmark : content_.landmarks) {
      const OffMark& off = off_marks_[landmark.id - 1];
      if (off.features > 0.0) landmark.covariance_m2 += off.sum_m2 / off.features;
    }
    std::erase_if(content_.landmarks,
                  [&](const Landmark& landmark) { return !described.contains(landmark.id); });
    if (marks_without_feature_ > 0) {
      notes->push_back(std::to_string(marks_without_feature_) +
                       " marks lie where the photograph shows nothing distinct and add nothing");
    }
    if (content_.landmarks.size() < all) {
      notes->push_back(std::to_string(all - content_.landmarks.size()) + " of " +
                       std::to_string(all) + " surveyed points have no mark that shows a feature");
    }
    NoteViewingDirections(&content_);
    return std::move(content_);
  }

 private:
  // Of a landmark's features, as far as the photographs' poses are known.
  struct OffMark {
    Eigen::Matrix3d sum_m2 = Eigen::Matrix3d::Zero();
    double features = 0.0;
  };

  // A look-up finds the feature, not the mark: what lies between them is an error of the landmark,
  // much the same in every photograph.
  void NoteOffset(const Keypoint& keypoint, std::uint32_t landmark_id, const DatabaseImage& image) {
    if (!image.pose_known) return;
    const std::optional<Eigen::Matrix3d> covariance =
        CovarianceOfOffset(keypoint, content_.landmarks[landmark_id - 1], image, *lens_);
    if (!covariance) return;
    OffMark& off = off_marks_[landmark_id - 1];
    off.sum_m2 += *covariance;
    off.features += 1.0;
  }

  // Leaves the image without a pose if its marks do not tell one.
  Status FindPose(const std::string& path, const Photo& photo, const std::vector<ImageMark>& marks,
                  DatabaseImage* image) {
    if (!input_.lens || marks.size() < kLeastMarksForPose) return {};
    if (photo.width_px != input_.lens->width_px || photo.height_px != input_.lens->height_px) {
      return Error{ErrorCode::kBadData, path + ": is " + std::to_string(photo.width_px) + " x " +
                                            std::to_string(photo.height_px) +
                                            " pixels, its camera takes " +
                                            std::to_string(input_.lens->width_px) + " x " +
                                            std::to_string(input_.lens->height_px)};
    }
    if (!lens_) {
      const Result<Lens> lens = Lens::Create(*input_.lens);
      if (!lens) return lens.error();
      lens_ = *lens;
    }
    std::vector<LandmarkSight> sights;
    for (const ImageMark& mark : marks) {
      const Landmark& landmark = content_.landmarks[ids_.at(mark.point) - 1];
      LandmarkSight sight;
      sight.pixel = {mark.x_px, mark.y_px};
      sight.pixel_sigma_px = mark.sigma_px > 0.0 ? mark.sigma_px : input_.mark_sigma_px;
      sight.landmark_in_enu_m = landmark.position_in_enu_m;
      sight.landmark_covariance_m2 = landmark.covariance_m2;
      sights.push_back(sight);
    }
    const Result<ResectedPose> pose = Resect(sights, *lens_, {}, {});
    if (!pose) return pose.error();
    image->pose_known = pose->verdict == PoseVerdict::kPose || pose->verdict == PoseVerdict::kWeak;
    if (!image->pose_known) return {};
    image->position_in_enu_m = pose->centre_in_enu_m();
    image->camera_from_enu = pose->camera_from_enu.rotation();
    return {};
  }

  const MarkedMapInput& input_;
  std::map<std::string, std::uint32_t> ids_;  // by name; landmarks are in the order of ids
  MapContent content_;
  std::vector<OffMark> off_marks_;  // in the order of the landmarks
  std::optional<Lens> lens_;        // where a pose was looked for
  std::size_t marks_without_feature_ = 0;
};

}  // namespace

Result<BuiltMap> BuildMarkedMap(const MarkedMapInput& input, const StageProgress& progress) {
  PlaceOptions options = input.places;
  options.local = input.frame.local;
  const Result<std::vector<SurveyedPoint>> points = ReadSurveyTable(input.survey, options);
  if (!points) return points.error();
  const Result<std::vector<ImageMark>> marks = ReadImageMarks(input.marks);
  if (!marks) return marks.error();
  std::vector<TablePlace> places;
  for (const SurveyedPoint& point : *points) places.push_back(point.place);
  const Result<MapFrame> frame = MapFrame::Choose(input.frame, places);
  if (!frame) return frame.error();

  MarkedMap map(input, *frame, *points);
  const Status known = map.CheckMarks(*marks);
  if (!known.ok()) return known.error();
  std::map<std::string, std::vector<ImageMark>> by_image;
  for (const ImageMark& mark : *marks) by_image[mark.image].push_back(mark);
  std::size_t done = 0;
  for (const auto& [name, of_image] : by_image) {
    progress("Finding features",
             static_cast<double>(done++) / static_cast<double>(by_image.size()));
    const Status added = map.AddImage(name, of_image);
    if (!added.ok()) return added.error();
  }
  progress("Finding features", 1.0);
  BuiltMap built;
  built.info = InfoFor(*frame, input.labels, input.detector.kind);
  built.content = map.Finish(&built.notes);
  if (built.content.landmarks.empty()) {
    return Error{ErrorCode::kBadData,
                 input.marks + ": no mark lies at anything distinct: mark corners and patterns"};
  }
  return built;
}

}  // namespace lodemark
