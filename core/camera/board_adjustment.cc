#include "core/camera/board_adjustment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lodemark {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kLeastNoise_px = 1e-4;  // corners are stored as floats of some hundred pixels
constexpr int kMostRescalings = 5;
constexpr double kSameScale = 0.01;  // relative change of the noise that moves nothing
constexpr double kSmallestGain = 1e-11;
constexpr double kMostDamping = 1e12;
// Smallest eigenvalue of the normal equations, scaled to a unit diagonal, that still is one.
constexpr double kLeastEigenvalue = 1e-13;
// Sigmas by which views must disagree before it is believed.
constexpr double kSignificantScatter = 3.0;
// Median of the length of a vector of two standard normal coordinates.
const double kMedianLength = std::sqrt(2.0 * std::log(2.0));

// The normal equations of one board.
struct BoardBlock {
  Matrix6d pose;
  Eigen::Matrix<double, 6, Eigen::Dynamic> cross;  // pose by lens
  Vector6d pose_gradient;
  Eigen::MatrixXd lens;
  Eigen::VectorXd lens_gradient;
};

Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// Turned by a rotation vector in camera axes, then moved.
Rigid3 Moved(const Rigid3& pose, const Vector6d& step) {
  const Eigen::Vector3d turn = step.head<3>();
  const double angle = turn.norm();
  const Eigen::Quaterniond rotation =
      angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))
                  : Eigen::Quaterniond::Identity();
  return {rotation * pose.rotation(), pose.translation() + step.tail<3>()};
}

double* IntrinsicAt(int index, LensParameters* lens) {
  switch (index) {
    case 0:
      return &lens->fx_px;
    case 1:
      return &lens->fy_px;
    case 2:
      return &lens->cx_px;
    case 3:
      return &lens->cy_px;
    default:
      return &lens->coefficients[static_cast<std::size_t>(index - 4)];
  }
}

class Adjustment {
 public:
  Adjustment(LensAndBoards start, std::span<const BoardView* const> views, const LensForm& form,
             const BoardAdjustmentOptions& options)
      : views_(views), options_(options), state_(std::move(start)), blocks_(views.size()) {
    state_.lens.model = form.model;
    if (!options.lens_is_known) {
      columns_ = {0, 1, 2, 3};
      for (int i = 0; i < CoefficientCount(form.model); ++i) {
        if (IsFree(form, i)) columns_.push_back(4 + i);
      }
    }
    for (const BoardView* view : views) corners_ += view->corners.size();
  }

  std::optional<BoardAdjustment> Run() {
    const std::size_t unknowns = columns_.size() + 6 * views_.size();
    if (2 * corners_ <= unknowns) return std::nullopt;
    if (!FillResiduals(state_, &residuals_)) return std::nullopt;
    bool converged = false;
    double scale_px = MedianScale();
    for (int i = 0; i < kMostRescalings; ++i) {
      kernel_px_ = options_.kernel_sigmas * scale_px;
      converged = Descend();
      const double previous_px = scale_px;
      scale_px = MedianScale();
      if (std::abs(scale_px - previous_px) <= kSameScale * previous_px) break;
    }
    return Conclude(converged, unknowns);
  }

 private:
  using Residuals = std::vector<std::vector<Eigen::Vector2d>>;

  bool FillResiduals(const LensAndBoards& state, Residuals* residuals) const {
    const Result<Lens> lens = Lens::Create(state.lens);
    if (!lens) return false;
    residuals->resize(views_.size());
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const Eigen::Matrix3d rotation = state.camera_from_board[i].rotation().toRotationMatrix();
      auto& own = (*residuals)[i];
      own.clear();
      for (const BoardCorner& corner : views_[i]->corners) {
        const auto pixel = lens->Project(rotation.leftCols<2>() * corner.board_m +
                                         state.camera_from_board[i].translation());
        if (!pixel) return false;
        own.push_back(corner.pixel - *pixel);
      }
    }
    return true;
  }

  double MedianScale() const {
    std::vector<double> lengths_px;
    lengths_px.reserve(corners_);
    for (const auto& own : residuals_) {
      for (const Eigen::Vector2d& residual : own) lengths_px.push_back(residual.norm());
    }
    const auto middle = lengths_px.begin() + static_cast<std::ptrdiff_t>(lengths_px.size() / 2);
    std::nth_element(lengths_px.begin(), middle, lengths_px.end());
    return std::max(*middle / kMedianLength, kLeastNoise_px);
  }

  double WeightOf(const Eigen::Vector2d& residual) const {
    const double length_px = residual.norm();
    return length_px <= kernel_px_ ? 1.0 : kernel_px_ / length_px;
  }

  double CostOf(const Residuals& residuals) const {
    double cost = 0.0;
    for (const auto& own : residuals) {
      for (const Eigen::Vector2d& residual : own) {
        const double length_px = residual.norm();
        cost += length_px <= kernel_px_ ? 0.5 * length_px * length_px
                                        : kernel_px_ * (length_px - 0.5 * kernel_px_);
      }
    }
    return cost;
  }

  void Linearise() {
    const Result<Lens> lens = Lens::Create(state_.lens);
    const auto count = static_cast<Eigen::Index>(columns_.size());
    ProjectionJacobian jacobian;
    Eigen::MatrixXd rows;
    Eigen::VectorXd right;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const auto& corners = views_[i]->corners;
      rows.resize(2 * static_cast<Eigen::Index>(corners.size()), 6 + count);
      right.resize(rows.rows());
      const Eigen::Matrix3d rotation = state_.camera_from_board[i].rotation().toRotationMatrix();
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Eigen::Vector3d turned = rotation.leftCols<2>() * corners[k].board_m;
        const auto pixel =
            lens->Project(turned + state_.camera_from_board[i].translation(), &jacobian);
        const auto row = 2 * static_cast<Eigen::Index>(k);
        if (!pixel) {  // the residuals were computed here, so this does not happen
          rows.middleRows<2>(row).setZero();
          right.segment<2>(row).setZero();
          continue;
        }
        const double root = std::sqrt(WeightOf(residuals_[i][k]));
        rows.block<2, 3>(row, 0) = -root * jacobian.by_point * Cross(turned);
        rows.block<2, 3>(row, 3) = root * jacobian.by_point;
        for (Eigen::Index c = 0; c < count; ++c) {
          rows.block<2, 1>(row, 6 + c) =
              root * jacobian.by_intrinsics.col(columns_[static_cast<std::size_t>(c)]);
        }
        right.segment<2>(row) = root * residuals_[i][k];
      }
      BoardBlock& block = blocks_[i];
      block.pose.noalias() = rows.leftCols<6>().transpose() * rows.leftCols<6>();
      block.cross.noalias() = rows.leftCols<6>().transpose() * rows.rightCols(count);
      block.lens.noalias() = rows.rightCols(count).transpose() * rows.rightCols(count);
      block.pose_gradient.noalias() = rows.leftCols<6>().transpose() * right;
      block.lens_gradient.noalias() = rows.rightCols(count).transpose() * right;
    }
  }

  // Normal equations of the lens alone, the poses eliminated, with the diagonals raised.
  void Reduce(double damping, Eigen::MatrixXd* matrix, Eigen::VectorXd* right) const {
    const auto count = static_cast<Eigen::Index>(columns_.size());
    matrix->setZero(count, count);
    right->setZero(count);
    for (const BoardBlock& block : blocks_) {
      *matrix += block.lens;
      *right += block.lens_gradient;
    }
    matrix->diagonal() *= 1.0 + damping;
    for (const BoardBlock& block : blocks_) {
      const Eigen::LDLT<Matrix6d> pose = FactorOf(block, damping);
      *matrix -= block.cross.transpose() * pose.solve(block.cross);
      *right -= block.cross.transpose() * pose.solve(block.pose_gradient);
    }
  }

  static Eigen::LDLT<Matrix6d> FactorOf(const BoardBlock& block, double damping) {
    Matrix6d pose = block.pose;
    pose.diagonal() *= 1.0 + damping;
    return pose.ldlt();
  }

  std::optional<LensAndBoards> Step(double damping) const {
    LensAndBoards next = state_;
    Eigen::VectorXd lens_step = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns_.size()));
    if (!columns_.empty()) {
      Eigen::MatrixXd matrix;
      Eigen::VectorXd right;
      Reduce(damping, &matrix, &right);
      // Of unit diagonal, because focal lengths and coefficients differ by many powers of ten.
      const Eigen::VectorXd scale = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
      lens_step = scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(right)));
      if (!lens_step.allFinite()) return std::nullopt;
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        *IntrinsicAt(columns_[c], &next.lens) += lens_step[static_cast<Eigen::Index>(c)];
      }
    }
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const Vector6d step = FactorOf(blocks_[i], damping)
                                .solve(blocks_[i].pose_gradient - blocks_[i].cross * lens_step);
      if (!step.allFinite()) return std::nullopt;
      next.camera_from_board[i] = Moved(state_.camera_from_board[i], step);
    }
    return next;
  }

  // Whether it came to rest.
  bool Descend() {
    double damping = 1e-3;
    double cost = CostOf(residuals_);
    Residuals next_residuals;
    for (int iteration = 0; iteration < options_.most_iterations; ++iteration) {
      Linearise();
      bool is_better = false;
      double gain = 0.0;
      while (!is_better && damping < kMostDamping) {
        const std::optional<LensAndBoards> next = Step(damping);
        if (next && FillResiduals(*next, &next_residuals)) {
          const double next_cost = CostOf(next_residuals);
          if (next_cost < cost) {
            gain = cost - next_cost;
            cost = next_cost;
            state_ = *next;
            residuals_.swap(next_residuals);
            is_better = true;
            damping = std::max(damping * 0.1, 1e-12);
            break;
          }
        }
        damping *= 10.0;
      }
      if (!is_better) return true;
      if (gain <= kSmallestGain * cost) return true;
    }
    return false;
  }

  BoardAdjustment Conclude(bool converged, std::size_t unknowns) {
    BoardAdjustment result;
    double squares = 0.0;
    double weighted = 0.0;
    for (const auto& own : residuals_) {
      for (const Eigen::Vector2d& residual : own) {
        squares += residual.squaredNorm();
        weighted += WeightOf(residual) * residual.squaredNorm();
      }
    }
    result.rms_px = std::sqrt(squares / static_cast<double>(corners_));
    result.noise_px = std::sqrt(weighted / static_cast<double>(2 * corners_ - unknowns));
    result.converged = converged;
    if (!columns_.empty()) FillCovariance(&result);
    result.estimate = std::move(state_);
    result.residuals_px = std::move(residuals_);
    return result;
  }

  void FillCovariance(BoardAdjustment* result) {
    Linearise();
    Eigen::MatrixXd matrix;
    Eigen::VectorXd right;
    Reduce(0.0, &matrix, &right);
    if (!(matrix.diagonal().minCoeff() > 0.0) || !matrix.allFinite()) return;
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    if (eigen.info() != Eigen::Success || !(eigen.eigenvalues()[0] > kLeastEigenvalue)) return;
    const Eigen::MatrixXd inverse =
        scale.asDiagonal() *
        (eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
         eigen.eigenvectors().transpose()) *
        scale.asDiagonal();
    const double variance = result->noise_px * result->noise_px;
    result->view_scatter = ViewScatter(inverse, variance);
    const Eigen::MatrixXd reduced = variance * result->view_scatter * inverse;
    const int size = 4 + CoefficientCount(state_.lens.model);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        const double value = reduced(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
        covariance(columns_[i], columns_[k]) = value;
        covariance(columns_[k], columns_[i]) = value;
      }
    }
    result->covariance = std::move(covariance);
  }

  // The pull of each view on the lens has the covariance of its share of the normal equations, if
  // the corners' errors are independent; this is the mean square of the pulls in that metric, less
  // the part that the adjustment itself took away.
  double ViewScatter(const Eigen::MatrixXd& inverse, double variance) const {
    double pulls = 0.0;
    double freedom = 0.0;
    double half_variance = 0.0;
    for (const BoardBlock& block : blocks_) {
      const Eigen::LDLT<Matrix6d> pose = block.pose.ldlt();
      const Eigen::VectorXd pull =
          block.lens_gradient - block.cross.transpose() * pose.solve(block.pose_gradient);
      const Eigen::MatrixXd share =
          inverse * (block.lens - block.cross.transpose() * pose.solve(block.cross));
      pulls += pull.dot(inverse * pull);
      const double square = (share * share).trace();
      freedom += share.trace() - square;
      half_variance += square;
    }
    if (!(freedom > 1.0) || !(variance > 0.0)) return 1.0;
    const double scatter = pulls / (variance * freedom);
    const double sigma = std::sqrt(2.0 * half_variance) / freedom;
    return scatter > 1.0 + kSignificantScatter * sigma ? scatter : 1.0;
  }

  std::span<const BoardView* const> views_;
  BoardAdjustmentOptions options_;
  LensAndBoards state_;
  std::vector<int> columns_;  // of the intrinsics that move
  std::vector<BoardBlock> blocks_;
  Residuals residuals_;
  std::size_t corners_ = 0;
  double kernel_px_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double RmsOf(std::span<const Eigen::Vector2d> residuals_px) {
  if (residuals_px.empty()) return 0.0;
  double squares = 0.0;
  for (const Eigen::Vector2d& residual : residuals_px) squares += residual.squaredNorm();
  return std::sqrt(squares / static_cast<double>(residuals_px.size()));
}

std::optional<BoardAdjustment> AdjustBoards(LensAndBoards start,
                                            std::span<const BoardView* const> views,
                                            const LensForm& form,
                                            const BoardAdjustmentOptions& options) {
  return Adjustment(std::move(start), views, form, options).Run();
}

}  // namespace lodemark
