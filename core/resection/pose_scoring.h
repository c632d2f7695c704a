// How well a pose agrees with the sights: the truncated squares of MSAC, given up on early where a
// sequential test says that nothing will come of it.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/geo/rigid3.h"
#include "core/resection/sight_table.h"
#include "core/resection/sights.h"

namespace lodemark {

// Wald's sequential probability ratio test: after each block of sights, is this pose one of those
// that a share of good_share of the sights agrees with, or of bad_share?
class SequentialTest {
 public:
  // Good poses are given up once in a hundred times.
  static constexpr double kFalseAlarms = 0.01;

  // A test that never gives up.
  SequentialTest() = default;
  SequentialTest(double good_share, double bad_share);

  // True if the pose is to be given up after seen sights of which agreeing agree.
  bool GivesUp(std::size_t seen, std::size_t agreeing) const {
    return static_cast<double>(seen) * per_sight_ - static_cast<double>(agreeing) * per_agreeing_ >
           limit_;
  }

 private:
  double per_sight_ = 0.0;
  double per_agreeing_ = 0.0;
  double limit_ = 1.0;
};

struct PoseScore {
  double cost = 0.0;         // sum of squared misfits, each at most the squared threshold
  std::size_t agreeing = 0;  // sights within the threshold
  std::size_t seen = 0;      // of the table's
  bool is_complete = false;  // not given up
};

// most_cost: beyond it the pose is given up too.
PoseScore ScorePose(const SightTable& table, const Rigid3& camera_from_world, double threshold,
                    const SequentialTest& test, double most_cost);

// Gauss-Newton steps on the tangent misfits of at most most_sights that lie within a threshold,
// which goes from the wide one to the narrow one. The priors count as observations, noise as a
// third of the threshold.
Rigid3 ImprovePose(const SightTable& table, const Rigid3& start_camera_from_world,
                   double wide_threshold, double threshold, const ResectionPriors& priors,
                   std::size_t most_sights);

}  // namespace lodemark
