// How far the receiver rose from one moment to the next, as something besides satellites tells it.
#pragma once

#include <Eigen/Core>

#include "core/fusion/step_adjustment.h"

namespace lodemark {

struct Rise {
  double rise_m = 0.0;   // of the height above the ellipsoid
  double sigma_m = 0.0;  // positive
};

// What is known of a step that begins where up is so; independent of the rise. Gives the square of
// how far they are apart, in its expected variance; where that is too far the rise is not heard.
double HearRise(const Rise& rise, const Eigen::Vector3d& up_in_ecef, StepKnowledge* known);

}  // namespace lodemark
