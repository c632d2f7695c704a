// What a prior rules out before a pose is worked out or scored.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/geo/rigid3.h"
#include "core/resection/sight_table.h"
#include "core/resection/sights.h"

namespace lodemark {

class SampleGate {
 public:
  SampleGate(const SightTable& table, const ResectionPriors& priors);

  // False if the sight's height above the horizon cannot be the landmark's: such sights need not be
  // drawn. Always true unless both priors are there.
  bool AdmitsSight(std::size_t row) const;

  // False if two bearings include an angle that the two landmarks cannot include.
  bool AdmitsPair(std::size_t a, std::size_t b) const;

  // False if the pose lies where the prior says that it does not, or leans.
  bool AdmitsPose(const Rigid3& camera_from_world) const;

 private:
  const SightTable& table_;
  const ResectionPriors& priors_;
  std::vector<Eigen::Vector3d> direction_;  // of each landmark from the prior's position
  std::vector<double> doubt_rad_;           // of that direction
  Eigen::Matrix3d information_pm2_ = Eigen::Matrix3d::Zero();
  double least_up_cosine_ = -1.0;
};

}  // namespace lodemark
