// The camera's pose from landmarks in a photograph.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/capi/eyes.h"
#include "core/capi/guard.h"
#include "core/capi/structs.h"
#include "core/resection/resection.h"
#include "core/resection/unknown_focal.h"
#include "core/resection/visual_ranges.h"

namespace lodemark {
namespace {

// The covariance between the ranges, spread over a matrix by rows for all count sights.
void WriteRangeCovariance(const VisualRanges& ranges, std::size_t count, double* out) {
  for (std::size_t i = 0; i < count * count; ++i) out[i] = 0.0;
  const Eigen::MatrixXd covariance_m2 = ranges.Covariance();
  for (std::size_t i = 0; i < ranges.ranges.size(); ++i) {
    for (std::size_t k = 0; k < ranges.ranges.size(); ++k) {
      out[ranges.ranges[i].sight * count + ranges.ranges[k].sight] =
          covariance_m2(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    }
  }
}

Result<ResectedCamera> Resect(std::span<const LandmarkSight> sights, const Lens& lens,
                              const ResectionPriors& priors, const ResectionOptions& options,
                              bool is_focal_known) {
  if (!is_focal_known) return ResectWithFocal(sights, lens, priors, options);
  Result<ResectedPose> pose = Resect(sights, lens, priors, options);
  if (!pose) return pose.error();
  ResectedCamera camera;
  camera.pose = std::move(*pose);
  camera.focal_px = lens.parameters().fx_px;
  camera.lens = lens;
  return camera;
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_pose_resect(const lodemark_lens* lens, const lodemark_sight* sights,
                                     int32_t count, const lodemark_view_prior* prior,
                                     const lodemark_resect_options* options, lodemark_pose* pose,
                                     lodemark_sight_residual* residuals,
                                     double* range_covariance_m2) {
  using namespace lodemark;
  return Guard([&] {
    std::optional<Lens> known;
    FramedSights framed;
    PhotoPrior photo_prior;
    ResectionOptions resection;
    bool is_focal_known = true;
    lodemark_status status = ReadLens(lens, "lens", &known);
    if (status == LODEMARK_OK) status = ReadSights(sights, count, &framed);
    if (status == LODEMARK_OK) status = ReadPrior(prior, framed.frame, &photo_prior);
    if (status == LODEMARK_OK) status = ReadResectOptions(options, &resection, &is_focal_known);
    if (status == LODEMARK_OK) status = CheckStruct<lodemark_pose>(pose, {"pose"});
    if (status == LODEMARK_OK && residuals != nullptr && count > 0) {
      status = CheckStruct<lodemark_sight_residual>(residuals, {"residuals"});
    }
    if (status != LODEMARK_OK) return status;

    Result<ResectedCamera> camera =
        Resect(framed.sights, *known, photo_prior.resection, resection, is_focal_known);
    if (!camera) return Fail(camera.error());
    const ResectedPose& found = camera->pose;
    const VisualRanges ranges =
        VisualRangesFrom(found, framed.sights, camera->lens ? *camera->lens : *known);
    WriteStruct(ToC(*camera, framed.frame), pose);
    if (residuals != nullptr) {
      const std::vector<lodemark_sight_residual> fared = SightResiduals(found, ranges);
      std::int32_t written = 0;
      WriteList<lodemark_sight_residual>(
          fared.size(), [&](std::size_t i) { return fared[i]; }, residuals, count, &written);
    }
    if (range_covariance_m2 != nullptr) {
      WriteRangeCovariance(ranges, framed.sights.size(), range_covariance_m2);
    }
    return HasPose(found.verdict) ? LODEMARK_OK : LODEMARK_NO_POSITION;
  });
}
