// What is up in a photograph, by the accelerometer of the phone that took it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "core/resection/sights.h"
#include "core/session/sensor_buffer.h"

namespace lodemark {

// The mean specific force around the time, in camera axes. Its sigma is what a single sample's
// scatter turns it by, 2 degrees at least, since a phone that speeds up steadily does not scatter.
// None of fewer than three samples, and where they cannot be of gravity alone.
std::optional<GravityPrior> LevelAt(const SensorBuffer& sensors, std::int64_t time_ns,
                                    const Eigen::Quaterniond& camera_from_device);

}  // namespace lodemark
