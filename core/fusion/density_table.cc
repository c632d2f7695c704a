#include "core/fusion/density_table.h"

#include "core/fusion/range_error.h"

namespace lodemark {
namespace {

constexpr double kHalfCore = 6.0;    // sigma
constexpr double kTailLength = 6.0;  // late scales

}  // namespace

void DensityTable::Fill(const RangeErrorModel& model) {
  const double half_m = kHalfCore * model.sigma_m;
  const double core_step_m = 2.0 * half_m / static_cast<double>(kCore);
  const double tail_step_m = kTailLength * model.late_scale_m / static_cast<double>(kTail);
  core_begin_m_ = static_cast<float>(-half_m);
  core_nodes_per_m_ = static_cast<float>(1.0 / core_step_m);
  tail_begin_m_ = static_cast<float>(half_m);
  tail_nodes_per_m_ = static_cast<float>(1.0 / tail_step_m);
  // The ends hold the density far away, and errors beyond them stay there.
  nodes_.fill(static_cast<float>(GrossErrorDensity()));
  constexpr int kCoreSteps = static_cast<int>(kCore);
  for (int i = 1; i < kSteps; ++i) {
    const double error_m =
        i < kCoreSteps ? -half_m + i * core_step_m : half_m + (i - kCoreSteps) * tail_step_m;
    nodes_[static_cast<std::size_t>(i)] = static_cast<float>(RangeErrorDensity(model, error_m));
  }
}

}  // namespace lodemark
