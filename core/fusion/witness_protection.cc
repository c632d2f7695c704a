#include "core/fusion/witness_protection.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/adjustment/distributions.h"
#include "core/fusion/protection.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// A part without which a direction would be known worse by such a factor cannot be checked there.
constexpr double kUnchecked = 1e3;

// Parts of which every two are left out: those without which the levels are largest.
constexpr std::size_t kMostInPairs = 12;

// Less weight than this does not hold a position.
constexpr double kNoWeight = 1e-3;

// Standard deviations of a sum of squares that say it is not chance.
constexpr double kSurprising = 3.0;

// Where a witness knows nothing.
constexpr double kLeastInformation = 1e-12;

// Both ends.
double QuantileOf(double risk) { return risk < 1.0 ? -NormalQuantile(0.5 * risk) : 0.0; }

// What is known of a place besides the witness: information and pull at the witness's point.
struct Knowledge {
  Eigen::Matrix3d information_pm2;
  Eigen::Vector3d pull_pm;
};

class Widening {
 public:
  Widening(const PositionWitness& witness, const PositionStatement& statement,
           PointEstimate* estimate)
      : witness_(witness),
        statement_(statement),
        rest_{estimate->information_pm2 - statement.information_pm2, -statement.pull_pm},
        spread_m_(HorizontalSigma(estimate->covariance_enu_m2)),
        up_spread_m_(std::sqrt(estimate->covariance_enu_m2(2, 2))),
        estimate_(estimate),
        seen_horizontal_(estimate->protection_level_m > 0.0),
        seen_vertical_(estimate->vertical_protection_level_m > 0.0) {}

  // By parts that are mistaken alone or in pairs.
  void ByParts(double risk);
  void ByDisplacement(const DisplacementRisk& displacement, double risk, const Knowledge& rest);
  void Finish();
  const Knowledge& rest() const { return rest_; }

 private:
  struct Separation {
    double horizontal_m = 0.0;
    double up_m = 0.0;
    double horizontal_sigma_m = 0.0;
    double up_sigma_m = 0.0;
  };
  struct Suspect {
    std::size_t part = 0;
    double level_m = 0.0;
  };

  // Of the place that another statement in the witness's stead leads to. False if to none.
  bool Separate(const Knowledge& rest, const PositionStatement& other,
                Separation* separation) const;
  void Reach(const Separation& separation, double quantile);
  double Misfit() const;

  const PositionWitness& witness_;
  const PositionStatement& statement_;
  Knowledge rest_;  // at the solution its pull and the witness's cancel
  double spread_m_ = 0.0;
  double up_spread_m_ = 0.0;
  PointEstimate* estimate_;
  bool seen_horizontal_ = false;
  bool seen_vertical_ = false;
};

bool Widening::Separate(const Knowledge& rest, const PositionStatement& other,
                        Separation* separation) const {
  const Eigen::LLT<Eigen::Matrix3d> factor(rest.information_pm2 + other.information_pm2);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::Matrix3d covariance_m2 = factor.solve(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d shift_m = factor.solve(Eigen::Vector3d(rest.pull_pm + other.pull_pm));
  separation->horizontal_m = shift_m.head<2>().norm();
  separation->up_m = std::abs(shift_m.z());
  separation->horizontal_sigma_m = HorizontalSigma(covariance_m2);
  separation->up_sigma_m = std::sqrt(covariance_m2(2, 2));
  return true;
}

void Widening::Reach(const Separation& separation, double quantile) {
  double& horizontal_m = estimate_->protection_level_m;
  double& vertical_m = estimate_->vertical_protection_level_m;
  horizontal_m =
      std::max(horizontal_m, separation.horizontal_m + quantile * separation.horizontal_sigma_m);
  vertical_m = std::max(vertical_m, separation.up_m + quantile * separation.up_sigma_m);
}

// How much larger the parts' errors are than their sigmas, where that is no chance: then the model
// does not hold, and several may be mistaken.
double Widening::Misfit() const {
  const GroupMisfit misfit = witness_.MisfitBeside(rest_.information_pm2);
  if (!(misfit.redundancy > 0.0)) return 1.0;
  const double usual = misfit.redundancy + kSurprising * std::sqrt(2.0 * misfit.redundancy);
  return std::sqrt(std::max(misfit.squares / usual, 1.0));
}

void Widening::ByParts(double risk) {
  const std::size_t parts = witness_.parts();
  if (parts == 0) return;
  const double misfit = Misfit();
  const double quantile = misfit * QuantileOf(risk / (static_cast<double>(parts) + 1.0));
  Reach({0.0, 0.0, spread_m_, up_spread_m_}, quantile);
  std::array<Suspect, kMostInPairs> suspects;
  std::size_t suspected = 0;
  for (std::size_t i = 0; i < parts; ++i) {
    if (witness_.WeightOf(i) < kNoWeight) continue;
    Separation separation;
    if (!Separate(rest_, witness_.Without(i), &separation)) {
      seen_horizontal_ = false;
      seen_vertical_ = false;
      return;
    }
    if (!(separation.horizontal_sigma_m < kUnchecked * spread_m_)) seen_horizontal_ = false;
    if (!(separation.up_sigma_m < kUnchecked * up_spread_m_)) seen_vertical_ = false;
    Reach(separation, quantile);
    Suspect suspect = {i, separation.horizontal_m + quantile * separation.horizontal_sigma_m};
    for (std::size_t k = 0; k < suspected; ++k) {
      if (suspect.level_m > suspects[k].level_m) std::swap(suspect, suspects[k]);
    }
    if (suspected < kMostInPairs) suspects[suspected++] = suspect;
  }
  // That any two are mistaken; what is left of the risk is for all pairs.
  const double wrong = witness_.wrong_probability();
  const double pairs = 0.5 * static_cast<double>(parts) * static_cast<double>(parts - 1);
  const double both = pairs * wrong * wrong;
  if (!(both > risk)) return;
  const double pair_quantile = misfit * QuantileOf(risk / both);
  for (std::size_t k = 0; k < suspected; ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      Separation separation;
      // Where no two others are left to tell, those levels are for single faults.
      if (!Separate(rest_, witness_.WithoutBoth(suspects[k].part, suspects[j].part), &separation))
        continue;
      if (separation.horizontal_sigma_m < kUnchecked * spread_m_ &&
          separation.up_sigma_m < kUnchecked * up_spread_m_) {
        Reach(separation, pair_quantile);
      }
    }
  }
}

// Log of the integral over the place of what is known besides (rest) times what a witness says,
// whose own integral is 1.
double LogEvidence(const Knowledge& rest, const PositionStatement& said) {
  const Eigen::Matrix3d whole = rest.information_pm2 + said.information_pm2;
  const Eigen::Vector3d pull = rest.pull_pm + said.pull_pm;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(said.information_pm2);
  const Eigen::Vector3d along = axes.eigenvectors().transpose() * said.pull_pm;
  double log_evidence = 0.5 * (pull.dot(whole.llt().solve(pull)) - std::log(whole.determinant()));
  for (int i = 0; i < 3; ++i) {
    const double information = std::max(axes.eigenvalues()[i], kLeastInformation);
    log_evidence += 0.5 * (std::log(information) - along[i] * along[i] / information);
  }
  return log_evidence;
}

// Bayes: how likely the witness is displaced, from how much better all else then fits it.
void Widening::ByDisplacement(const DisplacementRisk& displacement, double risk,
                              const Knowledge& rest) {
  if (!(displacement.probability > risk) || !(displacement.sigma_m > 0.0)) return;
  const PositionStatement displaced = statement_.WithCommonError(
      displacement.sigma_m * displacement.sigma_m * Eigen::Matrix3d::Identity());
  Separation separation;
  if (!Separate(rest, displaced, &separation)) return;
  const double log_odds = std::log(displacement.probability / (1.0 - displacement.probability)) +
                          LogEvidence(rest, displaced) - LogEvidence(rest, statement_);
  if (std::isnan(log_odds)) return;
  const double probability = 1.0 / (1.0 + std::exp(-log_odds));
  if (probability > risk) Reach(separation, QuantileOf(risk / probability));
}

void Widening::Finish() {
  if (!seen_horizontal_) estimate_->protection_level_m = 0.0;
  if (!seen_vertical_) estimate_->vertical_protection_level_m = 0.0;
}

}  // namespace

void WidenByParts(const PositionWitness& witness, const PositionStatement& statement,
                  const DisplacementRisk& displacement, const PointEstimate* alone, double risk,
                  PointEstimate* estimate) {
  Widening widening(witness, statement, estimate);
  widening.ByParts(risk);
  widening.ByDisplacement(displacement, risk, widening.rest());
  if (alone != nullptr) {
    const Eigen::Matrix3d enu_from_ecef =
        EnuFromEcefRotation(GeodeticFromEcef(statement.around_in_ecef));
    const Eigen::Vector3d offset_m =
        enu_from_ecef * (alone->position_in_ecef - statement.around_in_ecef);
    const Eigen::Matrix3d information_pm2 = alone->covariance_enu_m2.inverse();
    widening.ByDisplacement(displacement, risk, {information_pm2, information_pm2 * offset_m});
  }
  widening.Finish();
}

}  // namespace lodemark
