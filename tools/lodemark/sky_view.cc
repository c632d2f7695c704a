#include "tools/lodemark/sky_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/units.h"
#include "core/sightline/ground.h"
#include "core/sightline/skyline.h"

namespace lodemark {
namespace {

// From nearer than this the roofs look the same.
constexpr double kSamePlace_m = 0.5;

double DistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double share = std::clamp(way.dot(point - from) / way.squaredNorm(), 0.0, 1.0);
  return (point - from - share * way).norm();
}

double HorizontalDistance(const BuildingScene& scene, const Eigen::Vector2d& place_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t part = 0; part < scene.part_count(); ++part) {
    const std::span<const Eigen::Vector2d> corners = scene.footprint(part);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d& next = corners[(i + 1) % corners.size()];
      nearest_m = std::min(nearest_m, DistanceToSegment(place_m, corners[i], next));
    }
  }
  return nearest_m;
}

}  // namespace

SkyView::SkyView(const BuildingScene* scene, const EnuFrame& map_frame)
    : scene_(scene),
      map_frame_(map_frame),
      viewpoint_(scene),
      nearest_m_(std::numeric_limits<double>::infinity()) {}

SkyMoment SkyView::Look(const SkyPlace& place, std::span<const SkySatellite> satellites) {
  const Eigen::Vector3d place_m = NotBelowGround(*scene_, map_frame_.FromEcef(place.in_ecef));
  const Eigen::Matrix3d map_from_local =
      map_frame_.enu_from_ecef() * EnuFromEcefRotation(GeodeticFromEcef(place.in_ecef)).transpose();
  const auto map_azimuth = [&](double azimuth_rad) {
    const Eigen::Vector3d level = map_from_local * DirectionFromAngles(azimuth_rad, 0.0);
    return std::atan2(level.x(), level.y());
  };
  viewpoint_.Stand(place_m, map_from_local * place.covariance_enu_m2 * map_from_local.transpose());
  SkyMoment moment;
  moment.time_gps_ns = place.time_gps_ns;
  moment.inside_building = scene_->IsInside(place_m);
  moment.satellites.assign(satellites.begin(), satellites.end());
  for (SkySatellite& satellite : moment.satellites) {
    const Eigen::Vector3d direction =
        map_from_local * DirectionFromAngles(satellite.azimuth_rad, satellite.elevation_rad);
    satellite.probability = viewpoint_.Towards(direction, satellite.wavelength_m).probability;
    satellite.skyline_rad = SkylineElevation(*scene_, place_m, map_azimuth(satellite.azimuth_rad));
  }
  if (moment.inside_building) {
    nearest_m_ = 0.0;
  } else if (!has_skyline_ || (place_m - skyline_place_m_).norm() > kSamePlace_m) {
    NoteSkyline(place_m, map_azimuth(0.0));
  }
  return moment;
}

void SkyView::NoteSkyline(const Eigen::Vector3d& place_in_enu_m, double map_azimuth_of_north_rad) {
  for (std::size_t degree = 0; degree < last_.size(); ++degree) {
    last_[degree] = SkylineElevation(
        *scene_, place_in_enu_m,
        map_azimuth_of_north_rad + kRadiansPerDegree * static_cast<double>(degree));
    lowest_[degree] = has_skyline_ ? std::min(lowest_[degree], last_[degree]) : last_[degree];
    highest_[degree] = std::max(highest_[degree], last_[degree]);
  }
  nearest_m_ = std::min(nearest_m_, HorizontalDistance(*scene_, place_in_enu_m.head<2>()));
  skyline_place_m_ = place_in_enu_m;
  has_skyline_ = true;
}

}  // namespace lodemark
