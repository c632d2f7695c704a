// Where a reconstruction lies on the earth, from places known in both: ground control points and
// the positions that cameras noted.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "tools/mapping/similarity3.h"

namespace lodemark {

// A place known in the model and in the map's frame.
struct TiePoint {
  std::string name;
  Eigen::Vector3d in_model = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_in_model = Eigen::Matrix3d::Zero();  // the model's units, squared
  Eigen::Vector3d in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Identity();  // positive definite
};

struct GeoregistrationOptions {
  // A tie point further away than this many of its own sigmas is mistaken.
  double mistaken_sigmas = 4.0;
  // Beyond these the tie points are said not to determine where the model lies.
  double largest_turn_sigma_rad = 0.1;
  double largest_scale_sigma = 0.1;
  std::uint64_t seed = 1;
};

struct TieResidual {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();  // given minus transformed
  double sigmas = 0.0;                              // its Mahalanobis length
  bool used = false;
};

struct Georegistration {
  Similarity3 enu_from_model;
  // Of a shift (m2), then a small turn (rad2), each east, north, up, then the logarithm of the
  // scale, all about the centre: for the sigmas given, larger if the residuals are.
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Vector3d centre_in_enu_m = Eigen::Vector3d::Zero();  // of the tie points used
  // Root mean square of the residuals of the points used, in units of their sigmas, freed from the
  // seven parameters. Near 1 if the sigmas are right.
  double unit_sigma = 1.0;
  std::vector<TieResidual> residuals;  // one for each tie point
  int used = 0;

  // What the registration's uncertainty makes of a place in the map's frame.
  Eigen::Matrix3d CovarianceAt(const Eigen::Vector3d& place_in_enu_m) const;
};

// Robust: three tie points at a time propose, the others vote in units of their sigmas; the winner
// is refined with a Cauchy kernel and at last by least squares on the points that agree. An error
// says what is wrong: fewer than three points, no three that agree, all near one line.
Result<Georegistration> Georegister(std::span<const TiePoint> ties,
                                    const GeoregistrationOptions& options);

}  // namespace lodemark
