// A pose and a focal length that many sights agree on, to adjust from.
#pragma once

#include <optional>
#include <span>

#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/resection/resection.h"
#include "core/resection/sights.h"

namespace lodemark {

struct PoseAndFocal {
  Rigid3 camera_from_enu;
  double focal_px = 0.0;  // of the lens's x axis
};

// The lens with another focal length, that of y in the ratio that the lens has. Nothing if there is
// no such lens.
std::optional<Lens> WithFocal(const Lens& lens, double focal_px);

// By samples of four sights, in an order that owes nothing to the one they came in. Where the lens
// bends, its distortion is undone for focal lengths around the stated one and then for the one
// found. Nothing where no sight agrees beside those of a sample. samples: how many were tried.
std::optional<PoseAndFocal> SearchPoseAndFocal(std::span<const LandmarkSight> sights,
                                               const Lens& lens, const ResectionOptions& options,
                                               int* samples);

}  // namespace lodemark
