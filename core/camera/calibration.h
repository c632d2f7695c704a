// Calibration of a camera from photographs of a flat board.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/camera/board_view.h"
#include "core/camera/lens.h"
#include "core/camera/model_choice.h"
#include "core/geo/rigid3.h"

namespace lodemark {

enum class LensKind : std::uint8_t { kAuto, kPinhole, kBrown, kFisheye };

struct CalibrationOptions {
  LensKind kind = LensKind::kAuto;
  // A view whose corners, without the worst twentieth of them, are off this many times as much as
  // the middle one's is left out, ...
  double bad_view_ratio = 4.0;
  double bad_view_floor_px = 0.03;  // ... if by more than this
  double same_view_px = 0.5;        // views closer than this (rms) to an earlier one count as one
  // Focal lengths less certain than this share are no result.
  double most_focal_sigma = 0.1;
  ModelChoiceOptions choice;
};

// What became of one view.
struct CalibratedView {
  bool is_used = false;
  std::string reason;  // it was not
  Rigid3 camera_from_board;
  double rms_px = 0.0;
  std::vector<Eigen::Vector2d> residuals_px;  // seen less computed, corner by corner
};

struct Calibration {
  LensParameters lens;         // a pinhole if it has no coefficients
  Eigen::MatrixXd covariance;  // of fx fy cx cy and the coefficients; zero where held at 0
  double rms_px = 0.0;         // of the distances between corners seen and computed
  double noise_px = 0.0;       // sigma of a coordinate
  double held_out_rms_px = 0.0;
  double view_scatter = 1.0;  // see BoardAdjustment
  int views_used = 0;
  std::vector<CalibratedView> views;  // one for each given
  LensForm form;
  std::vector<LadderStep> ladder;     // all models tried
  std::vector<std::string> warnings;  // sentences
};

// The lens that took the views: the model is chosen, views that do not fit are left out. An error
// says in a sentence why there is no answer: too few views, or views that do not tell the focal
// length. Views without corners are left out.
Result<Calibration> Calibrate(int width_px, int height_px, std::span<const BoardView> views,
                              const CalibrationOptions& options = {});

}  // namespace lodemark
