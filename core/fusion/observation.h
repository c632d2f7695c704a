// The measurements that fusion knows: each a small value that can linearise itself.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lodemark {

// How the errors of one range are distributed: ordinary noise; with some probability a reflection,
// which can only lengthen the path; rarely anything at all.
struct RangeErrorModel {
  double sigma_m = 1.0;           // ordinary noise, 1 sigma
  double late_probability = 0.0;  // that the signal came by a longer way, 0..1
  double late_scale_m = 30.0;     // mean of the extra path then
};

inline constexpr std::int32_t kNoClock = -1;

// A distance to a known point: code range of a satellite, or visual range of a landmark.
struct RangeObservation {
  Eigen::Vector3d point_in_ecef = Eigen::Vector3d::Zero();  // in the frame at reception
  double range_m = 0.0;  // corrected for all but the clock of its group
  RangeErrorModel error;
  std::int32_t clock_group = kNoClock;  // which receiver clock it contains
  // How many times an unmodelled zenith delay of the troposphere it contains; 0: none.
  double zenith_delay_factor = 0.0;
};

// The direction in which a camera sees a known point: a landmark.
struct BearingObservation {
  Eigen::Vector3d point_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Matrix3d point_covariance_enu_m2 = Eigen::Matrix3d::Zero();  // of this point alone
  Eigen::Vector3d direction_in_camera = Eigen::Vector3d::UnitZ();     // unit, to the point
  // Turns a small deviation of the direction into standard deviations: two rows, both orthogonal to
  // the direction, per radian.
  Eigen::Matrix<double, 2, 3> whitener = Eigen::Matrix<double, 2, 3>::Zero();
};

// A rate of change of a distance: Doppler.
struct RangeRateObservation {
  Eigen::Vector3d direction_in_ecef = Eigen::Vector3d::Zero();  // unit, receiver to point
  double rate_mps = 0.0;  // of the range, corrected for the motion of the point and its clock
  double sigma_mps = 1.0;
};

// How much a distance changed from one moment to another: carrier phase, whose origin cancels.
struct RangeChangeObservation {
  Eigen::Vector3d direction_in_ecef = Eigen::Vector3d::Zero();  // unit, receiver to point
  double change_m = 0.0;  // of the range, corrected for the motion of the point and its clock
  double sigma_m = 0.01;
};

}  // namespace lodemark
