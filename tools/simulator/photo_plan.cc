#include "tools/simulator/photo_plan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/simulator/receiver_path.h"

namespace lodemark {
namespace {

std::uint64_t HashOf(std::uint64_t seed, const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL ^ (seed * 0x9e3779b97f4a7c15ULL);
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

}  // namespace

Rigid3 CameraFromEnu(const Eigen::Vector3d& at_m, const CameraHold& hold) {
  const Eigen::Vector3d forward(std::sin(hold.heading_rad) * std::cos(hold.tilt_rad),
                                std::cos(hold.heading_rad) * std::cos(hold.tilt_rad),
                                std::sin(hold.tilt_rad));
  const Eigen::Vector3d level_right(std::cos(hold.heading_rad), -std::sin(hold.heading_rad), 0.0);
  const Eigen::Vector3d level_down = forward.cross(level_right);
  Eigen::Matrix3d rotation;
  rotation.row(0) = std::cos(hold.roll_rad) * level_right + std::sin(hold.roll_rad) * level_down;
  rotation.row(1) = std::cos(hold.roll_rad) * level_down - std::sin(hold.roll_rad) * level_right;
  rotation.row(2) = forward;
  const Eigen::Quaterniond camera_from_enu(rotation);
  return {camera_from_enu, -(camera_from_enu.normalized() * at_m)};
}

std::vector<PlannedPhoto> PlanPhotos(const Scenario& scenario, const PhotoGroup& group) {
  std::vector<PlannedPhoto> photos;
  for (const Standpoint& standpoint : group.standpoints) {
    for (const CameraHold& hold : standpoint.holds) {
      PlannedPhoto photo;
      photo.hold = hold;
      photo.camera_from_enu = CameraFromEnu(standpoint.at_m, hold);
      photos.push_back(std::move(photo));
    }
  }
  const std::size_t timeless = photos.size();
  const ReceiverPath path(scenario);
  for (const FrameSeries& series : group.frames) {
    double time_s = series.first_s;
    for (CameraHold hold : series.holds) {
      const ReceiverState state = path.At(time_s);
      if (series.ahead) hold.heading_rad += state.heading_rad;
      PlannedPhoto photo;
      photo.hold = hold;
      photo.camera_from_enu = CameraFromEnu(state.position_in_enu, hold);
      photo.time_gps_ns = scenario.start_gps_ns + std::llround(time_s * 1e9);
      photos.push_back(std::move(photo));
      time_s += series.every_s;
    }
  }
  std::stable_sort(
      photos.begin() + static_cast<std::ptrdiff_t>(timeless), photos.end(),
      [](const PlannedPhoto& a, const PlannedPhoto& b) { return *a.time_gps_ns < *b.time_gps_ns; });
  for (std::size_t i = 0; i < photos.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "%04zu.jpg", i + 1);
    photos[i].name = name;
    photos[i].seed = HashOf(scenario.seed, group.folder + "/" + name);
  }
  return photos;
}

}  // namespace lodemark
