#include "core/gnss/precise_orbits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr std::size_t kPoints = 11;
constexpr double kEarthRotation_radps = 7.2921151467e-5;
constexpr std::int64_t kSmallestSpacing_ns = kSecond_ns;
constexpr std::int64_t kLargestSpacing_ns = 1800 * kSecond_ns;

// Samples first..first+kPoints-1, evenly spaced and without manoeuvre.
struct Window {
  std::size_t first = 0;
  std::size_t before = 0;  // the sample that begins the interval of the time asked for
};

// Whether samples i and i+1 belong to one smooth orbit sampled at the given spacing.
bool Continues(const std::vector<PreciseSample>& samples, std::size_t i, std::int64_t spacing_ns) {
  const std::int64_t step_ns = samples[i + 1].time_gps_ns - samples[i].time_gps_ns;
  return step_ns > spacing_ns / 2 && step_ns < spacing_ns + spacing_ns / 2 &&
         !samples[i].maneuver && !samples[i + 1].maneuver;
}

// The run of kPoints samples most nearly centred on the time.
std::optional<Window> FindWindow(const std::vector<PreciseSample>& samples,
                                 std::int64_t time_gps_ns) {
  if (samples.size() < kPoints) return std::nullopt;
  const auto after = std::upper_bound(
      samples.begin() + 1, samples.end() - 1, time_gps_ns,
      [](std::int64_t time_ns, const PreciseSample& s) { return time_ns < s.time_gps_ns; });
  const std::size_t before = static_cast<std::size_t>(after - samples.begin()) - 1;
  const std::int64_t begin_ns = samples[before].time_gps_ns;
  const std::int64_t end_ns = samples[before + 1].time_gps_ns;
  const std::int64_t spacing_ns = end_ns - begin_ns;
  if (spacing_ns < kSmallestSpacing_ns || spacing_ns > kLargestSpacing_ns) return std::nullopt;
  if (time_gps_ns < begin_ns || time_gps_ns > end_ns) return std::nullopt;
  if (!Continues(samples, before, spacing_ns)) return std::nullopt;

  std::size_t first = before;
  std::size_t last = before + 1;
  while (last - first + 1 < kPoints) {
    const bool can_fall = first > 0 && Continues(samples, first - 1, spacing_ns);
    const bool can_rise = last + 1 < samples.size() && Continues(samples, last, spacing_ns);
    if (!can_fall && !can_rise) return std::nullopt;
    const bool first_is_nearer =
        time_gps_ns - samples[first].time_gps_ns < samples[last].time_gps_ns - time_gps_ns;
    if (can_fall && (first_is_nearer || !can_rise)) {
      --first;
    } else {
      ++last;
    }
  }
  return Window{first, before};
}

}  // namespace

std::optional<PreciseState> InterpolatePrecise(const std::vector<PreciseSample>& samples,
                                               std::int64_t time_gps_ns, double fraction_s) {
  const std::optional<Window> window = FindWindow(samples, time_gps_ns);
  if (!window) return std::nullopt;
  const PreciseSample& begin = samples[window->before];
  const PreciseSample& end = samples[window->before + 1];
  if (!begin.has_clock || !end.has_clock || end.clock_event) return std::nullopt;

  // Neville's scheme for value and derivative, in the earth-fixed frame of the time asked for kept
  // still: there the path is smooth, while the rotating frame adds its own turns.
  std::array<double, kPoints> t_s;
  std::array<Eigen::Vector3d, kPoints> value;
  std::array<Eigen::Vector3d, kPoints> slope;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const PreciseSample& sample = samples[window->first + i];
    t_s[i] = 1e-9 * static_cast<double>(sample.time_gps_ns - time_gps_ns) - fraction_s;
    const double turn_rad = kEarthRotation_radps * t_s[i];
    const double c = std::cos(turn_rad);
    const double s = std::sin(turn_rad);
    const Eigen::Vector3d& p = sample.position_in_ecef;
    value[i] = {c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()};
    slope[i].setZero();
  }
  for (std::size_t order = 1; order < kPoints; ++order) {
    for (std::size_t i = 0; i + order < kPoints; ++i) {
      const double left_s = t_s[i];
      const double right_s = t_s[i + order];
      const double inverse = 1.0 / (right_s - left_s);
      slope[i] = inverse * (right_s * slope[i] - left_s * slope[i + 1] + value[i + 1] - value[i]);
      value[i] = inverse * (right_s * value[i] - left_s * value[i + 1]);
    }
  }

  PreciseState state;
  state.position_in_ecef = value[0];
  state.velocity_in_ecef =
      slope[0] + kEarthRotation_radps * Eigen::Vector3d(value[0].y(), -value[0].x(), 0.0);
  const double interval_s = 1e-9 * static_cast<double>(end.time_gps_ns - begin.time_gps_ns);
  const double since_s = 1e-9 * static_cast<double>(time_gps_ns - begin.time_gps_ns) + fraction_s;
  state.clock_drift_sps = (end.clock_bias_s - begin.clock_bias_s) / interval_s;
  state.clock_bias_s = begin.clock_bias_s + since_s * state.clock_drift_sps;
  return state;
}

}  // namespace lodemark
