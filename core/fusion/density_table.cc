#include "core/fusion/density_table.h"

#include "core/fusion/range_error.h"

namespace lodemark {
namespace {

constexpr double kHalfCore = 6.0;    // sigma
constexpr double kTailLength = 6.0;  // late scales
constexpr double kStep = 0.35;       // sigma, where the nodes suffice

}  // namespace

void DensityTable::Fill(const RangeErrorModel& model) {
  const double begin_m = -kHalfCore * model.sigma_m;
  const double span_m = 2.0 * kHalfCore * model.sigma_m + kTailLength * model.late_scale_m;
  const int count = static_cast<int>(std::clamp(span_m / (kStep * model.sigma_m),
                                                static_cast<double>(kFewestNodes),
                                                static_cast<double>(kMostNodes)));
  const double step_m = span_m / (count - 1);
  begin_m_ = static_cast<float>(begin_m);
  nodes_per_m_ = static_cast<float>(1.0 / step_m);
  // The ends hold the density far away, and errors beyond them stay there.
  const auto floor_pm = static_cast<float>(GrossErrorDensity());
  nodes_[0] = floor_pm;
  for (int i = 1; i < count - 1; ++i) {
    nodes_[static_cast<std::size_t>(i)] =
        static_cast<float>(RangeErrorDensity(model, begin_m + i * step_m));
  }
  nodes_[static_cast<std::size_t>(count) - 1] = floor_pm;
  nodes_[static_cast<std::size_t>(count)] = floor_pm;
  last_place_ = static_cast<float>(count - 1);
}

}  // namespace lodemark
