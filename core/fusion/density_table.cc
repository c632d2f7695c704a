#include "core/fusion/density_table.h"

#include "core/fusion/range_error.h"

namespace lodemark {

void DensityTable::Fill(const RangeErrorModel& model) {
  constexpr double kCoreHalf = 6.0;    // sigma
  constexpr double kTailLength = 8.0;  // late scales
  core_begin_m_ = -kCoreHalf * model.sigma_m;
  tail_begin_m_ = kCoreHalf * model.sigma_m;
  const double core_step_m = 2.0 * kCoreHalf * model.sigma_m / kCoreSteps;
  const double tail_step_m = kTailLength * model.late_scale_m / kTailSteps;
  core_nodes_per_m_ = 1.0 / core_step_m;
  tail_nodes_per_m_ = 1.0 / tail_step_m;
  for (std::size_t i = 0; i < core_.size(); ++i) {
    core_[i] = static_cast<float>(
        RangeErrorDensity(model, core_begin_m_ + static_cast<double>(i) * core_step_m));
  }
  for (std::size_t i = 0; i < tail_.size(); ++i) {
    tail_[i] = static_cast<float>(
        RangeErrorDensity(model, tail_begin_m_ + static_cast<double>(i) * tail_step_m));
  }
  floor_pm_ = GrossErrorDensity();
}

}  // namespace lodemark
