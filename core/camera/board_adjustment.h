// The bundle adjustment of a calibration: the numbers of a lens and the poses of the boards it saw,
// from where it saw their corners.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera/board_view.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"

namespace lodemark {

// What an adjustment may move of a lens: the focal lengths and the principal point, and of the
// coefficients those whose bit is set. The others keep their value.
struct LensForm {
  LensModel model = LensModel::kPinhole;
  std::uint32_t free_coefficients = 0;
};

inline constexpr bool IsFree(const LensForm& form, int coefficient) {
  return (form.free_coefficients >> static_cast<unsigned>(coefficient) & 1u) != 0;
}

struct BoardAdjustmentOptions {
  // Corners off by more than this many sigma count less (Huber's kernel on the distance, the sigma
  // taken from the median).
  double kernel_sigmas = 3.0;
  int most_iterations = 100;
  bool lens_is_known = false;  // move the boards only
};

// A lens and the boards it sees, board by board.
struct LensAndBoards {
  LensParameters lens;
  std::vector<Rigid3> camera_from_board;
};

struct BoardAdjustment {
  LensAndBoards estimate;
  std::vector<std::vector<Eigen::Vector2d>> residuals_px;  // seen less computed, board by board
  double rms_px = 0.0;    // of the distances, every corner counted fully
  double noise_px = 0.0;  // sigma of one coordinate, from the residuals and the redundancy
  // How much more the views disagree about the lens than the noise of their corners explains, as a
  // factor of variance; 1 if they agree. A board that is bent or a model that is too simple does
  // that, alike for all corners of a view.
  double view_scatter = 1.0;
  // Of fx fy cx cy and the coefficients, for the noise estimated and, where they are significant,
  // the views' disagreements; zero where held. Empty if the views do not determine them, or the
  // lens was known.
  Eigen::MatrixXd covariance;
  bool converged = false;
};

// Nothing if the start does not image every corner, or there are fewer coordinates than unknowns.
// views and start.camera_from_board have one length.
std::optional<BoardAdjustment> AdjustBoards(LensAndBoards start,
                                            std::span<const BoardView* const> views,
                                            const LensForm& form,
                                            const BoardAdjustmentOptions& options);

double RmsOf(std::span<const Eigen::Vector2d> residuals_px);

}  // namespace lodemark
