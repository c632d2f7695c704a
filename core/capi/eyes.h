// Lenses, sights, priors and poses of the C interface in terms of the modules.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera/lens.h"
#include "core/capi/structs.h"
#include "core/geo/geodetic.h"
#include "core/resection/resection.h"
#include "core/resection/sights.h"
#include "core/resection/unknown_focal.h"
#include "core/resection/visual_ranges.h"
#include "core/session/photo_position.h"
#include "lodemark/lodemark.h"

namespace lodemark {

// Each reads a struct that the caller passed under the given name, and objects to what is wrong.
lodemark_status ReadLens(const lodemark_lens* lens, const char* name, std::optional<Lens>* out);

// NULL is no prior. The frame is the one that positions and orientations come out in.
lodemark_status ReadPrior(const lodemark_view_prior* prior, const EnuFrame& frame, PhotoPrior* out);

// NULL is all defaults. is_focal_known: whether the lens's focal length is the camera's.
lodemark_status ReadResectOptions(const lodemark_resect_options* options, ResectionOptions* out,
                                  bool* is_focal_known);

// Axes of east, north, up at one place in terms of a frame's.
Eigen::Matrix3d FrameFromLocal(const EnuFrame& frame, const Eigen::Vector3d& place_in_ecef);

// The sights in the east-north-up frame at the middle of their landmarks.
struct FramedSights {
  EnuFrame frame{Geodetic{}};
  std::vector<LandmarkSight> sights;
};
lodemark_status ReadSights(const lodemark_sight* sights, std::int32_t count, FramedSights* out);

lodemark_lens ToC(const LensParameters& from);
lodemark_sight ToC(const LandmarkMatch& from, const EnuFrame& frame);
// As Resect gave it for a lens of this focal length, or ResectWithFocal.
lodemark_pose ToC(const ResectedPose& from, const LensParameters& lens, const EnuFrame& frame);
lodemark_pose ToC(const ResectedCamera& from, const EnuFrame& frame);

// How each sight fared; ranges as VisualRangesFrom gives them, in the order of their sights.
std::vector<lodemark_sight_residual> SightResiduals(const ResectedPose& pose,
                                                    const VisualRanges& ranges);

// Whether there is a pose to use.
bool HasPose(PoseVerdict verdict);

}  // namespace lodemark
