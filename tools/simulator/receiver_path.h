// Where the simulated receiver is at any time: at rest, or on a smooth way along corners.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/simulator/scenario.h"

namespace lodemark {

struct ReceiverState {
  Eigen::Vector3d position_in_enu = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_enu = Eigen::Vector3d::Zero();
  double heading_rad = 0.0;  // clockwise from north
  double turn_rate_radps = 0.0;
};

// Corners are rounded, or stopped at, and walking starts and ends gently, so position and velocity
// are continuous.
class ReceiverPath {
 public:
  explicit ReceiverPath(const Scenario& scenario);

  // In the local frame of Scenario::place, seconds after the start. Past the last corner it stands.
  ReceiverState At(double time_s) const;
  // When it arrives at the corners where it stops and turns on the spot.
  std::vector<double> StopTimes() const;

 private:
  // How long it takes from the start until it stands for good.
  double Duration() const;

  // A ride that speeds up, rolls, and slows down to stand at the end.
  struct Ride {
    double ramp_s = 0.0;
    double ramp_m = 0.0;
    double roll_s = 0.0;
    double peak_mps = 0.0;
  };
  Ride RideOf() const;

  // A straight stretch or, with a radius, an arc.
  struct Piece {
    double begin_m = 0.0;  // way from the start
    double length_m = 0.0;
    Eigen::Vector2d from = Eigen::Vector2d::Zero();
    double heading_rad = 0.0;   // at its begin
    double curvature_pm = 0.0;  // positive to the right
  };

  std::vector<ReceiverPath> legs_;  // where it stops at corners: one after another
  std::vector<Piece> pieces_;
  double length_m_ = 0.0;
  double speed_mps_;
  double pause_s_;
  double phone_height_m_;
  double rise_m_;
};

}  // namespace lodemark
