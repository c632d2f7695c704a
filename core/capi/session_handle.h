// What a lodemark_session points to.
#pragma once

#include <memory>
#include <vector>

#include "core/gnss/android_measurement.h"
#include "core/gnss/observation.h"
#include "core/session/session.h"
#include "lodemark/lodemark.h"

struct lodemark_session {
  std::unique_ptr<lodemark::Session> engine;
  lodemark::TimeBase time_base = lodemark::TimeBase::kGps;
  // Memory for translating one call, kept so that pushing allocates nothing after the first ones.
  lodemark::AndroidEpoch android_epoch;
  lodemark::ObservationEpoch observation_epoch;
  std::vector<lodemark::SensorSample> sensor_samples;
};
