// A vehicle's speed and yaw rate as an inertial sensor would feel them that is fixed level in it: x
// forward, y to the left, z up.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/fusion/inertial_sample.h"
#include "core/session/sensor_buffer.h"

namespace lodemark {

// Writes samples from from_ns to to_ns, both included. False, and none, where the vehicle's do not
// reach: a longer gap than a second.
bool FeltInVehicle(const SensorBuffer& sensors, std::int64_t from_ns, std::int64_t to_ns,
                   std::vector<InertialSample>* felt);

}  // namespace lodemark
