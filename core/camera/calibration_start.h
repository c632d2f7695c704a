// Where a calibration starts: a first lens, and the pose of a board seen through a lens.
#pragma once

#include <optional>
#include <span>

#include "core/camera/board_adjustment.h"
#include "core/camera/board_view.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"

namespace lodemark {

// Focal lengths by Zhang's closed form, the principal point in the middle of the image. Nothing if
// the boards do not determine them, for example all square to the axis, or seen through so much
// distortion that no focal length would do.
std::optional<LensParameters> ZhangLens(std::span<const BoardView* const> views, int width_px,
                                        int height_px);

// The pose of a board from the directions to its corners, without refinement. Nothing if the lens
// does not image them, fewer than four are seen, or they are in one line.
std::optional<Rigid3> BoardPose(const BoardView& view, const Lens& lens);

// The best of several starts, refined with one radial coefficient: Zhang's and a ladder of focal
// lengths for kBrown, equidistant lenses for kFisheye. used says which of the views it could take
// in; the others have no pose through it. Nothing if fewer than three.
struct CalibrationStart {
  LensAndBoards estimate;
  std::vector<std::size_t> used;
  double median_rms_px = 0.0;  // of the views
};
std::optional<CalibrationStart> StartCalibration(std::span<const BoardView* const> views,
                                                 LensModel model, int width_px, int height_px);

}  // namespace lodemark
