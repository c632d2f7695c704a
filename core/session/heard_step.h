// What a filter heard at one moment and on the way to it: all that it takes to go the way again.
#pragma once

#include <cstdint>
#include <vector>

#include "core/fusion/acceleration_memory.h"
#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/position_statement.h"
#include "core/session/gnss_epoch.h"

namespace lodemark {

struct HeardStep {
  std::int64_t time_ns = 0;  // the session's
  MotionModel motion;
  // Of now and since the moment before, with the sigmas that the signals themselves have.
  std::vector<RangeRateObservation> rates;
  std::vector<SatelliteId> rate_satellites;
  std::vector<RangeChangeObservation> changes;
  std::vector<SatelliteId> change_satellites;
  // The epoch's ranges, and what was known beside them and the place; empty without an epoch.
  std::vector<RangeObservation> ranges;
  std::vector<RangeSource> sources;
  double epoch_seconds = 0.0;  // since the epoch before; 0: none is known
  ClockBiases biases;
  PointOptions options;
  // What the epoch, and photographs, said of the place, as it was heard.
  PositionStatement of_epoch;
  PositionStatement of_photos;
};

}  // namespace lodemark
