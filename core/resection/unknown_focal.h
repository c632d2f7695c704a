// A resection where the focal length is one of the unknowns.
#pragma once

#include <optional>
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
  std::optional<Lens> lens;     // the one given, with that focal length
};

// As Resect, for a lens of which all holds but the size of its focal lengths: principal point,
// their ratio and the coefficients of its distortion.
Result<ResectedCamera> ResectWithFocal(std::span<const LandmarkSight> sights, const Lens& lens,
                                       const ResectionPriors& priors,
                                       const ResectionOptions& options);

}  // namespace lodemark
