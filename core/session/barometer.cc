#include "core/session/barometer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/units.h"

namespace lodemark {
namespace {

// ISO 2533: the standard atmosphere, up to 11 km.
constexpr double kStandardPressure_hpa = 1013.25;
constexpr double kStandardTemperature_k = 288.15;
constexpr double kLapse_kpm = 0.0065;
constexpr double kMetersPerKelvin = 29.2713;  // R / g of dry air
constexpr double kHydrostaticPower = 5.25588;
constexpr double kHighest_m = 11'000.0;
constexpr double kLowest_m = -1'000.0;

// Weather changes it by 6 %, and the height is unsure: what is farther off is no air out here, or
// another unit.
constexpr double kLikeStandard = 0.12;

// The temperature of the air is another by some 15 K, 5 %, and stays so while one climbs on.
constexpr double kScaleSigma = 0.1;

// What drifts: weather, doors, wind; and the wind of driving, by the window and the vents.
constexpr double kDrift_m_psqrt_s = 0.1;
constexpr double kDriftBySpeed_m_psqrt_s = 0.02;

// A level is the end of a line through the samples of a second, of at least so many; else the last
// of them.
constexpr std::int64_t kLine_ns = kSecond_ns;
constexpr std::size_t kFewestForLine = 4;
constexpr std::int64_t kOldest_ns = 3 * kSecond_ns / 2;
constexpr double kSmallestNoise_m = 0.05;  // of a sample
constexpr double kSingleNoise_m = 0.15;
constexpr double kClimbSigma_mps = 0.5;
// The last sample is so many times older at most than samples are apart.
constexpr double kSparseLag = 1.5;
// Where samples scatter more than this about their line, something else happens than a climb.
constexpr double kUnclear_m = 0.6;

// A sensor that gives the same number for so long is stuck.
constexpr std::int64_t kStuck_ns = 10 * kSecond_ns;

// Nobody rises faster; a door or a window seems to.
constexpr std::int64_t kPiece_ns = kSecond_ns;
constexpr double kFastest_mps = 5.0;
// What is not measured in between.
constexpr double kUnseenRise_mps = 1.0;
constexpr double kMostUnseen = 0.5;
constexpr double kLongest_s = 300.0;

constexpr double kDoubtLasts_s = 30.0;
constexpr double kLargestSquare = 100.0;

double Seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

struct Air {
  double meters_per_log = 0.0;  // of pressure
  double lowest_hpa = 0.0;
  double highest_hpa = 0.0;
};

Air AirAt(double height_m) {
  const double temperature_k =
      kStandardTemperature_k - kLapse_kpm * std::clamp(height_m, kLowest_m, kHighest_m);
  const double pressure_hpa =
      kStandardPressure_hpa * std::pow(temperature_k / kStandardTemperature_k, kHydrostaticPower);
  return {kMetersPerKelvin * temperature_k, (1.0 - kLikeStandard) * pressure_hpa,
          (1.0 + kLikeStandard) * pressure_hpa};
}

// A height of an origin of its own.
struct Level {
  double height_m = 0.0;
  double variance_m2 = 0.0;
};

std::optional<Level> LevelAt(const SensorBuffer& sensors, std::int64_t time_ns, const Air& air) {
  const std::span<const PressureSample> near =
      sensors.PressuresBetween(time_ns - kOldest_ns, time_ns);
  if (near.empty()) return std::nullopt;
  for (const PressureSample& sample : near) {
    if (!(sample.pressure_hpa >= air.lowest_hpa && sample.pressure_hpa <= air.highest_hpa)) {
      return std::nullopt;
    }
  }
  const auto height = [&](const PressureSample& sample) {
    return -air.meters_per_log * std::log(sample.pressure_hpa / kStandardPressure_hpa);
  };
  const std::span<const PressureSample> line =
      sensors.PressuresBetween(time_ns - kLine_ns, time_ns);
  const double lag_s = Seconds(near.back().time_ns, time_ns);
  if (line.size() < kFewestForLine || lag_s > 0.5e-9 * static_cast<double>(kLine_ns)) {
    // Of a sensor that gives more, those of now have not come yet.
    const double apart_s =
        near.size() < 2 ? lag_s : Seconds(near[near.size() - 2].time_ns, near.back().time_ns);
    if (lag_s > kSparseLag * apart_s) return std::nullopt;
    return Level{height(near.back()), kSingleNoise_m * kSingleNoise_m +
                                          lag_s * lag_s * kClimbSigma_mps * kClimbSigma_mps};
  }
  const double count = static_cast<double>(line.size());
  double mean_s = 0.0;
  double mean_m = 0.0;
  for (const PressureSample& sample : line) {
    mean_s += Seconds(time_ns, sample.time_ns) / count;
    mean_m += height(sample) / count;
  }
  double squares_s2 = 0.0;
  double products_ms = 0.0;
  double squares_m2 = 0.0;
  for (const PressureSample& sample : line) {
    const double s = Seconds(time_ns, sample.time_ns) - mean_s;
    const double m = height(sample) - mean_m;
    squares_s2 += s * s;
    products_ms += s * m;
    squares_m2 += m * m;
  }
  const double slope_mps = products_ms / squares_s2;
  const double scatter_m2 = std::max((squares_m2 - slope_mps * products_ms) / (count - 2.0),
                                     kSmallestNoise_m * kSmallestNoise_m);
  const double variance_m2 = scatter_m2 * (1.0 / count + mean_s * mean_s / squares_s2);
  if (!(variance_m2 < kUnclear_m * kUnclear_m)) return std::nullopt;
  return Level{mean_m - slope_mps * mean_s, variance_m2};
}

// The smallest change of the sensor lately, at the pressure of the air; none if it has not changed.
std::optional<double> Quantum(const SensorBuffer& sensors, std::int64_t time_ns, const Air& air) {
  double smallest_hpa = std::numeric_limits<double>::infinity();
  double before_hpa = 0.0;
  for (const PressureSample& sample : sensors.PressuresBetween(time_ns - kStuck_ns, time_ns)) {
    const double change_hpa = std::abs(sample.pressure_hpa - before_hpa);
    if (before_hpa > 0.0 && change_hpa > 0.0) smallest_hpa = std::min(smallest_hpa, change_hpa);
    before_hpa = sample.pressure_hpa;
  }
  if (!std::isfinite(smallest_hpa)) return std::nullopt;
  return air.meters_per_log * smallest_hpa / air.lowest_hpa;
}

}  // namespace

std::optional<Rise> Barometer::RiseBetween(std::int64_t from_ns, std::int64_t to_ns,
                                           double height_m, double speed_mps) const {
  if (sensors_ == nullptr || from_ns >= to_ns || Seconds(from_ns, to_ns) > kLongest_s) {
    return std::nullopt;
  }
  if (sensors_->PressuresBetween(to_ns - kOldest_ns, to_ns).empty()) return std::nullopt;
  const Air air = AirAt(height_m);
  const std::optional<double> quantum_m = Quantum(*sensors_, to_ns, air);
  if (!quantum_m) return std::nullopt;
  const double seconds = Seconds(from_ns, to_ns);
  const double drift_m2ps =
      kDrift_m_psqrt_s * kDrift_m_psqrt_s + std::pow(kDriftBySpeed_m_psqrt_s * speed_mps, 2);
  // Levels nearer in time than their samples share these.
  const double apart = std::min(1.0, seconds / (1e-9 * static_cast<double>(kLine_ns)));
  double rise_m = 0.0;
  double unseen_s = 0.0;
  double variance_m2 = seconds * drift_m2ps + apart * *quantum_m * *quantum_m / 6.0;
  std::optional<Level> before = LevelAt(*sensors_, from_ns, air);
  if (before) variance_m2 += apart * before->variance_m2;
  for (std::int64_t time_ns = from_ns; time_ns < to_ns;) {
    const std::int64_t next_ns = to_ns - time_ns > kPiece_ns ? time_ns + kPiece_ns : to_ns;
    const std::optional<Level> level = LevelAt(*sensors_, next_ns, air);
    const double piece_s = Seconds(time_ns, next_ns);
    const double sigma_m =
        before && level ? std::sqrt(before->variance_m2 + level->variance_m2) : 0.0;
    if (before && level &&
        std::abs(level->height_m - before->height_m) < kFastest_mps * piece_s + 3.0 * sigma_m) {
      rise_m += level->height_m - before->height_m;
    } else {
      unseen_s += piece_s;
    }
    before = level;
    time_ns = next_ns;
  }
  if (!before || unseen_s > kMostUnseen * seconds) return std::nullopt;
  // What a whole climb is wrong by, less what its beginning was.
  const double climbed_m = climbed_m_ * rise_m > 0.0 ? climbed_m_ : 0.0;
  variance_m2 += apart * before->variance_m2 +
                 kScaleSigma * kScaleSigma * (2.0 * climbed_m + rise_m) * rise_m +
                 std::pow(kUnseenRise_mps * unseen_s, 2);
  return Rise{rise_m, std::sqrt(std::max(1.0, doubt_) * variance_m2)};
}

void Barometer::Learn(double seconds, double rise_m, double square) {
  climbed_m_ = climbed_m_ * rise_m > 0.0 ? climbed_m_ + rise_m : rise_m;
  if (!(square >= 0.0)) return;
  doubt_ +=
      (1.0 - std::exp(-seconds / kDoubtLasts_s)) * (std::min(square, kLargestSquare) - doubt_);
}

}  // namespace lodemark
