// Which way the simulated phone is held at any time: turned and tilted from photograph to
// photograph, upright along its way without any.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tools/simulator/receiver_path.h"
#include "tools/simulator/scenario.h"

namespace lodemark {

// The axes are those of Android's sensors: x to the right, y up, z out of the screen. The camera
// looks the other way, its image as wide as x: camera x, y, z are device x, -y, -z.
class PhoneHold {
 public:
  explicit PhoneHold(const Scenario& scenario);

  // Turns axes of the device into east, north, up; seconds after the start. Continuous, and so is
  // its rate but where the way's heading has a kink.
  Eigen::Quaterniond EnuFromDevice(double time_s) const;

 private:
  // Where the way stops at a corner, its heading jumps; the phone is turned while it stands.
  struct Turn {
    double begin_s = 0.0;
    double length_s = 0.0;
    double jump_rad = 0.0;
  };
  // The hold of a photograph, its heading against that of the way.
  struct Frame {
    double time_s = 0.0;
    CameraHold hold;
  };

  double HeadingAlong(double time_s) const;

  ReceiverPath path_;
  std::vector<Turn> turns_;
  std::vector<Frame> frames_;
};

}  // namespace lodemark
