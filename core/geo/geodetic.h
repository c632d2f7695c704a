// Positions on the WGS 84 ellipsoid: geodetic, earth-centred earth-fixed, local east-north-up.
#pragma once

#include <Eigen/Core>

namespace lodemark {

struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;  // above the ellipsoid
};

// Earth-centred earth-fixed coordinates in metres.
Eigen::Vector3d EcefFromGeodetic(const Geodetic& geodetic);
Geodetic GeodeticFromEcef(const Eigen::Vector3d& point_in_ecef);

// Rotation that turns an ECEF difference into east, north, up at the given place.
Eigen::Matrix3d EnuFromEcefRotation(const Geodetic& place);

// A local frame: origin on the ellipsoid's scale, axes east, north, up at the origin.
class EnuFrame {
 public:
  explicit EnuFrame(const Geodetic& origin);

  Eigen::Vector3d FromEcef(const Eigen::Vector3d& point_in_ecef) const;
  Eigen::Vector3d ToEcef(const Eigen::Vector3d& point_in_enu) const;
  const Eigen::Matrix3d& enu_from_ecef() const { return enu_from_ecef_; }
  const Geodetic& origin() const { return origin_; }
  const Eigen::Vector3d& origin_in_ecef() const { return origin_in_ecef_; }

 private:
  Geodetic origin_;
  Eigen::Vector3d origin_in_ecef_;
  Eigen::Matrix3d enu_from_ecef_;
};

// Direction to a target, from a place on or near the ground.
struct LookAngles {
  double azimuth_rad = 0.0;  // clockwise from north, 0 .. 2 pi
  double elevation_rad = 0.0;
};

LookAngles LookAnglesTo(const Eigen::Vector3d& target_in_ecef, const Eigen::Vector3d& place_in_ecef,
                        const Eigen::Matrix3d& enu_from_ecef);

}  // namespace lodemark
