#include "tools/simulator/phone_hold.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "tools/simulator/photo_plan.h"

namespace lodemark {
namespace {

constexpr double kTurnTime_s = 1.0;
constexpr double kInstant_s = 1e-6;  // to either side of a jump

// From 0 to 1, with rate and acceleration zero at both ends.
double Smooth(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

// b by whole turns as near to a as can be.
double Near(double a, double b) { return a + std::remainder(b - a, 2.0 * kPi); }

}  // namespace

PhoneHold::PhoneHold(const Scenario& scenario) : path_(scenario) {
  for (const double time_s : path_.StopTimes()) {
    const double before_rad = path_.At(time_s - kInstant_s).heading_rad;
    const double after_rad = path_.At(time_s + kInstant_s).heading_rad;
    const double jump_rad = std::remainder(after_rad - before_rad, 2.0 * kPi);
    turns_.push_back({time_s, std::min(kTurnTime_s, scenario.stop_s), jump_rad});
  }
  for (const PhotoGroup& group : scenario.photography.groups) {
    for (const FrameSeries& series : group.frames) {
      double time_s = series.first_s;
      for (CameraHold hold : series.holds) {
        if (series.ahead) hold.heading_rad += path_.At(time_s).heading_rad;
        hold.heading_rad -= HeadingAlong(time_s);
        frames_.push_back({time_s, hold});
        time_s += series.every_s;
      }
    }
  }
  std::stable_sort(frames_.begin(), frames_.end(),
                   [](const Frame& a, const Frame& b) { return a.time_s < b.time_s; });
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    CameraHold& hold = frames_[i].hold;
    hold.heading_rad = Near(frames_[i - 1].hold.heading_rad, hold.heading_rad);
    hold.roll_rad = Near(frames_[i - 1].hold.roll_rad, hold.roll_rad);
  }
}

double PhoneHold::HeadingAlong(double time_s) const {
  double heading_rad = path_.At(time_s).heading_rad;
  for (const Turn& turn : turns_) {
    if (time_s < turn.begin_s) break;
    heading_rad -= turn.jump_rad * (1.0 - Smooth((time_s - turn.begin_s) / turn.length_s));
  }
  return heading_rad;
}

Eigen::Quaterniond PhoneHold::EnuFromDevice(double time_s) const {
  CameraHold hold;
  if (!frames_.empty()) {
    const auto after =
        std::upper_bound(frames_.begin(), frames_.end(), time_s,
                         [](double time, const Frame& frame) { return time < frame.time_s; });
    const Frame& b = after == frames_.end() ? frames_.back() : *after;
    const Frame& a = after == frames_.begin() ? frames_.front() : *(after - 1);
    const double gap_s = b.time_s - a.time_s;
    const double share = gap_s > 0.0 ? Smooth((time_s - a.time_s) / gap_s) : 0.0;
    const auto between = [share](double from, double to) { return from + share * (to - from); };
    hold.heading_rad = between(a.hold.heading_rad, b.hold.heading_rad);
    hold.tilt_rad = between(a.hold.tilt_rad, b.hold.tilt_rad);
    hold.roll_rad = between(a.hold.roll_rad, b.hold.roll_rad);
  }
  hold.heading_rad += HeadingAlong(time_s);
  const Eigen::Quaterniond device_from_camera(0.0, 1.0, 0.0, 0.0);  // half a turn about x
  const Rigid3 camera_from_enu = CameraFromEnu(Eigen::Vector3d::Zero(), hold);
  return (device_from_camera * camera_from_enu.rotation()).conjugate().normalized();
}

}  // namespace lodemark
