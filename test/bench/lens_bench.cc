// Undistortion of 100,000 points spread over the image, ours beside OpenCV's undistortPoints with
// its default stopping rule. off is the share of points whose round
// trip misses by more than 1e-9 px (ours) or 0.01 px (OpenCV), without being refused.
#include <benchmark/benchmark.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/camera/lens.h"

namespace {

using lodemark::Lens;
using lodemark::LensModel;
using lodemark::LensParameters;

constexpr std::size_t kPoints = 100'000;
constexpr double kOff_px = 0.01;

LensParameters Parameters(LensModel model, double f_px, std::initializer_list<double> values) {
  LensParameters p;
  p.model = model;
  p.width_px = 1000;
  p.height_px = 700;
  p.fx_px = f_px;
  p.fy_px = f_px;
  p.cx_px = 505.0;
  p.cy_px = 340.0;
  std::copy(values.begin(), values.end(), p.coefficients.begin());
  return p;
}

const LensParameters kRadial = Parameters(LensModel::kBrown, 800.0, {-0.28, 0.09});
const LensParameters kBrown =
    Parameters(LensModel::kBrown, 800.0, {-0.266, -0.0386, 1.78e-3, -2.8e-4, 0.238});
const LensParameters kWide = Parameters(LensModel::kBrown, 400.0, {-0.3, 0.08});
const LensParameters kRational =
    Parameters(LensModel::kBrown, 400.0, {0.9, 0.2, 1e-4, 2e-4, 0.01, 1.25, 0.45, 0.05});
const LensParameters kFisheye =
    Parameters(LensModel::kFisheye, 320.0, {-0.02, 0.006, -0.004, 0.0005});
const LensParameters kThinPrism = Parameters(LensModel::kThinPrismFisheye, 320.0,
                                             {-0.02, 0.005, 1e-3, -2e-3, 1e-3, -2e-4, 3e-3, -1e-3});

// The plastic sequence of Roberts: even over the image, in no order that a cache would like.
std::vector<Eigen::Vector2d> Pixels(const LensParameters& p) {
  std::vector<Eigen::Vector2d> pixels;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double n = static_cast<double>(i);
    const double x = n * 0.7548776662466927;
    const double y = n * 0.5698402909980532;
    pixels.emplace_back((x - std::floor(x)) * p.width_px, (y - std::floor(y)) * p.height_px);
  }
  return pixels;
}

void SetPointRate(benchmark::State& state) {
  state.counters["per_point"] =
      benchmark::Counter(static_cast<double>(kPoints) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void Ours(benchmark::State& state, const LensParameters& parameters) {
  const auto lens = Lens::Create(parameters);
  const std::vector<Eigen::Vector2d> pixels = Pixels(parameters);
  std::vector<Eigen::Vector3d> bearings(kPoints);
  std::vector<std::uint8_t> valid(kPoints);
  for (auto _ : state) {
    benchmark::DoNotOptimize(lens->Unproject(pixels, bearings, valid));
    benchmark::ClobberMemory();
  }
  SetPointRate(state);
  double off = 0.0;
  double refused = 0.0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    refused += valid[i] == 0 ? 1.0 : 0.0;
    if (valid[i] != 0 && !((*lens->Project(bearings[i]) - pixels[i]).norm() < 1e-9)) off += 1.0;
  }
  state.counters["off"] = off / kPoints;
  state.counters["refused"] = refused / kPoints;
}

void OpenCv(benchmark::State& state, const LensParameters& parameters) {
  const std::vector<Eigen::Vector2d> pixels = Pixels(parameters);
  std::vector<cv::Point2d> distorted;
  for (const Eigen::Vector2d& pixel : pixels) distorted.emplace_back(pixel.x(), pixel.y());
  const cv::Matx33d matrix(parameters.fx_px, 0.0, parameters.cx_px, 0.0, parameters.fy_px,
                           parameters.cy_px, 0.0, 0.0, 1.0);
  const auto& k = parameters.coefficients;
  const bool is_fisheye = parameters.model == LensModel::kFisheye;
  const std::vector<double> coefficients(k.begin(), k.begin() + (is_fisheye ? 4 : 8));
  std::vector<cv::Point2d> straight;
  cv::setNumThreads(1);
  for (auto _ : state) {
    if (is_fisheye) {
      cv::fisheye::undistortPoints(distorted, straight, matrix, coefficients);
    } else {
      cv::undistortPoints(distorted, straight, matrix, coefficients);
    }
    benchmark::ClobberMemory();
  }
  SetPointRate(state);
  std::vector<cv::Point3d> points;
  for (const cv::Point2d& point : straight) points.emplace_back(point.x, point.y, 1.0);
  std::vector<cv::Point2d> again;
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  if (is_fisheye) {
    cv::fisheye::projectPoints(points, again, zero, zero, matrix, coefficients);
  } else {
    cv::projectPoints(points, zero, zero, matrix, coefficients, again);
  }
  double off = 0.0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (!(cv::norm(again[i] - distorted[i]) < kOff_px)) off += 1.0;
  }
  state.counters["off"] = off / kPoints;
}

// Projection with all derivatives, as an adjustment asks for it.
void ProjectWithDerivatives(benchmark::State& state, const LensParameters& parameters) {
  const auto lens = Lens::Create(parameters);
  const std::vector<Eigen::Vector2d> pixels = Pixels(parameters);
  std::vector<Eigen::Vector3d> bearings(kPoints);
  std::vector<std::uint8_t> valid(kPoints);
  lens->Unproject(pixels, bearings, valid);
  lodemark::ProjectionJacobian jacobian;
  for (auto _ : state) {
    for (const Eigen::Vector3d& bearing : bearings) {
      benchmark::DoNotOptimize(lens->Project(bearing, &jacobian));
      benchmark::DoNotOptimize(jacobian);
    }
  }
  SetPointRate(state);
}

BENCHMARK_CAPTURE(Ours, radial, kRadial)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OpenCv, radial, kRadial)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ours, brown, kBrown)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OpenCv, brown, kBrown)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ours, wide, kWide)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OpenCv, wide, kWide)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ours, rational, kRational)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OpenCv, rational, kRational)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ours, fisheye, kFisheye)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OpenCv, fisheye, kFisheye)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Ours, thin_prism, kThinPrism)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ProjectWithDerivatives, brown, kBrown)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ProjectWithDerivatives, fisheye, kFisheye)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
