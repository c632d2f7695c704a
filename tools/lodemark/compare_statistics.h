// Statistics of position errors: how far off, and whether the stated accuracy was honest.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace lodemark {

// Estimate minus truth at one epoch, and what the estimate claimed about itself.
struct EpochError {
  std::int64_t time_gps_ns = 0;
  double east_m = 0.0;
  double north_m = 0.0;
  std::optional<double> up_m;  // empty where the truth has no height
  std::optional<std::array<double, 2>> horizontal_velocity_mps;  // east, north
  std::optional<double> up_velocity_mps;
  std::optional<double> accuracy_m;
  std::optional<double> protection_level_m;
  std::optional<double> vertical_protection_level_m;
  // Horizontal error in units of its own sigma, see NormalisedHorizontalError.
  std::optional<double> normalised;
  // The same in three dimensions, squared, see NormalisedSquaredError.
  std::optional<double> nees;

  double horizontal_m() const;
};

// Mahalanobis distance of (east, north) under the covariance ee, en, nn. Empty if that is not
// positive definite. 3 or more happens to 1.1 % of honest errors.
std::optional<double> NormalisedHorizontalError(double east_m, double north_m,
                                                const std::array<double, 3>& covariance_m2);

// The same when only the 68 % radius is known: the error is taken as circular.
std::optional<double> NormalisedHorizontalError(double east_m, double north_m, double accuracy_m);

// Square of the Mahalanobis distance of (east, north, up) under the covariance ee, en, nn, eu, nu,
// uu: 3 on average if the covariance is honest. Empty if that is not positive definite.
std::optional<double> NormalisedSquaredError(const std::array<double, 3>& error_m,
                                             const std::array<double, 6>& covariance_m2);

// Value below which the share of the sorted values lies, linear between neighbours: share 0 gives
// the first, 1 the last, and value i stands at share i / (count - 1). At least one value.
double SortedQuantile(const std::vector<double>& sorted, double share);

// Of magnitudes or of signed values; the quantiles and the largest are of the absolute values.
struct Spread {
  std::int64_t count = 0;
  double mean = 0.0;
  double rmse = 0.0;
  double p50 = 0.0;
  double p68 = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

// All zero for no value.
Spread SpreadOf(const std::vector<double>& values);

struct Share {
  std::int64_t count = 0;
  std::int64_t of = 0;

  void Add(bool hit) {
    count += hit ? 1 : 0;
    ++of;
  }
  double value() const { return of > 0 ? static_cast<double>(count) / static_cast<double>(of) : 0; }
};

// Ends of the middle 95 % of chi-square with 3 degrees of freedom.
inline constexpr double kLeastNees = 0.2158;
inline constexpr double kGreatestNees = 9.3484;

struct ErrorStatistics {
  std::int64_t expected_epochs = 0;
  std::int64_t answered_epochs = 0;
  Spread horizontal_m;
  Spread three_d_m;
  Spread up_m;
  Spread horizontal_velocity_mps;
  Spread up_velocity_mps;
  Spread stated_accuracy_m;
  Spread nees;
  Share nees_in_band;       // within the middle 95 % of chi-square with 3 degrees of freedom
  Share within_accuracy;    // horizontal error at most the stated 68 % radius
  Share beyond_3_sigma;     // normalised above 3
  Share beyond_protection;  // horizontal error above its protection level
  Share beyond_vertical_protection;

  double coverage() const {
    return expected_epochs > 0
               ? static_cast<double>(answered_epochs) / static_cast<double>(expected_epochs)
               : 0.0;
  }
};

// Errors are those of the answered epochs.
ErrorStatistics StatisticsOf(const std::vector<EpochError>& errors, std::int64_t expected_epochs);

}  // namespace lodemark
