#include "tools/simulator/receiver_path.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kCornerRadius_m = 2.5;
constexpr double kAcceleration_mps2 = 0.6;
constexpr double kRiseWay_m = 90.0;  // from low to low

Eigen::Vector2d Along(double heading_rad) { return {std::sin(heading_rad), std::cos(heading_rad)}; }

}  // namespace

ReceiverPath::ReceiverPath(const Scenario& scenario)
    : speed_mps_(scenario.speed_mps),
      pause_s_(scenario.pause_s),
      phone_height_m_(scenario.phone_height_m),
      rise_m_(scenario.rise_m) {
  std::vector<Eigen::Vector2d> corners;
  for (const auto& [east_m, north_m] : scenario.waypoints_m) {
    const Eigen::Vector2d corner(east_m, north_m);
    if (corners.empty() || (corner - corners.back()).norm() > 0.01) corners.push_back(corner);
  }
  if (corners.size() < 2) return;
  if (scenario.stop_s > 0.0 && corners.size() > 2) {
    Scenario leg = scenario;
    leg.rise_m = 0.0;  // the height would jump from leg to leg
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      leg.waypoints_m = {{corners[i].x(), corners[i].y()},
                         {corners[i + 1].x(), corners[i + 1].y()}};
      leg.pause_s = i == 0 ? scenario.pause_s : scenario.stop_s;
      legs_.emplace_back(leg);
    }
    return;
  }
  const auto append = [this](Piece piece) {
    if (piece.length_m < 1e-9) return;
    piece.begin_m = length_m_;
    length_m_ += piece.length_m;
    pieces_.push_back(piece);
  };
  double cut_before_m = 0.0;  // of the current stretch, taken by the arc before it
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d step = corners[i + 1] - corners[i];
    const double step_m = step.norm();
    const double heading_rad = std::atan2(step.x(), step.y());
    double turn_rad = 0.0;
    double cut_after_m = 0.0;
    double radius_m = 0.0;
    if (i + 2 < corners.size()) {
      const Eigen::Vector2d next = corners[i + 2] - corners[i + 1];
      turn_rad = std::remainder(std::atan2(next.x(), next.y()) - heading_rad, 2.0 * kPi);
      // The arc may take at most half of either stretch; turning right back is sharp.
      const double tangent = std::tan(std::min(std::abs(turn_rad), 3.0) / 2.0);
      cut_after_m = std::min({kCornerRadius_m * tangent, 0.45 * step_m, 0.45 * next.norm()});
      radius_m = tangent > 1e-9 ? cut_after_m / tangent : 0.0;
    }
    const Eigen::Vector2d from = corners[i] + cut_before_m * Along(heading_rad);
    const double straight_m = step_m - cut_before_m - cut_after_m;
    append({0.0, straight_m, from, heading_rad, 0.0});
    if (radius_m > 1e-9) {
      append({0.0, radius_m * std::abs(turn_rad), from + straight_m * Along(heading_rad),
              heading_rad, (turn_rad > 0.0 ? 1.0 : -1.0) / radius_m});
    }
    cut_before_m = cut_after_m;
  }
}

ReceiverPath::Ride ReceiverPath::RideOf() const {
  Ride ride;
  ride.peak_mps = std::min(speed_mps_, std::sqrt(length_m_ * kAcceleration_mps2));
  ride.ramp_s = ride.peak_mps / kAcceleration_mps2;
  ride.ramp_m = 0.5 * ride.peak_mps * ride.ramp_s;
  ride.roll_s = (length_m_ - 2.0 * ride.ramp_m) / ride.peak_mps;
  return ride;
}

double ReceiverPath::Duration() const {
  if (pieces_.empty()) return pause_s_;
  const Ride ride = RideOf();
  return pause_s_ + 2.0 * ride.ramp_s + ride.roll_s;
}

std::vector<double> ReceiverPath::StopTimes() const {
  std::vector<double> times_s;
  double time_s = 0.0;
  for (std::size_t i = 0; i + 1 < legs_.size(); ++i) {
    time_s += legs_[i].Duration();
    times_s.push_back(time_s);
  }
  return times_s;
}

ReceiverState ReceiverPath::At(double time_s) const {
  if (!legs_.empty()) {
    std::size_t leg = 0;
    while (leg + 1 < legs_.size() && time_s >= legs_[leg].Duration()) {
      time_s -= legs_[leg++].Duration();
    }
    return legs_[leg].At(time_s);
  }
  ReceiverState state;
  state.position_in_enu.z() = phone_height_m_;
  if (pieces_.empty()) return state;
  const double moving_s = std::max(0.0, time_s - pause_s_);
  const auto [ramp_s, ramp_m, roll_s, peak_mps] = RideOf();
  double way_m = 0.0;
  double speed_mps = 0.0;
  if (moving_s < ramp_s) {
    way_m = 0.5 * kAcceleration_mps2 * moving_s * moving_s;
    speed_mps = kAcceleration_mps2 * moving_s;
  } else if (moving_s < ramp_s + roll_s) {
    way_m = ramp_m + peak_mps * (moving_s - ramp_s);
    speed_mps = peak_mps;
  } else {
    const double left_s = std::max(0.0, 2.0 * ramp_s + roll_s - moving_s);
    way_m = length_m_ - 0.5 * kAcceleration_mps2 * left_s * left_s;
    speed_mps = kAcceleration_mps2 * left_s;
  }

  auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), way_m,
                                [](double way, const Piece& p) { return way < p.begin_m; });
  --piece;
  const double into_m = std::clamp(way_m - piece->begin_m, 0.0, piece->length_m);
  const double heading_rad = piece->heading_rad + piece->curvature_pm * into_m;
  Eigen::Vector2d at = piece->from;
  if (piece->curvature_pm == 0.0) {
    at += into_m * Along(heading_rad);
  } else {
    // Heading h turns at the curvature: the integral of (sin h, cos h).
    at += Eigen::Vector2d(std::cos(piece->heading_rad) - std::cos(heading_rad),
                          std::sin(heading_rad) - std::sin(piece->heading_rad)) /
          piece->curvature_pm;
  }
  const Eigen::Vector2d velocity = speed_mps * Along(heading_rad);
  const double rise_phase = 2.0 * kPi * way_m / kRiseWay_m;
  state.position_in_enu = {at.x(), at.y(),
                           phone_height_m_ + 0.5 * rise_m_ * (1.0 - std::cos(rise_phase))};
  state.velocity_in_enu = {velocity.x(), velocity.y(),
                           rise_m_ * kPi / kRiseWay_m * std::sin(rise_phase) * speed_mps};
  state.heading_rad = heading_rad;
  state.turn_rate_radps = piece->curvature_pm * speed_mps;
  return state;
}

}  // namespace lodemark
