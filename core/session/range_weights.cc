#include "core/session/range_weights.h"

#include <algorithm>
#include <cmath>

namespace lodemark {

RangeErrorModel RangeWeights::ErrorModel(int clock_group, const SignalQuality& quality) const {
  const double cn0_dbhz = quality.cn0_dbhz > 0.0 ? quality.cn0_dbhz : 40.0;
  const double sine = std::max(std::sin(quality.elevation_rad), 0.1);
  const double noise_m = 3.0 * std::pow(10.0, (40.0 - cn0_dbhz) / 20.0);
  const double noise_variance = (1.0 + noise_m * noise_m) * (0.7 + 0.3 / (sine * sine));
  const Scale& scale = scales_[static_cast<std::size_t>(clock_group)];
  constexpr double kPriorCount = 30.0;
  const double factor = (kPriorCount + scale.squares) / (kPriorCount + scale.count);
  RangeErrorModel model;
  model.sigma_m = std::sqrt(factor * noise_variance + quality.model_sigma_m * quality.model_sigma_m);
  model.late_probability = std::clamp(0.05 + 0.02 * (45.0 - cn0_dbhz), 0.03, 0.6);
  if (quality.multipath_reported) model.late_probability = std::min(0.8, model.late_probability + 0.2);
  model.late_scale_m = 30.0;
  return model;
}

void RangeWeights::Learn(int clock_group, const RangeErrorModel& model, double model_sigma_m,
                         double residual_m, double redundancy_share, double core_share) {
  Scale& scale = scales_[static_cast<std::size_t>(clock_group)];
  constexpr double kForget = 0.999;
  const double present = std::max(0.01, 1.0);
  static_cast<void>(present);
  static_cast<void>(model_sigma_m);
  const double u = residual_m / model.sigma_m;
  constexpr double kPriorCount = 30.0;
  const double factor = (kPriorCount + scale.squares) / (kPriorCount + scale.count);
  scale.squares = kForget * scale.squares + core_share * u * u * factor;
  scale.count = kForget * scale.count + core_share * redundancy_share;
}

void RangeWeights::Forget() { scales_ = {}; }

}  // namespace lodemark
