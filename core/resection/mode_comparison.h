// Two poses that explain one photograph: whether they are two, and which is likelier.
#pragma once

#include <optional>
#include <span>

#include "core/camera/lens.h"
#include "core/resection/pose_adjustment.h"
#include "core/resection/sights.h"

namespace lodemark {

// Whether two poses differ by more than what noise does to the first.
bool AreApart(const AdjustedPose& first, const AdjustedPose& second);

struct ModePreference {
  bool second_is_likelier = false;
  bool is_open = false;  // the sights do not say which
};

// By the likelihood of all sights, each normal about its prediction or anywhere in the image; and
// by how many sights agree with one of the two only, since mistaken matches of repeated structure
// are no independent errors.
ModePreference Compare(const AdjustedPose& first, const AdjustedPose& second,
                       std::span<const LandmarkSight> sights, const Lens& lens,
                       const ResectionPriors& priors);

// The second answer of a flat or small target, refined on the same inliers. Nothing where there is
// none: the landmarks are deep, or the descent leads back.
std::optional<CameraPose> ReversedMode(const AdjustedPose& adjusted,
                                       std::span<const LandmarkSight> sights, const Lens& lens,
                                       const ResectionPriors& priors);

}  // namespace lodemark
