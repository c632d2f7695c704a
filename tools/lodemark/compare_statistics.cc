#include "tools/lodemark/compare_statistics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Radius, in sigmas, of the circle that holds 68 % of a circular normal distribution:
// sqrt(-2 ln(1 - 0.68)).
const double kRadius68_sigma = std::sqrt(-2.0 * std::log(1.0 - 0.68));

constexpr double kFarOut_sigma = 3.0;

}  // namespace

double EpochError::horizontal_m() const { return std::hypot(east_m, north_m); }

std::optional<double> NormalisedHorizontalError(double east_m, double north_m,
                                                const std::array<double, 3>& covariance_m2) {
  const auto [ee, en, nn] = covariance_m2;
  // Cholesky factor of the 2 by 2 covariance; the error is whitened by forward substitution.
  if (!(ee > 0.0)) return std::nullopt;
  const double l11 = std::sqrt(ee);
  const double l21 = en / l11;
  const double rest = nn - l21 * l21;
  if (!(rest > 0.0)) return std::nullopt;
  const double first = east_m / l11;
  const double second = (north_m - l21 * first) / std::sqrt(rest);
  const double distance = std::hypot(first, second);
  return std::isfinite(distance) ? std::optional<double>(distance) : std::nullopt;
}

std::optional<double> NormalisedHorizontalError(double east_m, double north_m, double accuracy_m) {
  if (!(accuracy_m > 0.0)) return std::nullopt;
  return std::hypot(east_m, north_m) * kRadius68_sigma / accuracy_m;
}

std::optional<double> NormalisedSquaredError(const std::array<double, 3>& error_m,
                                             const std::array<double, 6>& covariance_m2) {
  const auto [ee, en, nn, eu, nu, uu] = covariance_m2;
  Eigen::Matrix3d covariance;
  covariance << ee, en, eu, en, nn, nu, eu, nu, uu;
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector3d white =
      factor.matrixL().solve(Eigen::Vector3d(error_m[0], error_m[1], error_m[2]));
  const double squared = white.squaredNorm();
  return std::isfinite(squared) ? std::optional<double>(squared) : std::nullopt;
}

double SortedQuantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const std::size_t below = static_cast<std::size_t>(std::floor(place));
  if (below + 1 >= sorted.size()) return sorted.back();
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

Spread SpreadOf(const std::vector<double>& values) {
  Spread spread;
  if (values.empty()) return spread;
  std::vector<double> sorted;
  sorted.reserve(values.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
    sorted.push_back(std::abs(value));
  }
  std::sort(sorted.begin(), sorted.end());
  const double count = static_cast<double>(values.size());
  spread.count = static_cast<std::int64_t>(values.size());
  spread.mean = sum / count;
  spread.rmse = std::sqrt(squares / count);
  spread.p50 = SortedQuantile(sorted, 0.50);
  spread.p68 = SortedQuantile(sorted, 0.68);
  spread.p95 = SortedQuantile(sorted, 0.95);
  spread.max = sorted.back();
  return spread;
}

ErrorStatistics StatisticsOf(const std::vector<EpochError>& errors, std::int64_t expected_epochs) {
  ErrorStatistics statistics;
  statistics.expected_epochs = expected_epochs;
  statistics.answered_epochs = static_cast<std::int64_t>(errors.size());
  std::vector<double> horizontal, three_d, up, horizontal_velocity, up_velocity, accuracy, nees;
  for (const EpochError& error : errors) {
    const double horizontal_m = error.horizontal_m();
    horizontal.push_back(horizontal_m);
    if (error.up_m) {
      up.push_back(*error.up_m);
      three_d.push_back(std::hypot(horizontal_m, *error.up_m));
      if (error.vertical_protection_level_m) {
        statistics.beyond_vertical_protection.Add(std::abs(*error.up_m) >
                                                  *error.vertical_protection_level_m);
      }
    }
    if (error.horizontal_velocity_mps) {
      const auto [east, north] = *error.horizontal_velocity_mps;
      horizontal_velocity.push_back(std::hypot(east, north));
    }
    if (error.up_velocity_mps) up_velocity.push_back(*error.up_velocity_mps);
    if (error.accuracy_m) {
      accuracy.push_back(*error.accuracy_m);
      statistics.within_accuracy.Add(horizontal_m <= *error.accuracy_m);
    }
    if (error.normalised) statistics.beyond_3_sigma.Add(*error.normalised > kFarOut_sigma);
    if (error.nees) {
      nees.push_back(*error.nees);
      statistics.nees_in_band.Add(*error.nees >= kLeastNees && *error.nees <= kGreatestNees);
    }
    if (error.protection_level_m) {
      statistics.beyond_protection.Add(horizontal_m > *error.protection_level_m);
    }
  }
  statistics.horizontal_m = SpreadOf(horizontal);
  statistics.three_d_m = SpreadOf(three_d);
  statistics.up_m = SpreadOf(up);
  statistics.horizontal_velocity_mps = SpreadOf(horizontal_velocity);
  statistics.up_velocity_mps = SpreadOf(up_velocity);
  statistics.stated_accuracy_m = SpreadOf(accuracy);
  statistics.nees = SpreadOf(nees);
  return statistics;
}

}  // namespace lodemark
