// Landmarks simulated along a path that was truly driven, and photographs of them: everything here
// is drawn, by seed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera/lens.h"
#include "core/geo/geodetic.h"
#include "core/session/photo_sighting.h"

namespace lodemark {

struct StreetNoise {
  double pixel_sigma_px = 1.5;
  double landmark_sigma_m = 0.3;  // an axis
  double mismatched = 0.1;        // share of the sights that are of something else
  double gravity_sigma_rad = 0.02;
  double heading_sigma_rad = 0.15;
};

struct Street {
  StreetNoise noise;
  double spacing_m = 4.0;    // of landmarks along the path, either side
  double farthest_m = 60.0;  // that one is recognised from
  double found = 0.6;        // share of those in view
  int most_sights = 40;
};

// One place of the path.
struct PathPoint {
  Eigen::Vector3d in_enu_m = Eigen::Vector3d::Zero();
  double heading_rad = 0.0;  // of the way on, clockwise from north
};

// A photograph with the truth that it was drawn from.
struct DrawnPhoto {
  PhotoSighting sighting;
  Eigen::Matrix3d bound_enu_m2;     // Cramer-Rao bound of the camera's place; infinite: fixes none
  Eigen::Matrix3d information_pm2;  // Fisher's of the place, where the photograph fixes none too
};

class DriveLandmarks {
 public:
  // path: in the frame, in the order of time; it may stand still.
  DriveLandmarks(const EnuFrame& frame, const std::vector<PathPoint>& path, const Street& street,
                 std::uint64_t seed);

  // What a camera at the place, looking along the heading, sees. Nothing where resection refuses
  // the input.
  std::optional<DrawnPhoto> Photograph(std::int64_t time_ns, const PathPoint& place) const;

  std::size_t count() const { return landmarks_.size(); }

 private:
  EnuFrame frame_;
  Street street_;
  std::uint64_t seed_;
  Lens lens_;
  std::vector<Eigen::Vector3d> landmarks_;  // where they truly are
  std::vector<Eigen::Vector3d> mapped_;     // where the map says
};

}  // namespace lodemark
