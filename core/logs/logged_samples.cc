#include "core/logs/logged_samples.h"

namespace lodemark {
namespace {

std::optional<std::size_t> PlaceOf(LoggedSensor::Kind kind) {
  switch (kind) {
    case LoggedSensor::Kind::kAcceleration:
      return 0;
    case LoggedSensor::Kind::kTurnRate:
      return 1;
    case LoggedSensor::Kind::kPressure:
      return 2;
    default:
      return std::nullopt;
  }
}

}  // namespace

void LoggedSamples::Take(const LoggedSensor& sensor) {
  const std::optional<std::size_t> place = PlaceOf(sensor.kind);
  if (!place) return;
  std::optional<bool>& uncalibrated = uncalibrated_[*place];
  if (!uncalibrated) uncalibrated = sensor.uncalibrated;
  if (*uncalibrated != sensor.uncalibrated) return;
  if (waiting_.size() - timed_ >= kMostWaiting) {
    ++without_time_;
    return;
  }
  LoggedSample& sample = waiting_.emplace_back();
  sample.kind = sensor.kind;
  sample.elapsed_realtime_ns = sensor.elapsed_realtime_ns;
  for (int i = 0; i < sensor.count && i < 3; ++i) {
    sample.value[static_cast<std::size_t>(i)] = sensor.values[i] - sensor.biases[i];
  }
}

void LoggedSamples::Take(const AndroidEpoch& epoch) {
  const AndroidClock& clock = epoch.clock;
  if (!clock.Has(kClockHasElapsedRealtime) || !clock.Has(kClockHasFullBias)) return;
  clock_.Learn(clock.elapsed_realtime_ns, clock.time_ns - clock.full_bias_ns);
  TellTimes();
}

void LoggedSamples::End() {
  TellTimes();
  without_time_ += static_cast<std::int64_t>(waiting_.size() - timed_);
  waiting_.resize(timed_);
}

bool LoggedSamples::Next(LoggedSample* sample) {
  if (timed_ == 0) return false;
  *sample = waiting_.front();
  waiting_.pop_front();
  --timed_;
  return true;
}

void LoggedSamples::TellTimes() {
  for (; timed_ < waiting_.size(); ++timed_) {
    LoggedSample& sample = waiting_[timed_];
    const std::optional<std::int64_t> time_gps_ns = clock_.GpsTime(sample.elapsed_realtime_ns);
    if (!time_gps_ns) return;
    sample.time_gps_ns = *time_gps_ns;
  }
}

}  // namespace lodemark
