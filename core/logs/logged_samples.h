// What a phone's text says of acceleration, turn rate and pressure, with its GPS time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "core/gnss/android_measurement.h"
#include "core/logs/boot_clock.h"
#include "core/logs/gnss_logger.h"

namespace lodemark {

struct LoggedSample {
  LoggedSensor::Kind kind = LoggedSensor::Kind::kAcceleration;  // or kTurnRate, kPressure
  std::int64_t elapsed_realtime_ns = 0;
  std::int64_t time_gps_ns = 0;
  std::array<double, 3> value = {};  // in the unit of the kind, less the bias that the phone states
};

// Takes the records of a log in their order. Samples wait for the epoch after them, by which their
// times are told.
class LoggedSamples {
 public:
  // Samples before the first epoch that tells GPS time; three sensors give some 400 in a second.
  static constexpr std::size_t kMostWaiting = 100'000;

  // A log may hold a sensor twice, as it is and without its bias: the one that came first counts.
  // Of no other kinds.
  void Take(const LoggedSensor& sensor);
  void Take(const AndroidEpoch& epoch);
  // No record is left. What still waits has the time that the epochs told, or none.
  void End();

  // The next sample with a time, in the log's order. False if there is none now.
  bool Next(LoggedSample* sample);

  // Samples that were left out for want of one.
  std::int64_t without_time() const { return without_time_; }

 private:
  void TellTimes();

  BootClock clock_;
  std::deque<LoggedSample> waiting_;  // the first timed_ have GPS time
  std::size_t timed_ = 0;
  std::array<std::optional<bool>, 3> uncalibrated_;  // acceleration, turn rate, pressure
  std::int64_t without_time_ = 0;
};

}  // namespace lodemark
