// How many coefficients a lens deserves: a ladder of models, each judged by photographs it was not
// fitted to.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/camera/board_adjustment.h"
#include "core/camera/board_view.h"
#include "core/camera/lens.h"

namespace lodemark {

// fx fy cx cy and the coefficients, in the order of a covariance.
std::vector<std::string> IntrinsicNames(LensModel model);

// "brown k1 k2 p1 p2", "fisheye", "pinhole".
std::string NameOf(const LensForm& form);

struct ModelChoiceOptions {
  int most_folds = 5;  // groups of photographs left out in turn
  // A step up must lower the error of the photographs left out by this share, ...
  double least_gain = 0.005;
  // ... by this many standard errors of the differences between photographs, ...
  double least_gain_sigmas = 1.0;
  // ... add a coefficient that is not 0 by this many sigma, ...
  double significant_sigmas = 3.0;
  // ... and leave the focal lengths and the principal point within this factor as certain as they
  // were: terms that take each other's place fit anything.
  double most_sigma_growth = 4.0;
  // Models that fold back within the image are taken only if the others are worse by this factor.
  double fold_price = 1.25;
  bool only_base = false;  // the model without coefficients, nothing to choose
};

struct LadderStep {
  LensForm form;
  double rms_px = 0.0;
  double held_out_rms_px = 0.0;  // infinite where a photograph left out could not be computed
  bool is_kept = false;          // it was the best when it was tried
  std::string verdict;           // a sentence that says why
};

struct ModelChoice {
  std::vector<LadderStep> ladder;
  LensForm form;
  BoardAdjustment adjustment;
  double held_out_rms_px = 0.0;
  double unseen_share = 0.0;  // of the image where the lens has no answer
};

// Climbs the ladder of start.lens.model (kPinhole and kBrown share one, kFisheye has the other)
// from the model without coefficients. views and start.camera_from_board have one length, at least
// three. Nothing if not even the first model can be fitted.
std::optional<ModelChoice> ChooseModel(const LensAndBoards& start,
                                       std::span<const BoardView* const> views,
                                       const ModelChoiceOptions& options);

// Share of the image, 0 to 1, that the lens has no direction for, from a grid that includes its
// borders.
double UnseenShare(const LensParameters& lens);

}  // namespace lodemark
