#include "core/fusion/inertial_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/rotation.h"

namespace lodemark {
namespace {

using Vector = Eigen::Matrix<double, 9, 1>;
using Matrix = Eigen::Matrix<double, 9, 9>;

constexpr std::size_t kMostStretches = 40;
constexpr std::size_t kFewestStretches = 8;

// What the biases of a phone's uncalibrated sensors usually are, 1 sigma an axis.
constexpr double kUsualTurnRateBias_radps = 0.02;
constexpr double kUsualForceBias_mps2 = 0.2;

constexpr double kSureHeading_rad = 10.0 * kRadiansPerDegree;
// How much less likely (-2 log) the opposite heading has to be.
constexpr double kOppositeExcluded = 30.0;
// What was felt is not what was moved.
constexpr double kMostStrain = 3.0;

constexpr int kIterations = 5;

// The stretches by what they make of attitude at the beginning and biases.
class Alignment {
 public:
  explicit Alignment(const std::vector<FeltStretch>& stretches) : stretches_(stretches) {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    Walk([&](const FeltStretch& stretch, const Eigen::Vector3d& felt, const Eigen::Matrix3d&,
             const Eigen::Matrix<double, 3, 6>&) {
      moment += Weight(stretch) * stretch.gained_in_ecef_mps * felt.transpose();
    });
    const Eigen::JacobiSVD<Eigen::Matrix3d> axes(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d handedness(1.0, 1.0, 1.0);
    handedness.z() = (axes.matrixU() * axes.matrixV().transpose()).determinant();
    attitude_ = axes.matrixU() * handedness.asDiagonal() * axes.matrixV().transpose();
  }

  // False where the equations have no solution.
  bool Refine() {
    for (int i = 0; i < kIterations; ++i) {
      Equations();
      const Eigen::LDLT<Matrix> factor(normal_);
      if (factor.info() != Eigen::Success) return false;
      const Vector step = factor.solve(right_);
      if (!step.allFinite()) return false;
      attitude_ = Turn(step.head<3>()) * attitude_;
      biases_ += step.tail<6>();
    }
    Equations();
    return true;
  }

  // Of all, in their variances; of the attitude turned by so much about an axis.
  double Cost(const Eigen::Quaterniond& turned) const {
    double cost = 0.0;
    Walk([&](const FeltStretch& stretch, const Eigen::Vector3d& felt, const Eigen::Matrix3d&,
             const Eigen::Matrix<double, 3, 6>&) {
      cost += Weight(stretch) *
              (stretch.gained_in_ecef_mps - turned * (attitude_ * felt)).squaredNorm();
    });
    return cost;
  }
  double Cost() const { return Cost(Eigen::Quaterniond::Identity()); }

  // At the end of the last stretch.
  InertialAlignmentResult Result() const {
    Chain chain;
    for (const FeltStretch& stretch : stretches_) chain.Append(stretch, biases_);
    InertialAlignmentResult result;
    result.ecef_from_sensor = (attitude_ * chain.turn).normalized();
    result.biases.turn_rate_radps = biases_.head<3>();
    result.biases.specific_force_mps2 = biases_.tail<3>();
    Matrix forward = Matrix::Identity();
    forward.block<3, 3>(0, 3) = attitude_.toRotationMatrix() * chain.by_turn_rate;
    result.covariance = forward * normal_.ldlt().solve(Matrix::Identity()) * forward.transpose();
    return result;
  }

 private:
  using Biases = Eigen::Matrix<double, 6, 1>;

  // How the sensor has turned since the beginning, and how that hangs on the turn rate's bias.
  struct Chain {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d by_turn_rate = Eigen::Matrix3d::Zero();

    void Append(const FeltStretch& stretch, const Biases& biases) {
      const Eigen::Matrix3d slope = stretch.felt.by_biases.topLeftCorner<3, 3>();
      by_turn_rate += turn.toRotationMatrix() * slope;
      turn = turn * (Turn(slope * biases.head<3>()) * stretch.felt.turn);
    }
  };

  static double Weight(const FeltStretch& stretch) {
    return 1.0 / (stretch.sigma_mps * stretch.sigma_mps +
                  stretch.felt.covariance.diagonal().segment<3>(3).mean());
  }

  // What each stretch felt in the axes of the beginning, how that turns with the turn rate's bias
  // before it, and how it changes with the biases within.
  template <typename Visit>
  void Walk(const Visit& visit) const {
    Chain chain;
    for (const FeltStretch& stretch : stretches_) {
      const Eigen::Matrix<double, 3, 6> slope =
          chain.turn.toRotationMatrix() * stretch.felt.by_biases.middleRows<3>(3);
      const Eigen::Vector3d felt = chain.turn * stretch.felt.velocity_mps + slope * biases_;
      visit(stretch, felt, chain.by_turn_rate, slope);
      chain.Append(stretch, biases_);
    }
  }

  void Equations() {
    Vector prior;
    prior << Eigen::Vector3d::Zero(),
        Eigen::Vector3d::Constant(1.0 / (kUsualTurnRateBias_radps * kUsualTurnRateBias_radps)),
        Eigen::Vector3d::Constant(1.0 / (kUsualForceBias_mps2 * kUsualForceBias_mps2));
    normal_ = prior.asDiagonal();
    right_.setZero();
    right_.tail<6>() = -prior.tail<6>().cwiseProduct(biases_);
    Walk([&](const FeltStretch& stretch, const Eigen::Vector3d& felt,
             const Eigen::Matrix3d& by_turn_rate, const Eigen::Matrix<double, 3, 6>& slope) {
      const Eigen::Matrix3d axes = attitude_.toRotationMatrix();
      Eigen::Matrix<double, 3, 9> by_unknowns;
      by_unknowns.leftCols<3>() = -CrossOf(axes * felt);
      by_unknowns.rightCols<6>() = axes * slope;
      by_unknowns.middleCols<3>(3) -= axes * CrossOf(felt) * by_turn_rate;
      const Eigen::Vector3d residual = stretch.gained_in_ecef_mps - axes * felt;
      normal_ += Weight(stretch) * by_unknowns.transpose() * by_unknowns;
      right_ += Weight(stretch) * by_unknowns.transpose() * residual;
    });
  }

  const std::vector<FeltStretch>& stretches_;
  Eigen::Quaterniond attitude_ = Eigen::Quaterniond::Identity();  // earth from sensor, at first
  Biases biases_ = Biases::Zero();
  Matrix normal_;
  Vector right_;
};

}  // namespace

void InertialAlignment::Add(const FeltStretch& stretch) {
  if (stretches_.size() == kMostStretches) stretches_.erase(stretches_.begin());
  stretches_.push_back(stretch);
}

std::optional<InertialAlignmentResult> InertialAlignment::Solve(
    const Eigen::Vector3d& up_in_ecef) const {
  if (stretches_.size() < kFewestStretches) return std::nullopt;
  Alignment alignment(stretches_);
  if (!alignment.Refine()) return std::nullopt;
  InertialAlignmentResult result = alignment.Result();
  const double cost = alignment.Cost();
  const double freedom = 3.0 * static_cast<double>(stretches_.size()) - 6.0;
  result.strain = cost / freedom;
  if (!(result.strain < kMostStrain)) return std::nullopt;
  result.covariance *= std::max(1.0, result.strain);
  const double heading_variance =
      up_in_ecef.dot(result.covariance.topLeftCorner<3, 3>() * up_in_ecef);
  if (!(heading_variance < kSureHeading_rad * kSureHeading_rad)) return std::nullopt;
  const double opposite = alignment.Cost(Turn(kPi * up_in_ecef));
  if (!(opposite - cost > kOppositeExcluded * std::max(1.0, result.strain))) return std::nullopt;
  return result;
}

}  // namespace lodemark
