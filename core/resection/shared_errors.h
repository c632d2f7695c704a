// What the errors of neighbouring landmarks have in common, as the residuals of one photograph show
// it, and what that does to its pose.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/camera/lens.h"
#include "core/resection/collinearity.h"
#include "core/resection/pose_covariance.h"
#include "core/resection/sights.h"

namespace lodemark {

struct SharedErrors {
  double sigma_m = 0.0;                 // of each coordinate; 0 if nothing shows
  Matrix6d of_pose = Matrix6d::Zero();  // their covariance's share in the pose's
};

// Landmarks triangulated from the same photographs err alike, so hundreds of them say less than
// hundreds of independent ones would. Their errors are taken as a smooth field over space, normal,
// with covariance sigma^2 exp(-distance^2 / (2 reach^2)) on top of what each sight errs by on its
// own. Sigma and reach are averaged over what the means of the residuals of cells of the image
// leave likely once the pose is out of them (restricted likelihood: Patterson and Thompson 1971),
// which tells the part of the field that the pose has swallowed from the part that it could not.
//
// pose_covariance: of the adjustment, were all errors independent, at noise_px. Nothing where
// sights are too few to tell.
SharedErrors FindSharedErrors(const CameraPose& pose, std::span<const LandmarkSight> sights,
                              std::span<const std::uint8_t> is_used, const Lens& lens,
                              double noise_px, const Matrix6d& pose_covariance,
                              const std::optional<IntrinsicsCovariance>& intrinsics);

}  // namespace lodemark
