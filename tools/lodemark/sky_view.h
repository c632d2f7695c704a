// The sky over a receiver among buildings: how likely each satellite is in plain sight, and where
// the roofs end.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geo/geodetic.h"
#include "core/gnss/signal.h"
#include "core/sightline/building_scene.h"
#include "core/sightline/sight_chance.h"

namespace lodemark {

// Where a receiver is believed to be at one time.
struct SkyPlace {
  std::int64_t time_gps_ns = 0;
  Eigen::Vector3d in_ecef = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
};

struct SkySatellite {
  SatelliteId satellite;
  double azimuth_rad = 0.0;  // clockwise from north
  double elevation_rad = 0.0;
  double wavelength_m = 0.0;
  double probability = 1.0;  // that the line of sight is free
  double skyline_rad = 0.0;  // elevation of the roofs at its azimuth
};

struct SkyMoment {
  std::int64_t time_gps_ns = 0;
  bool inside_building = false;  // the place as believed: the truth is probably beside it
  std::vector<SkySatellite> satellites;
};

// Elevation of the roofs all around, at azimuths 0, 1, ... 359 degrees.
using Skyline = std::array<double, 360>;

// Looks from place after place of one receiver.
class SkyView {
 public:
  // The scene in the frame of its map; it must outlive the object.
  SkyView(const BuildingScene* scene, const EnuFrame& map_frame);

  // Fills the probability and the skyline of each satellite.
  SkyMoment Look(const SkyPlace& place, std::span<const SkySatellite> satellites);

  // Over all places but those inside a building; all zero if there is none.
  const Skyline& lowest_skyline() const { return lowest_; }
  const Skyline& highest_skyline() const { return highest_; }
  // From the last of these.
  const Skyline& last_skyline() const { return last_; }

  // Of the place looked from that was nearest to a building; 0 within one, infinite before the
  // first look.
  double nearest_building_m() const { return nearest_m_; }

 private:
  void NoteSkyline(const Eigen::Vector3d& place_in_enu_m, double map_azimuth_of_north_rad);

  const BuildingScene* scene_;
  EnuFrame map_frame_;
  UncertainViewpoint viewpoint_;
  Eigen::Vector3d skyline_place_m_ = Eigen::Vector3d::Zero();
  bool has_skyline_ = false;
  Skyline lowest_ = {};
  Skyline highest_ = {};
  Skyline last_ = {};
  double nearest_m_;
};

}  // namespace lodemark
