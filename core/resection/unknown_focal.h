// A resection where the focal length is one of the unknowns.
#pragma once

#include <span>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "core/resection/resection.h"
#include "core/resection/sights.h"

namespace lodemark {

struct ResectedCamera {
  ResectedPose pose;  // its covariance counts what is open of the focal length
  // Where there is a pose: of the lens's x axis, that of y in the ratio that the lens has.
  double focal_px = 0.0;
  double focal_sigma_px = 0.0;  // were the landmarks' errors independent of each other
};

// As Resect, for a lens whose principal point and ratio of focal lengths hold, but not their size.
// Error for one that bends: its distortion cannot be undone before the focal length is known.
Result<ResectedCamera> ResectWithFocal(std::span<const LandmarkSight> sights, const Lens& lens,
                                       const ResectionPriors& priors,
                                       const ResectionOptions& options);

}  // namespace lodemark
