// How far the receiver rose between two moments, by the pressure of the air.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/fusion/rise.h"
#include "core/session/sensor_buffer.h"

namespace lodemark {

// Only differences are taken: weather, altitude of the sensor's error and a car's ventilation move
// pressures by far more than a receiver's height is unsure. Allocates nothing.
class Barometer {
 public:
  // sensors: null for none; it must stay.
  explicit Barometer(const SensorBuffer* sensors) : sensors_(sensors) {}

  // height_m: about where it is; none if the pressure cannot be of there, if it does not change at
  // all, or if most of the samples are missing.
  std::optional<Rise> RiseBetween(std::int64_t from_ns, std::int64_t to_ns, double height_m,
                                  double speed_mps) const;

  // The last rise was heard; it was so far from what else was known: the square, in its expected
  // variance. One that errs more than it says is believed less for a while.
  void Learn(double seconds, double rise_m, double square);

 private:
  const SensorBuffer* sensors_;
  double doubt_ = 1.0;      // mean of the squares, of late
  double climbed_m_ = 0.0;  // since it last went the other way
};

}  // namespace lodemark
