// A recording with its satellites taken away for some seconds at a time: how far what carries the
// filter leads it astray until they come back.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/session/sensor_buffer.h"

namespace lodemark::test {

struct MovingRecording {
  std::span<const ObservationEpoch> epochs;
  std::span<const NavigationRecord> navigation;
  std::span<const SensorSample> samples;  // by time, in GPS time; none: the motion alone
  std::string truth;                      // path of a truth.csv
};

struct OutageDrift {
  double mean_m = 0.0;         // by how much the horizontal position's error changes over an outage
  double over_accuracy = 0.0;  // root mean square of the same, as a share of what is stated then
  double mean_accuracy_m = 0.0;
  int outages = 0;       // that could be scored
  bool answered = true;  // every epoch of them
};

// is_gone: whether there are no satellites so many seconds after the first epoch. An error that is
// common to all of the truth cancels.
OutageDrift DriftThroughOutages(const MovingRecording& recording,
                                const std::function<bool(double)>& is_gone);

}  // namespace lodemark::test
