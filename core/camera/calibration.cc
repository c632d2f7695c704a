#include "core/camera/calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <utility>

#include "core/base/units.h"
#include "core/camera/calibration_start.h"

namespace lodemark {
namespace {

constexpr std::size_t kLeastViews = 3;
constexpr int kFewViews = 8;
constexpr double kLittleTurned_rad = 15.0 * kRadiansPerDegree;
constexpr double kLittleReach = 0.8;
constexpr double kUncertainFocal = 0.01;

constexpr int kMostReposings = 4;
constexpr double kBetterPose = 0.9;  // of its rms

// The flexible models in which bad views show: k1 k2 p1 p2 of Brown, k1 to k4 of a fisheye.
constexpr std::uint32_t kFlexible = 0xf;

std::string Text(const char* format, double a, double b = 0.0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

// One kind of lens with the views that can be posed in it.
struct Fit {
  BoardAdjustment adjustment;
  std::vector<std::size_t> used;  // indices of views
};

double MedianRms(const BoardAdjustment& adjustment) {
  std::vector<double> rms_px;
  for (const auto& residuals : adjustment.residuals_px) rms_px.push_back(RmsOf(residuals));
  const auto middle = rms_px.begin() + static_cast<std::ptrdiff_t>(rms_px.size() / 2);
  std::nth_element(rms_px.begin(), middle, rms_px.end());
  return *middle;
}

// The rms without the worst twentieth: high for a board that was read wrongly, not for one with a
// corner or two that were.
double TrimmedRms(std::vector<Eigen::Vector2d> residuals_px) {
  std::sort(residuals_px.begin(), residuals_px.end(),
            [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
              return a.squaredNorm() < b.squaredNorm();
            });
  const std::size_t kept = residuals_px.size() - residuals_px.size() / 20;
  return RmsOf(std::span(residuals_px).first(kept));
}

double MedianTrimmedRms(const BoardAdjustment& adjustment) {
  std::vector<double> rms_px;
  for (const auto& residuals : adjustment.residuals_px) rms_px.push_back(TrimmedRms(residuals));
  const auto middle = rms_px.begin() + static_cast<std::ptrdiff_t>(rms_px.size() / 2);
  std::nth_element(rms_px.begin(), middle, rms_px.end());
  return *middle;
}

class Calibrator {
 public:
  Calibrator(int width_px, int height_px, std::span<const BoardView> views,
             const CalibrationOptions& options)
      : width_px_(width_px), height_px_(height_px), views_(views), options_(options) {
    result_.views.resize(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (!views[i].corners.empty()) candidates_.push_back(i);
    }
  }

  Result<Calibration> Run() {
    DropRepeated();
    if (candidates_.size() < kLeastViews) return TooFew();
    std::optional<Fit> plane;
    std::optional<Fit> fisheye;
    if (options_.kind != LensKind::kFisheye) plane = FitFlexible(LensModel::kBrown);
    if (options_.kind == LensKind::kAuto || options_.kind == LensKind::kFisheye) {
      fisheye = FitFlexible(LensModel::kFisheye);
    }
    DropBad(&plane);
    DropBad(&fisheye);
    if (!plane && !fisheye) {
      return Error{ErrorCode::kBadData,
                   "no lens fits three of the views; are the board's numbers of corners right?"};
    }
    KeepCommon(&plane, &fisheye);
    return Choose(plane, fisheye);
  }

 private:
  Error TooFew() const {
    const std::string count = candidates_.empty()       ? "no usable view"
                              : candidates_.size() == 1 ? "only one usable view"
                                                        : "only two usable views";
    return {ErrorCode::kBadData, count +
                                     " of the board; it takes three from different directions, "
                                     "and ten make a good calibration"};
  }

  void Drop(std::size_t view, std::string reason) {
    result_.views[view].reason = std::move(reason);
    candidates_.erase(std::remove(candidates_.begin(), candidates_.end(), view), candidates_.end());
  }

  std::vector<const BoardView*> Pointers(const std::vector<std::size_t>& indices) const {
    std::vector<const BoardView*> pointers;
    for (const std::size_t i : indices) pointers.push_back(&views_[i]);
    return pointers;
  }

  void DropRepeated() {
    const std::vector<std::size_t> all = candidates_;
    for (const std::size_t i : all) {
      for (const std::size_t k : candidates_) {
        if (k >= i) break;
        if (!AreSame(views_[i], views_[k])) continue;
        Drop(i, "the same view as " + views_[k].name);
        break;
      }
    }
  }

  bool AreSame(const BoardView& a, const BoardView& b) const {
    if (a.corners.size() != b.corners.size()) return false;
    double squares = 0.0;
    for (std::size_t i = 0; i < a.corners.size(); ++i) {
      if (a.corners[i].board_m != b.corners[i].board_m) return false;
      squares += (a.corners[i].pixel - b.corners[i].pixel).squaredNorm();
    }
    return squares <=
           options_.same_view_px * options_.same_view_px * static_cast<double>(a.corners.size());
  }

  std::optional<Fit> FitFlexible(LensModel model) const {
    const std::vector<const BoardView*> all = Pointers(candidates_);
    const auto start = StartCalibration(all, model, width_px_, height_px_);
    if (!start) return std::nullopt;
    std::vector<std::size_t> used;
    for (const std::size_t i : start->used) used.push_back(candidates_[i]);
    auto adjusted = AdjustBoards(start->estimate, Pointers(used), {model, kFlexible}, {});
    if (!adjusted) return std::nullopt;
    Fit fit = {std::move(*adjusted), std::move(used)};
    for (int i = 0; i < kMostReposings && Repose(&fit); ++i) {
    }
    return fit;
  }

  // Whether any view has a better pose through the lens as it is now known: one that a first lens
  // did not show, or one that came to rest at the other tilt that a flat board nearly allows.
  bool Repose(Fit* fit) const {
    const Result<Lens> lens = Lens::Create(fit->adjustment.estimate.lens);
    if (!lens) return false;
    LensAndBoards start = {fit->adjustment.estimate.lens, {}};
    std::vector<std::size_t> used;
    bool is_changed = false;
    std::size_t known = 0;  // of the fit's views, which are in the order of the candidates
    for (const std::size_t i : candidates_) {
      const auto alone = Alone(i, *lens);
      const bool is_known = known < fit->used.size() && fit->used[known] == i;
      if (!is_known && !alone) continue;
      const double now_px = is_known ? RmsOf(fit->adjustment.residuals_px[known]) : 0.0;
      const bool is_better = alone && (!is_known || alone->rms_px < kBetterPose * now_px);
      start.camera_from_board.push_back(is_better
                                            ? alone->estimate.camera_from_board.front()
                                            : fit->adjustment.estimate.camera_from_board[known]);
      used.push_back(i);
      is_changed = is_changed || is_better;
      if (is_known) ++known;
    }
    if (!is_changed) return false;
    const LensForm form = {start.lens.model, kFlexible};
    auto adjusted = AdjustBoards(std::move(start), Pointers(used), form, {});
    if (!adjusted) return false;
    *fit = {std::move(*adjusted), std::move(used)};
    return true;
  }

  // One view through a lens that is known.
  std::optional<BoardAdjustment> Alone(std::size_t view, const Lens& lens) const {
    const std::optional<Rigid3> pose = BoardPose(views_[view], lens);
    if (!pose) return std::nullopt;
    const BoardView* const one[] = {&views_[view]};
    BoardAdjustmentOptions adjust;
    adjust.lens_is_known = true;
    return AdjustBoards({lens.parameters(), {*pose}}, one, {lens.parameters().model, 0}, adjust);
  }

  // Leaves out the worst view while it is far off the middle one.
  void DropBad(std::optional<Fit>* fit) const {
    while (*fit && (*fit)->used.size() > kLeastViews) {
      Fit& now = **fit;
      std::size_t worst = 0;
      double worst_px = 0.0;
      for (std::size_t i = 0; i < now.used.size(); ++i) {
        const double rms_px = TrimmedRms(now.adjustment.residuals_px[i]);
        if (rms_px > worst_px) {
          worst_px = rms_px;
          worst = i;
        }
      }
      const double limit_px = std::max(options_.bad_view_floor_px,
                                       options_.bad_view_ratio * MedianTrimmedRms(now.adjustment));
      if (worst_px <= limit_px) return;
      const auto offset = static_cast<std::ptrdiff_t>(worst);
      now.used.erase(now.used.begin() + offset);
      LensAndBoards start = now.adjustment.estimate;
      start.camera_from_board.erase(start.camera_from_board.begin() + offset);
      const LensForm form = {start.lens.model, kFlexible};
      auto adjusted = AdjustBoards(std::move(start), Pointers(now.used), form, {});
      if (!adjusted) {
        fit->reset();
        return;
      }
      now.adjustment = std::move(*adjusted);
    }
  }

  // Both kinds are judged by the same views: those of the kind that fits better. The other one is
  // given up if it cannot show them.
  void KeepCommon(std::optional<Fit>* plane, std::optional<Fit>* fisheye) {
    const bool plane_leads = !*fisheye || (*plane && MedianRms((*plane)->adjustment) <=
                                                         MedianRms((*fisheye)->adjustment));
    std::optional<Fit>& leader = plane_leads ? *plane : *fisheye;
    std::optional<Fit>& other = plane_leads ? *fisheye : *plane;
    const Result<Lens> lens = Lens::Create(leader->adjustment.estimate.lens);
    const std::vector<std::size_t> all = candidates_;
    for (const std::size_t i : all) {
      if (std::find(leader->used.begin(), leader->used.end(), i) != leader->used.end()) continue;
      Drop(i, ReasonAgainst(i, leader->adjustment, lens));
    }
    if (other && !Pose(leader->used, &*other)) other.reset();
  }

  std::string ReasonAgainst(std::size_t view, const BoardAdjustment& adjustment,
                            const Result<Lens>& lens) const {
    const auto alone = lens ? Alone(view, *lens) : std::nullopt;
    if (alone) {
      return Text("its corners are off by %.2f px, those of the others by %.2f px", alone->rms_px,
                  MedianRms(adjustment));
    }
    return "no pose of the board fits its corners";
  }

  // Gives the fit exactly these views, new ones posed through its lens.
  bool Pose(const std::vector<std::size_t>& wanted, Fit* fit) const {
    const Result<Lens> lens = Lens::Create(fit->adjustment.estimate.lens);
    if (!lens) return false;
    LensAndBoards state = {fit->adjustment.estimate.lens, {}};
    for (const std::size_t i : wanted) {
      const auto known = std::find(fit->used.begin(), fit->used.end(), i);
      if (known != fit->used.end()) {
        state.camera_from_board.push_back(
            fit->adjustment.estimate
                .camera_from_board[static_cast<std::size_t>(known - fit->used.begin())]);
        continue;
      }
      const std::optional<Rigid3> pose = BoardPose(views_[i], *lens);
      if (!pose) return false;
      state.camera_from_board.push_back(*pose);
    }
    fit->used = wanted;
    fit->adjustment.estimate = std::move(state);
    return true;
  }

  Result<Calibration> Choose(const std::optional<Fit>& plane, const std::optional<Fit>& fisheye) {
    const std::vector<const BoardView*> used = Pointers(candidates_);
    ModelChoiceOptions choice_options = options_.choice;
    choice_options.only_base = options_.kind == LensKind::kPinhole;
    std::optional<ModelChoice> first;
    std::optional<ModelChoice> second;
    if (plane) first = ChooseModel(plane->adjustment.estimate, used, choice_options);
    if (fisheye) second = ChooseModel(fisheye->adjustment.estimate, used, choice_options);
    for (const auto* choice : {&first, &second}) {
      if (!*choice) continue;
      result_.ladder.insert(result_.ladder.end(), (*choice)->ladder.begin(),
                            (*choice)->ladder.end());
    }
    if (!first && !second) {
      return Error{ErrorCode::kBadData, "no model can be fitted to the views"};
    }
    const bool take_second = !first || (second && IsBetter(*second, *first));
    return Conclude(take_second ? std::move(*second) : std::move(*first));
  }

  // Whether a fisheye takes the place of a plane image.
  bool IsBetter(const ModelChoice& challenger, const ModelChoice& holder) const {
    if (challenger.unseen_share > 0.0 && holder.unseen_share == 0.0) {
      return challenger.held_out_rms_px * options_.choice.fold_price < holder.held_out_rms_px;
    }
    if (holder.unseen_share > 0.0 && challenger.unseen_share == 0.0) {
      return challenger.held_out_rms_px < options_.choice.fold_price * holder.held_out_rms_px;
    }
    return challenger.held_out_rms_px < (1.0 - options_.choice.least_gain) * holder.held_out_rms_px;
  }

  Result<Calibration> Conclude(ModelChoice choice) {
    BoardAdjustment& found = choice.adjustment;
    result_.lens = found.estimate.lens;
    if (choice.form.free_coefficients == 0 && result_.lens.model == LensModel::kBrown) {
      result_.lens.model = LensModel::kPinhole;
      choice.form.model = LensModel::kPinhole;
      if (found.covariance.size() > 0) {
        found.covariance = Eigen::MatrixXd(found.covariance.topLeftCorner<4, 4>());
      }
    }
    const double focal_sigma =
        found.covariance.size() == 0
            ? 1.0
            : std::max(std::sqrt(found.covariance(0, 0)) / result_.lens.fx_px,
                       std::sqrt(found.covariance(1, 1)) / result_.lens.fy_px);
    if (!(focal_sigma <= options_.most_focal_sigma)) {
      return Error{ErrorCode::kBadData,
                   Text("the %.0f usable views leave the focal length open",
                        static_cast<double>(candidates_.size())) +
                       (focal_sigma < 1.0 ? Text(" (sigma %.0f %%)", 100.0 * focal_sigma) : "") +
                       "; photograph the board tilted, from different directions"};
    }
    result_.covariance = found.covariance;
    result_.rms_px = found.rms_px;
    result_.noise_px = found.noise_px;
    result_.view_scatter = found.view_scatter;
    result_.held_out_rms_px = choice.held_out_rms_px;
    result_.form = choice.form;
    result_.views_used = static_cast<int>(candidates_.size());
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      CalibratedView& view = result_.views[candidates_[i]];
      view.is_used = true;
      view.camera_from_board = found.estimate.camera_from_board[i];
      view.residuals_px = std::move(found.residuals_px[i]);
      view.rms_px = RmsOf(view.residuals_px);
    }
    Warn(choice);
    return std::move(result_);
  }

  void Warn(const ModelChoice& choice) {
    auto& warnings = result_.warnings;
    if (choice.unseen_share > 0.0) {
      const Result<Lens> lens = Lens::Create(result_.lens);
      warnings.push_back(Text(
          "the lens has no answer in %.0f %% of the image, more than %.0f degrees from the "
          "axis",
          100.0 * choice.unseen_share, lens ? lens->field_limit_rad() / kRadiansPerDegree : 0.0));
    }
    if (result_.views_used < kFewViews) {
      warnings.push_back(Text("only %.0f views; ten or more tell better what the lens does",
                              static_cast<double>(result_.views_used)));
    }
    const double focal_sigma = std::sqrt(result_.covariance(0, 0)) / result_.lens.fx_px;
    if (focal_sigma > kUncertainFocal) {
      warnings.push_back(
          Text("the focal length is known to %.1f %% only; tilt the board more, or "
               "allow other models",
               100.0 * focal_sigma));
    }
    const Eigen::Vector2d middle(0.5 * (width_px_ - 1), 0.5 * (height_px_ - 1));
    double reach_px = 0.0;
    double turned_rad = 0.0;
    for (const std::size_t i : candidates_) {
      for (const BoardCorner& corner : views_[i].corners) {
        reach_px = std::max(reach_px, (corner.pixel - middle).norm());
      }
      for (const std::size_t k : candidates_) {
        const Eigen::Vector3d a = NormalOf(i);
        const Eigen::Vector3d b = NormalOf(k);
        turned_rad = std::max(turned_rad, std::acos(std::clamp(std::abs(a.dot(b)), 0.0, 1.0)));
      }
    }
    if (reach_px < kLittleReach * middle.norm()) {
      warnings.push_back(
          Text("the boards reach %.0f %% of the way to the image's corners; further out the lens "
               "is extrapolated",
               100.0 * reach_px / middle.norm()));
    }
    if (turned_rad < kLittleTurned_rad) {
      warnings.push_back(
          Text("no two boards are turned by more than %.0f degrees against each "
               "other; tilt the board by 30 to 45",
               turned_rad / kRadiansPerDegree));
    }
  }

  Eigen::Vector3d NormalOf(std::size_t view) const {
    return result_.views[view].camera_from_board.rotation() * Eigen::Vector3d::UnitZ();
  }

  int width_px_;
  int height_px_;
  std::span<const BoardView> views_;
  const CalibrationOptions& options_;
  std::vector<std::size_t> candidates_;  // views still in use
  Calibration result_;
};

}  // namespace

Result<Calibration> Calibrate(int width_px, int height_px, std::span<const BoardView> views,
                              const CalibrationOptions& options) {
  return Calibrator(width_px, height_px, views, options).Run();
}

}  // namespace lodemark
