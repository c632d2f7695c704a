// The estimates of a session again, each with what came after it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/session/epoch_filter.h"
#include "core/session/numbered_list.h"
#include "core/session/session.h"

namespace lodemark {

class SmoothedWay {
 public:
  // The estimate of a moment as it is given; filter: as it is then. Gives its number.
  std::size_t Note(const SessionEstimate& estimate, const EpochFilter& filter);
  // What it would be after what came late.
  void NoteAgain(std::size_t number, const SessionEstimate& estimate, const EpochFilter& filter);

  // One for each moment noted, in that order. Made once, until the next is noted.
  const std::vector<SessionEstimate>& Estimates(const EpochFilter& filter);

  void Forget() {
    moments_.Clear();
    estimates_.reset();
  }

 private:
  struct Moment {
    SessionEstimate estimate;
    bool carried = false;  // the filter had a state
    std::size_t step = 0;  // which it was, and of what time
    std::int64_t step_ns = 0;
    // Where the estimate was, seen from the state, and what its covariance had beside the state's.
    Eigen::Vector3d ahead_in_ecef_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d beside_enu_m2 = Eigen::Matrix3d::Zero();
  };
  static Moment MomentOf(const SessionEstimate& estimate, const EpochFilter& filter);

  NumberedList<Moment> moments_;
  std::optional<std::vector<SessionEstimate>> estimates_;
};

}  // namespace lodemark
