// One epoch of ranges, linearised around a point: the arithmetic that the point estimators share.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"
#include "core/fusion/position_statement.h"

namespace lodemark {

// An independent statement about the height, such as the memory of the last one.
struct HeightPrior {
  double height_m = 0.0;  // above the ellipsoid
  double sigma_m = 0.0;
};

inline constexpr double kUnknownBias_m = 1e4;  // a sigma beyond which a bias counts as not known

inline constexpr int kMaxPointUnknowns = 3 + kMaxClockGroups + 1;
using PointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxPointUnknowns, 1>;
using PointMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxPointUnknowns, kMaxPointUnknowns>;

// Unknowns: east, north, up in metres from the linearisation point, the clock of a pivot group,
// what the clock of each other group differs from the pivot's, and last, if asked for, the zenith
// delay of the troposphere that no model took out.
class PointProblem {
 public:
  struct Row {
    Eigen::Vector3d direction;  // east, north, up; unit, from receiver to point
    double misclosure_m = 0.0;  // observed minus computed at the linearisation point, clock in it
    int clock = -1;             // dense index of its group; 0 is the pivot; -1: no clock
    double zenith_delay_factor = 0.0;
    RangeErrorModel error;
  };

  // rows is workspace that the caller keeps.
  PointProblem(std::span<const RangeObservation> observations, const ClockBiases& biases,
               const std::optional<HeightPrior>& height, std::vector<Row>* rows);

  // Linearises around a new point; the clocks stay.
  void MoveTo(const Eigen::Vector3d& point_in_ecef);
  // Applies a step of the unknowns: moves the point and adds to the clocks.
  void Step(const PointVector& step);

  int unknowns() const { return 3 + clocks_ + (zenith_delay_sigma_m_ > 0.0 ? 1 : 0); }
  int clocks() const { return clocks_; }
  int group(int clock) const { return group_of_[static_cast<std::size_t>(clock)]; }
  int members(int clock) const { return members_[static_cast<std::size_t>(clock)]; }
  std::span<const Row> rows() const { return *rows_; }
  const Eigen::Vector3d& point_in_ecef() const { return point_in_ecef_; }
  const Eigen::Matrix3d& enu_from_ecef() const { return enu_from_ecef_; }
  // Whether a clock is worth more than one range of it: false for the only range of a clock that
  // nothing ties to another.
  bool IsShared(int clock) const;
  bool IsObservable(const Row& row) const { return row.clock < 0 || IsShared(row.clock); }
  // Value of the clock that a row contains.
  double ClockOf(const Row& row) const;
  PointVector& clock_state() { return clock_state_; }
  const PointVector& clock_state() const { return clock_state_; }
  double prior_m(int clock) const { return prior_m_[static_cast<std::size_t>(clock)]; }
  double prior_sigma_m(int clock) const { return prior_sigma_m_[static_cast<std::size_t>(clock)]; }

  // Believes what else is known of the place; to be said before the first MoveTo.
  void Believe(const std::optional<PositionStatement>& place) { place_ = place; }
  // Makes the zenith delay an unknown, believed to be zero within sigma_m (> 0).
  void EstimateZenithDelay(double sigma_m) { zenith_delay_sigma_m_ = sigma_m; }
  double& zenith_delay_m() { return zenith_delay_m_; }
  double zenith_delay_m() const { return zenith_delay_m_; }

  // Observed minus computed with the clocks and the zenith delay as they are.
  double Residual(const Row& row) const {
    return row.misclosure_m - ClockOf(row) - row.zenith_delay_factor * zenith_delay_m_;
  }
  // How the range of a row changes with each unknown.
  PointVector Slope(const Row& row) const;

  // Clocks by the median of each group's misclosures, priors heeded where a group is known.
  void GuessClocks();

  // Adds one row's weight and weighted residual to normal equations.
  void Accumulate(const Row& row, double weight, double weighted_residual, PointMatrix* normal,
                  PointVector* right) const;
  // Adds what is believed of the clock differences, of the height and of the place.
  void AccumulatePriors(PointMatrix* normal, PointVector* right) const;
  // -log density of the priors at the present state.
  double PriorCost() const;
  double height_residual_m(double up_m) const;
  const std::optional<HeightPrior>& height() const { return height_; }
  const std::optional<PositionStatement>& place() const { return place_; }
  // From the point that the statement is around to the linearisation point: east, north, up.
  const Eigen::Vector3d& place_offset_m() const { return place_offset_m_; }

 private:
  std::span<const RangeObservation> observations_;
  std::optional<HeightPrior> height_;
  std::optional<PositionStatement> place_;
  Eigen::Vector3d place_offset_m_ = Eigen::Vector3d::Zero();
  std::vector<Row>* rows_;
  Eigen::Vector3d point_in_ecef_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d enu_from_ecef_ = Eigen::Matrix3d::Identity();
  double height_m_ = 0.0;
  int clocks_ = 0;
  std::array<int, kMaxClockGroups> group_of_ = {};
  std::array<int, kMaxClockGroups> members_ = {};
  std::array<double, kMaxClockGroups> prior_m_ = {};
  std::array<double, kMaxClockGroups> prior_sigma_m_ = {};
  PointVector clock_state_;
  double zenith_delay_sigma_m_ = 0.0;
  double zenith_delay_m_ = 0.0;
};

}  // namespace lodemark
