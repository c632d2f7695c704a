// The test field of Xu et al. (section 5.1) as numbers: places to stand on a square, landmarks on
// the walls around it and on its ground, a sky of ten GPS satellites, and errors drawn for all of
// them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/base/random.h"
#include "core/camera/lens.h"
#include "core/fusion/observation.h"
#include "core/geo/geodetic.h"
#include "core/resection/sights.h"

namespace lodemark {

// Noise at which satellites alone and photographs alone err as the paper's did (its Table 1).
struct SquareNoise {
  double elevation_a_m = 2.0;  // of equation 8: of each range alone
  double elevation_b_m = 1.0;
  double zenith_delay_sigma_m = 4.0;  // what atmospheric models leave, common to all ranges
  double pixel_sigma_px = 1.0;        // of where a landmark is seen
  double landmark_sigma_m = 0.05;
  double gravity_sigma_rad = 0.005;  // of the accelerometer at rest
};

struct SquareDraw {
  SquareNoise noise;
  EnuFrame frame{Geodetic{}};
  Eigen::Vector3d truth_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Vector3d truth_in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond camera_from_enu = Eigen::Quaterniond::Identity();
  GravityPrior gravity;
  std::vector<RangeObservation> satellites;  // ten
  std::vector<LandmarkSight> sights;         // sigma 1: pixel_sigma_px
};

// The lens of the paper's phone at its working resolution: 1280 x 960, 1000 px of focal length.
Lens SquareLens();

// One photograph and one epoch from standpoint number draw % 4, deterministic by seed and draw.
SquareDraw DrawSquare(const SquareNoise& noise, int landmarks, std::uint64_t seed, int draw);

// Those of the satellites to be used: the first count of an order that spreads them over the sky.
std::vector<RangeObservation> Visible(const SquareDraw& draw, int count);

}  // namespace lodemark
