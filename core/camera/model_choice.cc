#include "core/camera/model_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr std::array kBrownNames = {"k1", "k2", "p1", "p2", "k3", "k4",    "k5",
                                    "k6", "s1", "s2", "s3", "s4", "tau_x", "tau_y"};
constexpr std::array kFisheyeNames = {"k1", "k2", "k3", "k4"};
constexpr std::array kThinPrismNames = {"k1", "k2", "p1", "p2", "k3", "k4", "sx1", "sy1"};

// What each step adds to the model it starts from, as bits of the coefficients. A step that was
// refused is part of those above it that build on it.
constexpr std::uint32_t kK1 = 1u << 0;
constexpr std::uint32_t kK2 = 1u << 1;
constexpr std::uint32_t kP1P2 = 1u << 2 | 1u << 3;
constexpr std::uint32_t kK3 = 1u << 4;
constexpr std::uint32_t kRational = 1u << 5 | 1u << 6 | 1u << 7;
constexpr std::uint32_t kThinPrism = 1u << 8 | 1u << 9 | 1u << 10 | 1u << 11;
constexpr std::array kBrownSteps = {
    kK1, kK1 | kK2, kP1P2, kK1 | kK2 | kK3, kK1 | kK2 | kK3 | kRational, kThinPrism};
constexpr std::array kFisheyeSteps = {0x1u, 0x3u, 0x7u, 0xfu};

constexpr int kFoldIterations = 40;
constexpr int kGrid = 32;

std::string Text(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

std::span<const char* const> CoefficientNames(LensModel model) {
  switch (model) {
    case LensModel::kPinhole:
      break;
    case LensModel::kBrown:
      return kBrownNames;
    case LensModel::kFisheye:
      return kFisheyeNames;
    case LensModel::kThinPrismFisheye:
      return kThinPrismNames;
  }
  return {};
}

std::string NamesOf(LensModel model, std::uint32_t coefficients) {
  std::string names;
  const auto all = CoefficientNames(model);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if ((coefficients >> i & 1u) == 0) continue;
    if (!names.empty()) names += ' ';
    names += all[i];
  }
  return names;
}

// A model fitted to all photographs, and how well its kind predicts those it was not fitted to.
struct Candidate {
  LensForm form;
  BoardAdjustment adjustment;
  std::vector<double> held_out_squares;  // sum of squared residuals of each photograph; or empty
  double held_out_rms_px = std::numeric_limits<double>::infinity();
  double unseen_share = 0.0;
};

class Ladder {
 public:
  Ladder(std::span<const BoardView* const> views, const ModelChoiceOptions& options)
      : views_(views), options_(options) {}

  std::optional<Candidate> Fit(const LensAndBoards& start, const LensForm& form) const {
    auto adjusted = AdjustBoards(start, views_, form, {});
    if (!adjusted) return std::nullopt;
    Candidate candidate = {form, std::move(*adjusted), {}};
    candidate.unseen_share = UnseenShare(candidate.adjustment.estimate.lens);
    LeaveOut(&candidate);
    return candidate;
  }

  // Why a candidate does not replace the best so far; nothing if it does.
  std::optional<std::string> Against(const Candidate& candidate, const Candidate& best,
                                     bool may_fold) const {
    const auto& found = candidate.adjustment;
    if (!found.converged) return "refused: its adjustment does not come to rest";
    if (found.covariance.size() == 0) return "refused: the photographs do not determine it";
    if (candidate.unseen_share > 0.0 && !may_fold) {
      const Result<Lens> lens = Lens::Create(found.estimate.lens);
      return Text(
          "refused: not one-to-one over the whole image, it folds back %.1f degrees from "
          "the axis",
          lens ? lens->field_limit_rad() / kRadiansPerDegree : 0.0);
    }
    if (candidate.held_out_squares.empty()) {
      return "refused: photographs left out could not be computed with it";
    }
    const Significance most = MostSignificant(candidate, best);
    if (most.sigmas < options_.significant_sigmas) {
      return Text("refused: nothing it adds is more than %.1f sigma from 0", most.sigmas);
    }
    if (best.held_out_squares.empty()) return std::nullopt;
    const double growth = SigmaGrowth(candidate, best);
    if (growth > options_.most_sigma_growth) {
      return Text(
          "refused: over-fit, it leaves the focal length or principal point %.0f times "
          "less certain",
          growth);
    }
    const double gain = 1.0 - candidate.held_out_rms_px / best.held_out_rms_px;
    if (gain < options_.least_gain || GainSigmas(candidate, best) < options_.least_gain_sigmas) {
      return Text(gain > 0.0 ? "refused: over-fit, photographs left out gain only %.2f %%"
                             : "refused: over-fit, photographs left out lose %.2f %%",
                  100.0 * std::abs(gain));
    }
    return std::nullopt;
  }

  std::string InFavour(const Candidate& candidate, const Candidate& best) const {
    const Significance most = MostSignificant(candidate, best);
    return "kept: " + most.name +
           Text(" is %.0f sigma from 0, photographs left out %.3f to %.3f px", most.sigmas,
                best.held_out_rms_px, candidate.held_out_rms_px);
  }

 private:
  struct Significance {
    std::string name;
    double sigmas = 0.0;
  };

  // Of the coefficients that best has not.
  static Significance MostSignificant(const Candidate& candidate, const Candidate& best) {
    Significance most;
    const auto names = CoefficientNames(candidate.form.model);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto index = static_cast<int>(i);
      if (!IsFree(candidate.form, index) || IsFree(best.form, index)) continue;
      const double variance = candidate.adjustment.covariance(4 + index, 4 + index);
      const double value = candidate.adjustment.estimate.lens.coefficients[i];
      const double sigmas = variance > 0.0 ? std::abs(value) / std::sqrt(variance) : 0.0;
      if (sigmas >= most.sigmas) most = {names[i], sigmas};
    }
    return most;
  }

  // Of fx fy cx cy, in pixels of sigma per pixel of noise: a better model may have less noise.
  static double SigmaGrowth(const Candidate& candidate, const Candidate& best) {
    if (best.adjustment.covariance.size() == 0) return 1.0;
    const Eigen::Array4d before = best.adjustment.covariance.diagonal().head<4>().array().sqrt();
    const Eigen::Array4d after =
        candidate.adjustment.covariance.diagonal().head<4>().array().sqrt();
    return (after / before).maxCoeff() * best.adjustment.noise_px / candidate.adjustment.noise_px;
  }

  // How far the gain, photograph by photograph, lies above its own scatter.
  static double GainSigmas(const Candidate& candidate, const Candidate& best) {
    const auto count = static_cast<double>(best.held_out_squares.size());
    double mean = 0.0;
    for (std::size_t i = 0; i < best.held_out_squares.size(); ++i) {
      mean += (best.held_out_squares[i] - candidate.held_out_squares[i]) / count;
    }
    double variance = 0.0;
    for (std::size_t i = 0; i < best.held_out_squares.size(); ++i) {
      const double off = best.held_out_squares[i] - candidate.held_out_squares[i] - mean;
      variance += off * off / (count - 1.0);
    }
    return variance > 0.0 ? mean / std::sqrt(variance / count)
                          : std::copysign(std::numeric_limits<double>::infinity(), mean);
  }

  // Fits without every fold-th photograph, and then those with that lens.
  void LeaveOut(Candidate* candidate) const {
    const auto folds =
        std::min<std::size_t>(static_cast<std::size_t>(options_.most_folds), views_.size());
    std::vector<double> squares(views_.size());
    double sum = 0.0;
    double corners = 0.0;
    for (std::size_t fold = 0; fold < folds; ++fold) {
      std::vector<const BoardView*> fitted;
      LensAndBoards start = {candidate->adjustment.estimate.lens, {}};
      for (std::size_t i = 0; i < views_.size(); ++i) {
        if (i % folds == fold) continue;
        fitted.push_back(views_[i]);
        start.camera_from_board.push_back(candidate->adjustment.estimate.camera_from_board[i]);
      }
      BoardAdjustmentOptions adjust;
      adjust.most_iterations = kFoldIterations;
      const auto without = AdjustBoards(start, fitted, candidate->form, adjust);
      if (!without) return;
      adjust.lens_is_known = true;
      for (std::size_t i = fold; i < views_.size(); i += folds) {
        const BoardView* const view[] = {views_[i]};
        const LensAndBoards seen = {without->estimate.lens,
                                    {candidate->adjustment.estimate.camera_from_board[i]}};
        const auto left_out = AdjustBoards(seen, view, candidate->form, adjust);
        if (!left_out) return;
        const auto own = static_cast<double>(views_[i]->corners.size());
        squares[i] = left_out->rms_px * left_out->rms_px * own;
        sum += squares[i];
        corners += own;
      }
    }
    candidate->held_out_squares = std::move(squares);
    candidate->held_out_rms_px = std::sqrt(sum / corners);
  }

  std::span<const BoardView* const> views_;
  const ModelChoiceOptions& options_;
};

LadderStep StepOf(const Candidate& candidate, bool is_kept, std::string verdict) {
  return {candidate.form, candidate.adjustment.rms_px, candidate.held_out_rms_px, is_kept,
          std::move(verdict)};
}

}  // namespace

std::vector<std::string> IntrinsicNames(LensModel model) {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy"};
  for (const char* name : CoefficientNames(model)) names.emplace_back(name);
  return names;
}

std::string NameOf(const LensForm& form) {
  if (form.free_coefficients == 0 && form.model == LensModel::kBrown) return "pinhole";
  const std::string coefficients = NamesOf(form.model, form.free_coefficients);
  return std::string(NameOf(form.model)) + (coefficients.empty() ? "" : " ") + coefficients;
}

double UnseenShare(const LensParameters& parameters) {
  const Result<Lens> lens = Lens::Create(parameters);
  if (!lens) return 1.0;
  int unseen = 0;
  for (int row = 0; row <= kGrid; ++row) {
    for (int column = 0; column <= kGrid; ++column) {
      const Eigen::Vector2d pixel((parameters.width_px - 1.0) * column / kGrid,
                                  (parameters.height_px - 1.0) * row / kGrid);
      if (!lens->Unproject(pixel)) ++unseen;
    }
  }
  return static_cast<double>(unseen) / ((kGrid + 1) * (kGrid + 1));
}

std::optional<ModelChoice> ChooseModel(const LensAndBoards& start,
                                       std::span<const BoardView* const> views,
                                       const ModelChoiceOptions& options) {
  const bool is_fisheye = start.lens.model == LensModel::kFisheye;
  const Ladder ladder(views, options);
  LensAndBoards plain = start;
  plain.lens.model = is_fisheye ? LensModel::kFisheye : LensModel::kBrown;
  plain.lens.coefficients = {};
  std::optional<Candidate> base = ladder.Fit(plain, {plain.lens.model, 0});
  if (!base) return std::nullopt;

  // Every model is fitted once; which of them is best is then asked with the image's fold as a bar
  // and, if that costs too much, without.
  std::vector<Candidate> fitted;
  const auto fit = [&](const Candidate& from, std::uint32_t coefficients) -> const Candidate* {
    for (const Candidate& known : fitted) {
      if (known.form.free_coefficients == coefficients) return &known;
    }
    auto candidate = ladder.Fit(from.adjustment.estimate, {from.form.model, coefficients});
    if (!candidate) return nullptr;
    fitted.push_back(std::move(*candidate));
    return &fitted.back();
  };
  fitted.reserve(2 * (kBrownSteps.size() + kFisheyeSteps.size()));
  fitted.push_back(std::move(*base));

  const auto climb = [&](bool may_fold, std::vector<LadderStep>* steps) {
    const Candidate* best = &fitted.front();
    steps->push_back(StepOf(*best, true, "the simplest"));
    if (options.only_base) return best;
    const std::span<const std::uint32_t> additions =
        is_fisheye ? std::span<const std::uint32_t>(kFisheyeSteps) : kBrownSteps;
    for (const std::uint32_t addition : additions) {
      const std::uint32_t coefficients = best->form.free_coefficients | addition;
      const Candidate* candidate = fit(*best, coefficients);
      if (candidate == nullptr) {
        steps->push_back({{plain.lens.model, coefficients},
                          0.0,
                          std::numeric_limits<double>::infinity(),
                          false,
                          "refused: it cannot be fitted"});
        continue;
      }
      const std::optional<std::string> reason = ladder.Against(*candidate, *best, may_fold);
      steps->push_back(
          StepOf(*candidate, !reason, reason ? *reason : ladder.InFavour(*candidate, *best)));
      if (!reason) best = candidate;
    }
    return best;
  };

  ModelChoice choice;
  const Candidate* best = climb(false, &choice.ladder);
  std::vector<LadderStep> folding;
  const Candidate* best_folding = climb(true, &folding);
  if (best_folding->held_out_rms_px * options.fold_price < best->held_out_rms_px) {
    best = best_folding;
    choice.ladder = std::move(folding);
  }
  choice.form = best->form;
  choice.adjustment = best->adjustment;
  choice.held_out_rms_px = best->held_out_rms_px;
  choice.unseen_share = best->unseen_share;
  return choice;
}

}  // namespace lodemark
