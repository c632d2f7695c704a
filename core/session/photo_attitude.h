// How a camera was held, by the attitude of the phone that it is part of.
#pragma once

#include <optional>

#include "core/fusion/bearing_group.h"
#include "core/resection/resection.h"
#include "core/session/device_attitude.h"
#include "core/session/session.h"

namespace lodemark {

// Tells the frame what is up and where it looks, as far as it does not say it itself but how the
// camera sits in the phone; believed less than it is stated, as phone and filter may be off by what
// neither knows. No heading of a camera that looks steeply up or down, or that is hardly known.
// And nothing at all where the accelerometer felt up to be far from there.
void HoldByAttitude(const DeviceAttitude& attitude, const std::optional<GravityPrior>& felt,
                    CameraFrame* frame);

// A pose that landmarks agree on outweighs a heading that was believed before: contradicted, it
// goes.
void DropContradictedHeading(const ResectedPose& pose, AttitudePriors* attitude);

}  // namespace lodemark
