#include "core/session/sensor_buffer.h"

#include <algorithm>
#include <cassert>

namespace lodemark {
namespace {

// Exact for any two times, where a difference of int64 may not be one.
bool ApartMoreThan(std::int64_t earlier_ns, std::int64_t later_ns, std::int64_t limit_ns) {
  return static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns) >
         static_cast<std::uint64_t>(limit_ns);
}

// Gives the values of one sensor at times that do not go back.
template <typename Sample>
class Interpolation {
 public:
  // Of at least one sample.
  explicit Interpolation(std::span<const Sample> samples) : samples_(samples) {}

  Eigen::Vector3d At(std::int64_t time_ns) {
    while (next_ < samples_.size() && samples_[next_].time_ns < time_ns) ++next_;
    if (next_ == 0) return samples_.front().value;
    if (next_ == samples_.size()) return samples_.back().value;
    const Sample& before = samples_[next_ - 1];
    const Sample& after = samples_[next_];
    const double whole = Seconds(before.time_ns, after.time_ns);
    const double part = Seconds(before.time_ns, time_ns) / whole;
    return before.value + part * (after.value - before.value);
  }

 private:
  static double Seconds(std::int64_t from_ns, std::int64_t to_ns) {
    return 1e-9 * static_cast<double>(static_cast<std::uint64_t>(to_ns) -
                                      static_cast<std::uint64_t>(from_ns));
  }

  std::span<const Sample> samples_;
  std::size_t next_ = 0;  // the first that is not before the time asked last
};

}  // namespace

SensorBuffer::SensorBuffer()
    : forces_(kMostInertialSamples),
      turn_rates_(kMostInertialSamples),
      pressures_(kMostPressureSamples),
      vehicle_(kMostVehicleSamples) {}

SensorBuffer::Place SensorBuffer::Judge(std::int64_t time_ns, Order* order) {
  if (order->has_last && time_ns <= order->last_ns) {
    const bool advances = order->has_older && time_ns > order->last_older_ns;
    if (!advances) order->first_older_ns = time_ns;
    order->has_older = true;
    order->last_older_ns = time_ns;
    if (!ApartMoreThan(order->first_older_ns, time_ns, kRestartAfter_ns)) return Place::kDropped;
    *order = {.has_last = true, .last_ns = time_ns};
    return Place::kRestart;
  }
  *order = {.has_last = true, .last_ns = time_ns};
  return Place::kNext;
}

void SensorBuffer::Prepare(SensorKind kind) {
  switch (kind) {
    case SensorKind::kAccelerometer:
      return forces_.Prepare();
    case SensorKind::kGyroscope:
      return turn_rates_.Prepare();
    case SensorKind::kBarometer:
      return pressures_.Prepare();
    case SensorKind::kVehicle:
      return vehicle_.Prepare();
  }
}

bool SensorBuffer::Push(const SensorSample& sample) {
  const Place place = Judge(sample.time_ns, &orders_[static_cast<std::size_t>(sample.kind)]);
  if (place == Place::kDropped) return false;
  if (place == Place::kRestart) Clear(sample.kind);
  switch (sample.kind) {
    case SensorKind::kAccelerometer:
      forces_.Push({sample.time_ns, sample.value});
      break;
    case SensorKind::kGyroscope:
      turn_rates_.Push({sample.time_ns, sample.value});
      break;
    case SensorKind::kBarometer:
      pressures_.Push({sample.time_ns, sample.value.x()});
      break;
    case SensorKind::kVehicle:
      vehicle_.Push({sample.time_ns, sample.value.x(), sample.value.y()});
      break;
  }
  return true;
}

std::span<const SensorBuffer::Vector> SensorBuffer::Around(const SampleWindow<Vector>& window,
                                                           std::int64_t from_ns,
                                                           std::int64_t to_ns) {
  const std::size_t before = window.CountBefore(from_ns);
  const std::size_t begin = before > 0 ? before - 1 : 0;
  const std::size_t end = std::min(window.CountBefore(to_ns) + 1, window.count());
  return window.all().subspan(begin, end - begin);
}

bool SensorBuffer::Covers(std::span<const Vector> samples, std::int64_t from_ns,
                          std::int64_t to_ns) {
  const Vector& first = samples.front();
  const Vector& last = samples.back();
  if (first.time_ns > from_ns && ApartMoreThan(from_ns, first.time_ns, kLongestGap_ns)) {
    return false;
  }
  if (last.time_ns < to_ns && ApartMoreThan(last.time_ns, to_ns, kLongestGap_ns)) return false;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (ApartMoreThan(samples[i - 1].time_ns, samples[i].time_ns, kLongestGap_ns)) return false;
  }
  return true;
}

std::span<const InertialSample> SensorBuffer::Between(std::int64_t from_ns, std::int64_t to_ns,
                                                      bool* complete) const {
  *complete = false;
  merged_.clear();
  if (from_ns >= to_ns) return {};
  const std::span<const Vector> turn_rates = Around(turn_rates_, from_ns, to_ns);
  const std::span<const Vector> forces = Around(forces_, from_ns, to_ns);
  const auto near = [&](const Vector& sample) {
    const std::int64_t time_ns = sample.time_ns;
    if (time_ns < from_ns) return !ApartMoreThan(time_ns, from_ns, kLongestGap_ns);
    return time_ns <= to_ns || !ApartMoreThan(to_ns, time_ns, kLongestGap_ns);
  };
  if (std::none_of(turn_rates.begin(), turn_rates.end(), near)) return {};
  if (std::none_of(forces.begin(), forces.end(), near)) return {};
  *complete = Covers(turn_rates, from_ns, to_ns) && Covers(forces, from_ns, to_ns);

  if (merged_.capacity() == 0) merged_.reserve(kMostInertialSamples + 2);
  Interpolation turn_rate(turn_rates);
  Interpolation force(forces);
  merged_.push_back({from_ns, turn_rate.At(from_ns), force.At(from_ns)});
  for (const Vector& sample : turn_rates) {
    if (sample.time_ns <= from_ns || sample.time_ns >= to_ns) continue;
    merged_.push_back({sample.time_ns, sample.value, force.At(sample.time_ns)});
  }
  merged_.push_back({to_ns, turn_rate.At(to_ns), force.At(to_ns)});
  return merged_;
}

std::optional<MeanForce> SensorBuffer::MeanForceBetween(std::int64_t from_ns,
                                                        std::int64_t to_ns) const {
  const std::span<const Vector> forces = forces_.Within(from_ns, to_ns);
  if (forces.size() < 2) return std::nullopt;
  MeanForce mean;
  mean.samples = static_cast<int>(forces.size());
  for (const Vector& force : forces) mean.mean_mps2 += force.value;
  mean.mean_mps2 /= static_cast<double>(mean.samples);
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (const Vector& force : forces) squares += (force.value - mean.mean_mps2).array().square();
  mean.scatter_mps2 = (squares / static_cast<double>(mean.samples - 1)).sqrt().matrix();
  return mean;
}

std::span<const PressureSample> SensorBuffer::PressuresBetween(std::int64_t from_ns,
                                                               std::int64_t to_ns) const {
  return pressures_.Within(from_ns, to_ns);
}

std::span<const VehicleSample> SensorBuffer::VehicleBetween(std::int64_t from_ns,
                                                            std::int64_t to_ns) const {
  return vehicle_.Within(from_ns, to_ns);
}

void SensorBuffer::DropBefore(std::int64_t time_ns) {
  forces_.DropBefore(time_ns);
  turn_rates_.DropBefore(time_ns);
  pressures_.DropBefore(time_ns);
  vehicle_.DropBefore(time_ns);
}

void SensorBuffer::Clear(SensorKind kind) {
  switch (kind) {
    case SensorKind::kAccelerometer:
      forces_.Clear();
      break;
    case SensorKind::kGyroscope:
      turn_rates_.Clear();
      break;
    case SensorKind::kBarometer:
      pressures_.Clear();
      break;
    case SensorKind::kVehicle:
      vehicle_.Clear();
      break;
  }
}

void SensorBuffer::Forget() {
  orders_ = {};
  forces_.Clear();
  turn_rates_.Clear();
  pressures_.Clear();
  vehicle_.Clear();
  merged_.clear();
}

}  // namespace lodemark
