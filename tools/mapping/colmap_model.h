// A sparse reconstruction as COLMAP writes it: cameras, images with poses, points with their
// sights.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/geo/rigid3.h"

namespace lodemark {

struct ColmapCamera {
  std::uint32_t id = 0;
  std::string model;  // "PINHOLE", "OPENCV" ...
  std::uint64_t width_px = 0;
  std::uint64_t height_px = 0;
  std::vector<double> parameters;  // as many as the model has
};

struct ColmapFeature {
  static constexpr std::uint64_t kNoPoint = std::numeric_limits<std::uint64_t>::max();

  double x_px = 0.0;  // the centre of the upper left pixel is (0.5, 0.5)
  double y_px = 0.0;
  std::uint64_t point_id = kNoPoint;
};

struct ColmapImage {
  std::uint32_t id = 0;
  std::uint32_t camera_id = 0;
  std::string name;
  Rigid3 camera_from_world;
  std::vector<ColmapFeature> features;
};

struct ColmapSight {
  std::uint32_t image_id = 0;
  std::uint32_t feature = 0;  // index into the image's
};

struct ColmapPoint {
  std::uint64_t id = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double error_px = 0.0;  // mean over the sights; negative: not known
  std::vector<ColmapSight> sights;
};

// Each in ascending order of id, no id twice.
struct ColmapModel {
  std::vector<ColmapCamera> cameras;
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint> points;

  // Null if there is none.
  const ColmapCamera* CameraById(std::uint32_t id) const;
  const ColmapImage* ImageById(std::uint32_t id) const;
};

// The three files of a folder, .bin where there is one, else .txt; without them the folder "0" or
// "sparse/0" inside. What is read holds together: every camera, image, feature and point that is
// referred to exists. Errors name the file and the line or byte.
Result<ColmapModel> ReadColmapModel(const std::string& folder,
                                    const std::function<void(double share)>& progress);

// The parts of it, from bytes of any origin. name stands for the path in messages.
Result<std::vector<ColmapCamera>> ParseColmapCamerasText(const std::string& name,
                                                         std::string_view text);
Result<std::vector<ColmapCamera>> ParseColmapCamerasBinary(const std::string& name,
                                                           std::string_view bytes);
Result<std::vector<ColmapImage>> ParseColmapImagesText(const std::string& name,
                                                       std::string_view text);
Result<std::vector<ColmapImage>> ParseColmapImagesBinary(const std::string& name,
                                                         std::string_view bytes);
Result<std::vector<ColmapPoint>> ParseColmapPointsText(const std::string& name,
                                                       std::string_view text);
Result<std::vector<ColmapPoint>> ParseColmapPointsBinary(const std::string& name,
                                                         std::string_view bytes);

// Sorts by id and checks what ReadColmapModel promises.
Result<ColmapModel> JoinColmapModel(std::vector<ColmapCamera> cameras,
                                    std::vector<ColmapImage> images,
                                    std::vector<ColmapPoint> points);

}  // namespace lodemark
