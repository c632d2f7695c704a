#include "core/fusion/density_table.h"

#include <cmath>

#include "core/fusion/range_error.h"

namespace lodemark {
namespace {

constexpr double kHalfCore = 6.0;    // sigma
constexpr double kTailLength = 6.0;  // late scales

// A step over a quarter sigma, in late scales, up to which Simpson's rule gives the late part to a
// relative 4e-4.
constexpr double kLongestStep = 1.0;

// The standard normal density every eighth of a sigma from -6 to 6.
constexpr int kNormalNodes = 97;
constexpr std::array<double, kNormalNodes> StandardNormal() {
  constexpr double kInverseSqrtTwoPi = 0.3989422804014327;
  // exp(-(u + h)^2 / 2) = exp(-u^2 / 2) exp(-u h) exp(-h^2 / 2), h = 1 / 8.
  constexpr double kExpHalfSquare = 0.9922179382602435;  // exp(-1 / 128)
  constexpr double kExpSquare = 0.9844964370054085;      // exp(-1 / 64)
  std::array<double, kNormalNodes> nodes = {};
  constexpr std::size_t kMiddle = kNormalNodes / 2;
  double density = kInverseSqrtTwoPi;
  double factor = kExpHalfSquare;
  for (std::size_t i = 0; i <= kMiddle; ++i) {
    nodes[kMiddle - i] = nodes[kMiddle + i] = density;
    density *= factor;
    factor *= kExpSquare;
  }
  return nodes;
}
constexpr std::array<double, kNormalNodes> kNormal = StandardNormal();

}  // namespace

void DensityTable::Fill(const RangeErrorModel& model) {
  const double half_m = kHalfCore * model.sigma_m;
  const double core_step_m = 2.0 * half_m / kCoreSteps;
  const double tail_step_m = kTailLength * model.late_scale_m / kTailSteps;
  core_begin_m_ = static_cast<float>(-half_m);
  core_nodes_per_m_ = static_cast<float>(1.0 / core_step_m);
  tail_begin_m_ = static_cast<float>(half_m);
  tail_nodes_per_m_ = static_cast<float>(1.0 / tail_step_m);
  // The ends hold the density far away, and errors beyond them stay there.
  const double gross_pm = GrossErrorDensity();
  nodes_.front() = nodes_[kSteps] = nodes_[kSteps + 1] = static_cast<float>(gross_pm);

  const double step = core_step_m / model.late_scale_m;
  if (step > kLongestStep) {
    for (int i = 1; i < kSteps; ++i) {
      const double error_m =
          i < kCoreSteps ? -half_m + i * core_step_m : half_m + (i - kCoreSteps) * tail_step_m;
      nodes_[static_cast<std::size_t>(i)] = static_cast<float>(RangeErrorDensity(model, error_m));
    }
    return;
  }
  // The late part L is the normal core run through an exponential decay, L' = (normal - L) / scale,
  // so each node follows from the one before: what is left of L, and what came in meanwhile.
  const double late_pm = model.late_probability / model.sigma_m;
  const double core_pm = (1.0 - GrossErrorProbability() - model.late_probability) / model.sigma_m;
  const double root = std::exp(-0.5 * step);
  const double left = root * root;
  std::array<double, kCoreSteps> came_in;
  for (std::size_t i = 0; i < kCoreSteps; ++i) {
    came_in[i] =
        step / 6.0 * (left * kNormal[2 * i] + 4.0 * root * kNormal[2 * i + 1] + kNormal[2 * i + 2]);
  }
  double late = 0.0;  // nothing yet at -6 sigma
  std::array<double, kCoreSteps> late_at;
  for (std::size_t i = 0; i < kCoreSteps; ++i) late_at[i] = late = left * late + came_in[i];
  for (std::size_t i = 1; i <= kCoreSteps; ++i) {
    nodes_[i] = static_cast<float>(core_pm * kNormal[2 * i] + late_pm * late_at[i - 1] + gross_pm);
  }
  // Beyond 6 sigma nothing comes in.
  constexpr double kLeft = 0.8464817248906141;  // exp(-kTailLength / kTailSteps)
  for (std::size_t i = kCoreSteps + 1; i < kSteps; ++i) {
    late *= kLeft;
    nodes_[i] = static_cast<float>(late_pm * late + gross_pm);
  }
}

}  // namespace lodemark
