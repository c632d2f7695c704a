#include "core/resection/shared_errors.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace lodemark {
namespace {

// Cells across and down the image, finer where there are many sights; and the fewest sights and
// cells in use that tell anything.
struct Grid {
  int across = 6;
  int down = 4;
};
constexpr Grid kFine = {8, 6};
constexpr int kManySights = 400;
constexpr std::size_t kFewestSights = 60;
constexpr std::size_t kFewestCells = 8;
constexpr Eigen::Index kFewestLeft = 6;

// Reaches, relative to how far the landmarks spread.
constexpr std::array<double, 3> kReaches = {0.3, 1.0, 3.0};

// Squares of sigma that are weighed, relative to what the field must have to show as much as the
// noise of the cells' means.
constexpr double kLeastShare = 0.01;
constexpr double kMostShare = 100.0;
constexpr int kShares = 17;

// How many times as likely as any field it is beforehand that there is none.
constexpr double kNoneBeforehand = 20.0;

// The sights of one cell of the image, as one: sums weighted by the inverse of their covariances,
// then the means.
struct Cell {
  Eigen::Matrix2d weight = Eigen::Matrix2d::Zero();
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> by_pose = Eigen::Matrix<double, 2, 6>::Zero();
  Eigen::Matrix<double, 2, 3> by_landmark = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, kMostIntrinsics> by_lens =
      Eigen::Matrix<double, 2, kMostIntrinsics>::Zero();
  Eigen::Vector3d landmark = Eigen::Vector3d::Zero();
  double squares = 0.0;  // of the sights' residuals in sigmas
  double sights = 0.0;
};

struct Cells {
  std::vector<Cell> used;
  double sights = 0.0;
  double squares_within = 0.0;  // about the cells' means
};

Cells CellsOf(const CameraPose& pose, std::span<const LandmarkSight> sights,
              std::span<const std::uint8_t> is_used, const Lens& lens, double noise_px,
              bool with_lens) {
  const auto count = std::count(is_used.begin(), is_used.end(), std::uint8_t{1});
  const Grid grid = count < kManySights ? Grid() : kFine;
  std::vector<Cell> all(static_cast<std::size_t>(grid.across * grid.down));
  LinearSight linear;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (is_used[i] == 0 || !Linearise(sights[i], pose, lens, &linear)) continue;
    const auto index = [](double pixel, int size_px, int cells) {
      return static_cast<std::size_t>(
          std::clamp(std::floor(pixel * cells / std::max(size_px, 1)), 0.0, cells - 1.0));
    };
    Cell& cell = all[index(sights[i].pixel.y(), lens.parameters().height_px, grid.down) *
                         static_cast<std::size_t>(grid.across) +
                     index(sights[i].pixel.x(), lens.parameters().width_px, grid.across)];
    const Eigen::Matrix2d weight =
        PixelCovariance(sights[i], linear.by_landmark, noise_px).inverse();
    const Eigen::Vector2d weighted = weight * linear.residual_px;
    cell.weight += weight;
    cell.residual += weighted;
    cell.by_pose.noalias() += weight * linear.by_pose;
    cell.by_landmark.noalias() += weight * linear.by_landmark;
    if (with_lens) cell.by_lens.noalias() += weight * linear.by_intrinsics;
    cell.landmark += sights[i].landmark_in_enu_m;
    cell.squares += weighted.dot(linear.residual_px);
    cell.sights += 1.0;
  }
  Cells cells;
  for (Cell& cell : all) {
    if (cell.sights == 0.0) continue;
    const Eigen::Matrix2d covariance = cell.weight.inverse();
    cells.squares_within += cell.squares - cell.residual.dot(covariance * cell.residual);
    cells.sights += cell.sights;
    cell.residual = covariance * cell.residual;
    cell.by_pose = covariance * cell.by_pose;
    cell.by_landmark = covariance * cell.by_landmark;
    cell.by_lens = covariance * cell.by_lens;
    cell.landmark /= cell.sights;
    cells.used.push_back(cell);
  }
  return cells;
}

// Root mean square distance from the mean.
double SpreadOf(const std::vector<Cell>& cells) {
  const double share = 1.0 / static_cast<double>(cells.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Cell& cell : cells) mean += share * cell.landmark;
  double square = 0.0;
  for (const Cell& cell : cells) square += share * (cell.landmark - mean).squaredNorm();
  return std::sqrt(square);
}

// Rows divided by the noise of the cells' means: with L L' the weight of one, L' times it.
struct WhiteRows {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_pose;
  Eigen::MatrixXd by_landmark;
  Eigen::MatrixXd by_lens;
};

WhiteRows Whitened(const std::vector<Cell>& cells) {
  const auto rows = static_cast<Eigen::Index>(2 * cells.size());
  WhiteRows white{Eigen::VectorXd(rows), Eigen::MatrixXd(rows, 6), Eigen::MatrixXd(rows, 3),
                  Eigen::MatrixXd(rows, kMostIntrinsics)};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(2 * k);
    const Eigen::LLT<Eigen::Matrix2d> factor(cells[k].weight);
    const Eigen::Matrix2d root = factor.matrixU();
    white.residual.segment<2>(row) = root * cells[k].residual;
    white.by_pose.middleRows<2>(row) = root * cells[k].by_pose;
    white.by_landmark.middleRows<2>(row) = root * cells[k].by_landmark;
    white.by_lens.middleRows<2>(row) = root * cells[k].by_lens;
  }
  return white;
}

// Covariance of the rows where the field's sigma is 1.
Eigen::MatrixXd FieldOf(const std::vector<Cell>& cells, const WhiteRows& white, double reach_m) {
  Eigen::MatrixXd field = white.by_landmark * white.by_landmark.transpose();
  for (std::size_t a = 0; a < cells.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double distance = (cells[a].landmark - cells[b].landmark).norm() / reach_m;
      const double alike = std::exp(-0.5 * distance * distance);
      const auto row = static_cast<Eigen::Index>(2 * a);
      const auto column = static_cast<Eigen::Index>(2 * b);
      field.block<2, 2>(row, column) *= alike;
      field.block<2, 2>(column, row) *= alike;
    }
  }
  return field;
}

// Of a tridiagonal covariance 1 + square * (diagonal, beside): logarithm of the likelihood of rows.
double LogLikelihood(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside,
                     const Eigen::VectorXd& rows, double square, double noise) {
  double log_likelihood = 0.0;
  double pivot = 0.0;
  double reduced = 0.0;
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    const double factor = k > 0 ? square * beside[k - 1] / pivot : 0.0;
    reduced = rows[k] - factor * reduced;
    pivot = noise + square * diagonal[k] - (k > 0 ? factor * square * beside[k - 1] : 0.0);
    if (!(pivot > 0.0)) return -1e300;
    log_likelihood -= 0.5 * (std::log(pivot) + reduced * reduced / pivot);
  }
  return log_likelihood;
}

}  // namespace

SharedErrors FindSharedErrors(const CameraPose& pose, std::span<const LandmarkSight> sights,
                              std::span<const std::uint8_t> is_used, const Lens& lens,
                              double noise_px, const Matrix6d& pose_covariance,
                              const std::optional<IntrinsicsCovariance>& intrinsics) {
  SharedErrors shared;
  const Cells cells = CellsOf(pose, sights, is_used, lens, noise_px, intrinsics.has_value());
  if (cells.sights < static_cast<double>(kFewestSights) || cells.used.size() < kFewestCells) {
    return shared;
  }
  const double spread_m = SpreadOf(cells.used);
  const double within = 2.0 * (cells.sights - static_cast<double>(cells.used.size()));
  const double noise = std::clamp(cells.squares_within / std::max(within, 1.0), 0.1, 1.5);
  const WhiteRows white = Whitened(cells.used);
  if (!(spread_m > 0.0) || !white.by_pose.allFinite()) return shared;
  // What the lens may err by is no error of the landmarks.
  Eigen::MatrixXd unknowns = white.by_pose;
  for (Eigen::Index k = 0; intrinsics && k < kMostIntrinsics; ++k) {
    if (!((*intrinsics)(k, k) > 0.0) || !(white.by_lens.col(k).norm() > 0.0)) continue;
    unknowns.conservativeResize(Eigen::NoChange, unknowns.cols() + 1);
    unknowns.rightCols<1>() = white.by_lens.col(k);
  }
  const Eigen::Index left = white.residual.size() - unknowns.cols();
  if (left < kFewestLeft) return shared;
  const Eigen::VectorXd lengths = unknowns.colwise().norm();
  const Eigen::HouseholderQR<Eigen::MatrixXd> pose_out(unknowns *
                                                       lengths.cwiseInverse().asDiagonal());
  const Eigen::VectorXd turned = pose_out.householderQ().adjoint() * white.residual;

  // Every sigma and reach.
  struct Weighed {
    double log_likelihood = 0.0;
    double square_m2 = 0.0;
    std::size_t reach = 0;
  };
  std::vector<Weighed> all;
  all.reserve(kReaches.size() * kShares);
  std::array<Matrix6d, kReaches.size()> of_pose;
  double likeliest = -1e300;
  for (std::size_t reach = 0; reach < kReaches.size(); ++reach) {
    const Eigen::MatrixXd field = FieldOf(cells.used, white, kReaches[reach] * spread_m);
    const Eigen::MatrixXd into_pose = pose_covariance * white.by_pose.transpose();
    of_pose[reach] = into_pose * field * into_pose.transpose();
    const Eigen::MatrixXd half = pose_out.householderQ().adjoint() * field;
    const Eigen::MatrixXd turned_field =
        (pose_out.householderQ().adjoint() * half.transpose()).bottomRightCorner(left, left);
    const Eigen::Tridiagonalization<Eigen::MatrixXd> bands(turned_field);
    const Eigen::VectorXd diagonal = bands.diagonal();
    const Eigen::VectorXd beside = bands.subDiagonal();
    const Eigen::VectorXd rows = bands.matrixQ().adjoint() * turned.tail(left);
    const double unit = noise * static_cast<double>(left) / std::max(diagonal.sum(), 1e-300);
    for (int k = 0; k < kShares; ++k) {
      const double share =
          kLeastShare * std::pow(kMostShare / kLeastShare, static_cast<double>(k) / (kShares - 1));
      const Weighed each = {LogLikelihood(diagonal, beside, rows, share * unit, noise),
                            share * unit, reach};
      likeliest = std::max(likeliest, each.log_likelihood);
      all.push_back(each);
    }
  }
  const double none = LogLikelihood(Eigen::VectorXd::Zero(left), Eigen::VectorXd::Zero(left - 1),
                                    turned.tail(left), 0.0, noise);
  likeliest = std::max(likeliest, none);
  double sum = kNoneBeforehand * static_cast<double>(all.size()) * std::exp(none - likeliest);
  for (const Weighed& each : all) sum += std::exp(each.log_likelihood - likeliest);
  double square_m2 = 0.0;
  for (const Weighed& each : all) {
    const double weight = std::exp(each.log_likelihood - likeliest) / sum;
    square_m2 += weight * each.square_m2;
    shared.of_pose += weight * each.square_m2 * of_pose[each.reach];
  }
  if (!shared.of_pose.allFinite()) return {};
  shared.of_pose = (0.5 * (shared.of_pose + shared.of_pose.transpose())).eval();
  shared.sigma_m = std::sqrt(square_m2);
  return shared;
}

}  // namespace lodemark
