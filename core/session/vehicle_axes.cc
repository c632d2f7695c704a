#include "core/session/vehicle_axes.h"

#include <algorithm>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr std::int64_t kLongestGap_ns = 1'000'000'000;
constexpr double kGravity_mps2 = 9.81;

// What is said at a time between two samples, or held beyond the last of them.
struct Between {
  double yaw_rate_radps = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
};

Between At(std::span<const VehicleSample> samples, std::int64_t time_ns) {
  const auto after = std::find_if(samples.begin(), samples.end(), [&](const VehicleSample& sample) {
    return sample.time_ns >= time_ns;
  });
  if (after == samples.end() || after == samples.begin()) {
    const VehicleSample& held = after == samples.end() ? samples.back() : samples.front();
    return {held.left_yaw_rate_radps, held.forward_speed_mps, 0.0};
  }
  const VehicleSample& before = *(after - 1);
  const double seconds = 1e-9 * static_cast<double>(after->time_ns - before.time_ns);
  const double share = 1e-9 * static_cast<double>(time_ns - before.time_ns) / seconds;
  const double gained_mps = after->forward_speed_mps - before.forward_speed_mps;
  return {before.left_yaw_rate_radps +
              share * (after->left_yaw_rate_radps - before.left_yaw_rate_radps),
          before.forward_speed_mps + share * gained_mps, gained_mps / seconds};
}

}  // namespace

bool FeltInVehicle(const SensorBuffer& sensors, std::int64_t from_ns, std::int64_t to_ns,
                   std::vector<InertialSample>* felt) {
  felt->clear();
  if (from_ns >= to_ns) return false;
  const std::span<const VehicleSample> samples =
      sensors.VehicleBetween(from_ns - kLongestGap_ns, to_ns + kLongestGap_ns);
  if (samples.size() < 2) return false;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    if (samples[i + 1].time_ns - samples[i].time_ns > kLongestGap_ns) return false;
  }
  if (samples.front().time_ns > from_ns || to_ns - samples.back().time_ns > kLongestGap_ns) {
    return false;
  }
  const auto add = [&](std::int64_t time_ns) {
    const Between said = At(samples, time_ns);
    InertialSample sample;
    sample.time_ns = time_ns;
    sample.turn_rate_radps.z() = said.yaw_rate_radps;
    sample.specific_force_mps2 = {said.acceleration_mps2, said.speed_mps * said.yaw_rate_radps,
                                  kGravity_mps2};
    felt->push_back(sample);
  };
  add(from_ns);
  for (const VehicleSample& sample : samples) {
    if (sample.time_ns > from_ns && sample.time_ns < to_ns) add(sample.time_ns);
  }
  add(to_ns);
  return true;
}

}  // namespace lodemark
