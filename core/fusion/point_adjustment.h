// The position of one epoch from ranges to known points, with a clock per group.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"
#include "core/fusion/point_problem.h"
#include "core/fusion/position_witness.h"
#include "core/fusion/posterior_sampling.h"

namespace lodemark {

enum class PointStatus : std::uint8_t {
  kGood,
  kTooFew,        // fewer observations and statements than unknowns
  kNotConverged,  // the geometry does not fix the position
  kInconsistent,  // no subset large enough agrees
};

struct PointOptions {
  int largest_iterations = 20;
  // Posterior mean over the whole error model instead of its mode wherever some ranges disagree,
  // and protection levels that reach to its other modes.
  bool posterior_mean = true;
  int posterior_samples = 512;  // a round
  std::optional<HeightPrior> height;
  std::optional<PositionStatement> place;  // what else is known of the position
  // Estimates the zenith delay that no model took out, zero within this sigma; 0: does not.
  double zenith_delay_sigma_m = 0.0;
  bool misfit = false;  // asks for that of the estimate
  // Probability of the risk that the protection levels leave.
  double integrity_risk = 1e-5;
};

struct ObservationVerdict {
  double residual_m = 0.0;
  double weight = 0.0;      // probability that the error is ordinary noise
  double late_share = 0.0;  // probability that it is a reflection
  bool used = false;        // weight at least a half
  bool observable = true;   // false: the only one of a clock group nobody knows
};

struct PointEstimate {
  PointStatus status = PointStatus::kTooFew;
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
  // What ranges and priors know of the position, clocks eliminated, as normal errors around it.
  Eigen::Matrix3d information_pm2 = Eigen::Matrix3d::Zero();
  // The part of it that was stated and not ranged.
  Eigen::Matrix3d stated_information_pm2 = Eigen::Matrix3d::Zero();
  // How many times the variance is in covariance_enu_m2 that independent errors would leave.
  double covariance_growth = 1.0;
  GroupMisfit misfit;    // of the ranges, where asked for
  double clock_m = 0.0;  // of group 0
  double clock_variance_m2 = 0.0;
  double zenith_delay_m = 0.0;
  // Of the groups seen, after the epoch.
  std::array<ClockBias, kMaxClockGroups> biases = {};
  std::uint32_t groups_seen = 0;  // bit per group
  double hdop = 0.0;
  double vdop = 0.0;
  double pdop = 0.0;
  double tdop = 0.0;
  double protection_level_m = 0.0;  // 0 where no redundancy would show a fault; likewise:
  double vertical_protection_level_m = 0.0;
  int used = 0;
  int redundancy = 0;
  int iterations = 0;
};

// Keeps its workspace: solving allocates nothing once it has seen as many observations.
class PointAdjustment {
 public:
  // start_in_ecef: where to begin; only the way to the answer depends on it. biases: what is
  // known of the groups. verdicts: one per observation.
  PointStatus Solve(std::span<const RangeObservation> observations,
                    const Eigen::Vector3d& start_in_ecef, const ClockBiases& biases,
                    const PointOptions& options, PointEstimate* estimate,
                    std::vector<ObservationVerdict>* verdicts);

 private:
  std::vector<PointProblem::Row> rows_;
  std::vector<double> weights_;
  std::optional<PosteriorSampling> sampling_;
  int samples_ = 0;  // that sampling_ was made for
};

}  // namespace lodemark
