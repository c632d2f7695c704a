// A picture of a calibration: where in the image the boards were, and how far off each corner is.
#pragma once

#include <span>
#include <string>

#include "core/base/result.h"
#include "core/camera/board_view.h"
#include "core/camera/calibration.h"

namespace lodemark {

// A PNG or JPEG by the ending of path: cells of the image shaded by the corners seen in them, and
// the residuals of the views used, enlarged and coloured by their length.
Status DrawCalibration(const Calibration& calibration, std::span<const BoardView> views,
                       const std::string& path);

}  // namespace lodemark
