// Samples of sensors as the core takes them.
#pragma once

#include "core/capi/last_error.h"
#include "core/session/session.h"
#include "lodemark/lodemark.h"

namespace lodemark {

// Objects to numbers that no sensor gives.
lodemark_status ReadSample(const lodemark_sensor_sample& from, Where where, SensorSample* to);

}  // namespace lodemark
