#include "core/fusion/weighted_samples.h"

#include <algorithm>
#include <cstring>

namespace lodemark {
namespace {

// One source, compiled for any processor and for those with AVX2. Without contraction and without
// reordering, both round alike.
#if defined(__x86_64__) && defined(__GNUC__)
#define LODEMARK_WIDE __attribute__((target("avx2")))
#define LODEMARK_INLINE inline __attribute__((always_inline))
bool HasWideVectors() { return __builtin_cpu_supports("avx2") != 0; }
#else
#define LODEMARK_WIDE
#define LODEMARK_INLINE inline
bool HasWideVectors() { return false; }
#endif

constexpr std::size_t kLanes = WeightedSamples::kLanes;

struct Points {
  const float* z0;
  const float* z1;
  const float* z2;
  const float* z3;
  std::size_t count;  // a multiple of kLanes
};

LODEMARK_INLINE void MultiplyLoop(const DensityTable& density, float constant, const float* slope,
                                  const Points& points, double* weights) {
  const DensityTable table = density;  // nothing written below changes it
  const float s0 = slope[0];
  const float s1 = slope[1];
  const float s2 = slope[2];
  const float s3 = slope[3];
  for (std::size_t k = 0; k < points.count; ++k) {
    const float error_m =
        constant + s0 * points.z0[k] + s1 * points.z1[k] + s2 * points.z2[k] + s3 * points.z3[k];
    weights[k] *= static_cast<double>(table(error_m));
  }
}

// Four samples at a time, whatever the processor: the order in which sums are taken is part of the
// result.
using Floats = float __attribute__((vector_size(4 * sizeof(float))));
using Doubles = double __attribute__((vector_size(4 * sizeof(double))));

LODEMARK_INLINE Doubles Load(const float* from) {
  Floats values;
  std::memcpy(&values, from, sizeof values);
  return __builtin_convertvector(values, Doubles);
}

// totals: the weights, their squares, w z for four, w z z' for ten, row by row.
constexpr std::size_t kTotals = 16;
LODEMARK_INLINE void SumLoop(const Points& points, const double* weights, double* totals) {
  Doubles sums[kTotals] = {};
  for (std::size_t k = 0; k < points.count; k += kLanes) {
    Doubles w;
    std::memcpy(&w, weights + k, sizeof w);
    const Doubles z[4] = {Load(points.z0 + k), Load(points.z1 + k), Load(points.z2 + k),
                          Load(points.z3 + k)};
    sums[0] += w;
    sums[1] += w * w;
    std::size_t next = 6;
    for (std::size_t a = 0; a < 4; ++a) {
      const Doubles wz = w * z[a];
      sums[2 + a] += wz;
      for (std::size_t b = a; b < 4; ++b) sums[next++] += wz * z[b];
    }
  }
  for (std::size_t i = 0; i < kTotals; ++i) {
    totals[i] = (sums[i][0] + sums[i][2]) + (sums[i][1] + sums[i][3]);
  }
}

LODEMARK_WIDE void MultiplyWide(const DensityTable& density, float constant, const float* slope,
                                const Points& points, double* weights) {
  MultiplyLoop(density, constant, slope, points, weights);
}

void MultiplyAnywhere(const DensityTable& density, float constant, const float* slope,
                      const Points& points, double* weights) {
  MultiplyLoop(density, constant, slope, points, weights);
}

LODEMARK_WIDE void SumWide(const Points& points, const double* weights, double* totals) {
  SumLoop(points, weights, totals);
}

void SumAnywhere(const Points& points, const double* weights, double* totals) {
  SumLoop(points, weights, totals);
}

}  // namespace

WeightedSamples::WeightedSamples(int count) : wide_(HasWideVectors()) {
  const std::size_t rounded = (static_cast<std::size_t>(count) + kLanes - 1) / kLanes * kLanes;
  for (std::vector<float>& coordinates : points_) coordinates.resize(rounded);
  weights_.resize(rounded);
}

void WeightedSamples::SetPoint(std::size_t k, const Eigen::Vector4d& point) {
  for (std::size_t i = 0; i < 4; ++i) {
    points_[i][k] = static_cast<float>(point[static_cast<Eigen::Index>(i)]);
  }
}

void WeightedSamples::Multiply(const DensityTable& density, float constant,
                               const Eigen::Vector4f& slope) {
  const Points points = {points_[0].data(), points_[1].data(), points_[2].data(), points_[3].data(),
                         count()};
  (wide_ ? MultiplyWide : MultiplyAnywhere)(density, constant, slope.data(), points,
                                            weights_.data());
}

void WeightedSamples::Normalise() {
  const double largest = *std::max_element(weights_.begin(), weights_.end());
  const double factor = 1.0 / largest;
  for (double& weight : weights_) weight *= factor;
}

WeightedSums WeightedSamples::Sum() const {
  const Points points = {points_[0].data(), points_[1].data(), points_[2].data(), points_[3].data(),
                         count()};
  double totals[kTotals];
  (wide_ ? SumWide : SumAnywhere)(points, weights_.data(), totals);
  WeightedSums sums;
  sums.weights = totals[0];
  sums.squared_weights = totals[1];
  std::size_t next = 2;
  for (int a = 0; a < 4; ++a) sums.first[a] = totals[next++];
  for (int a = 0; a < 4; ++a) {
    for (int b = a; b < 4; ++b) sums.second(a, b) = sums.second(b, a) = totals[next++];
  }
  return sums;
}

}  // namespace lodemark
