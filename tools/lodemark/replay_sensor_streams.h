// The files that samples of sensors come from.
#pragma once

#include <memory>

#include "core/base/result.h"
#include "tools/lodemark/replay_sensors.h"

namespace lodemark {

// begin_gps_ns is where a table's seconds of the recording count from, known once the first sample
// is asked for. Errors name the file.
Result<std::unique_ptr<SensorStream>> OpenSensorStream(const SensorFile& file,
                                                       const std::int64_t* begin_gps_ns,
                                                       std::vector<std::string>* remarks);

}  // namespace lodemark
