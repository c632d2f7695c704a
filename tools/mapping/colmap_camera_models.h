// Names, numbers and parameter counts of COLMAP's camera models, and limits on what is believed.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lodemark {

struct ColmapCameraModel {
  std::int32_t number = 0;
  std::string_view name;
  std::size_t parameters = 0;
};

// COLMAP, sensor/models.h.
inline constexpr ColmapCameraModel kColmapCameraModels[] = {
    {0, "SIMPLE_PINHOLE", 3},
    {1, "PINHOLE", 4},
    {2, "SIMPLE_RADIAL", 4},
    {3, "RADIAL", 5},
    {4, "OPENCV", 8},
    {5, "OPENCV_FISHEYE", 8},
    {6, "FULL_OPENCV", 12},
    {7, "FOV", 5},
    {8, "SIMPLE_RADIAL_FISHEYE", 4},
    {9, "RADIAL_FISHEYE", 5},
    {10, "THIN_PRISM_FISHEYE", 12},
    {11, "RAD_TAN_THIN_PRISM_FISHEYE", 16},
};

// Null if COLMAP has no such model, or only later versions have it.
inline const ColmapCameraModel* ColmapCameraModelByNumber(std::int32_t number) {
  for (const ColmapCameraModel& model : kColmapCameraModels) {
    if (model.number == number) return &model;
  }
  return nullptr;
}

inline const ColmapCameraModel* ColmapCameraModelByName(std::string_view name) {
  for (const ColmapCameraModel& model : kColmapCameraModels) {
    if (model.name == name) return &model;
  }
  return nullptr;
}

inline constexpr double kLargestColmapCoordinate = 1e9;
inline constexpr std::size_t kLongestColmapName = 4096;

// Finite and of a size some reconstruction has.
inline bool IsSoundColmapNumber(double value) {
  return std::abs(value) <= kLargestColmapCoordinate;
}

inline bool IsSoundColmapPlace(const Eigen::Vector3d& place) {
  return IsSoundColmapNumber(place.x()) && IsSoundColmapNumber(place.y()) &&
         IsSoundColmapNumber(place.z());
}

}  // namespace lodemark
