#include "core/capi/eyes.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

#include "core/base/units.h"
#include "core/capi/check.h"
#include "core/session/accuracy.h"

namespace lodemark {
namespace {

static_assert(LODEMARK_LENS_PINHOLE == static_cast<int>(LensModel::kPinhole));
static_assert(LODEMARK_LENS_BROWN == static_cast<int>(LensModel::kBrown));
static_assert(LODEMARK_LENS_FISHEYE == static_cast<int>(LensModel::kFisheye));
static_assert(LODEMARK_LENS_THIN_PRISM_FISHEYE == static_cast<int>(LensModel::kThinPrismFisheye));
static_assert(LODEMARK_LENS_COEFFICIENTS == kMostLensCoefficients);
static_assert(LODEMARK_LENS_INTRINSICS == kMostIntrinsics);
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajorIntrinsics = Eigen::Matrix<double, kMostIntrinsics, kMostIntrinsics, Eigen::RowMajor>;

constexpr double kLargestSigma_px = 1e4;
constexpr double kSmallestAngle_deg = 1e-6;
constexpr double kDefaultRadius_px = 20.0;
constexpr double kDefaultFarthest_m = 1000.0;

// Landmarks and cameras are on the ground or near it: distances from the earth's centre in metres.
constexpr double kNearestToCentre_m = 6.3e6;
constexpr double kFarthestFromCentre_m = 6.5e6;

void CheckGroundPoint(const double (&point)[3], const char* field, Check* check) {
  check->Point(point, field);
  const double radius_m = Eigen::Map<const Eigen::Vector3d>(point).norm();
  check->True(radius_m > kNearestToCentre_m && radius_m < kFarthestFromCentre_m, field,
              "is not a place on the earth; local coordinates become ECEF by "
              "lodemark_ecef_from_enu");
}

void CheckCovariance(const double (&values)[9], bool definite, const char* field, Check* check) {
  for (const double value : values) check->Within(value, -1e18, 1e18, field);
  if (check->status() != LODEMARK_OK) return;
  const Eigen::Matrix3d matrix = Eigen::Map<const RowMajor3>(values);
  const double scale = matrix.cwiseAbs().maxCoeff();
  check->True((matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale, field,
              "is not symmetric");
  const Eigen::LDLT<Eigen::Matrix3d> factors(matrix);
  const double least = factors.vectorD().minCoeff();
  check->True(definite ? least > 0.0 : least >= -1e-12 * scale, field,
              definite ? "is not positive definite" : "is not a covariance");
}

Eigen::Matrix3d InFrame(const double (&covariance_enu_m2)[9], const Eigen::Matrix3d& rotation) {
  const Eigen::Matrix3d local = Eigen::Map<const RowMajor3>(covariance_enu_m2);
  return rotation * local * rotation.transpose();
}

lodemark_status CheckSight(const lodemark_sight& sight, Where where) {
  Check check(where);
  check.Bits(sight.present, LODEMARK_SIGHT_HAS_COVARIANCE | LODEMARK_SIGHT_HAS_LANDMARK_ID,
             "present");
  check.Reserved(static_cast<std::uint32_t>(sight.reserved));
  for (const double value : sight.pixel_px) check.Within(value, -1e6, 1e6, "pixel_px");
  check.Within(sight.sigma_px, 0.0, kLargestSigma_px, "sigma_px");
  CheckGroundPoint(sight.landmark_in_ecef_m, "landmark_in_ecef_m", &check);
  if ((sight.present & LODEMARK_SIGHT_HAS_COVARIANCE) != 0) {
    CheckCovariance(sight.landmark_covariance_enu_m2, false, "landmark_covariance_enu_m2", &check);
  }
  check.Finite(sight.quality, "quality");
  return check.status();
}

}  // namespace

Eigen::Matrix3d FrameFromLocal(const EnuFrame& frame, const Eigen::Vector3d& place_in_ecef) {
  return frame.enu_from_ecef() * EnuFromEcefRotation(GeodeticFromEcef(place_in_ecef)).transpose();
}

lodemark_status ReadLens(const lodemark_lens* lens, const char* name, std::optional<Lens>* out) {
  lodemark_lens stated = {};
  if (const lodemark_status status = ReadStruct(lens, {name}, &stated); status != LODEMARK_OK) {
    return status;
  }
  Check check({name});
  check.Constant(stated.model, LODEMARK_LENS_THIN_PRISM_FISHEYE, "model");
  if (check.status() != LODEMARK_OK) return check.status();
  LensParameters parameters;
  parameters.model = static_cast<LensModel>(stated.model);
  parameters.width_px = stated.width_px;
  parameters.height_px = stated.height_px;
  parameters.fx_px = stated.fx_px;
  parameters.fy_px = stated.fy_px;
  parameters.cx_px = stated.cx_px;
  parameters.cy_px = stated.cy_px;
  for (std::size_t i = 0; i < parameters.coefficients.size(); ++i) {
    parameters.coefficients[i] = stated.coefficients[i];
  }
  Result<Lens> made = Lens::Create(parameters);
  if (!made) {
    std::string_view reason = made.error().message;
    reason.remove_prefix(std::min(reason.size(), std::string_view("lens: ").size()));
    return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "%s: %.*s", name, static_cast<int>(reason.size()),
                reason.data());
  }
  *out = *made;
  return LODEMARK_OK;
}

lodemark_status ReadPrior(const lodemark_view_prior* prior, const EnuFrame& frame,
                          PhotoPrior* out) {
  if (prior == nullptr) return LODEMARK_OK;
  lodemark_view_prior stated = {};
  if (const lodemark_status status = ReadStruct(prior, {"prior"}, &stated); status != LODEMARK_OK) {
    return status;
  }
  const auto has = [&](std::uint32_t bit) { return (stated.present & bit) != 0; };
  const bool has_position = has(LODEMARK_VIEW_HAS_POSITION);
  Check check({"prior"});
  check.Bits(stated.present,
             LODEMARK_VIEW_HAS_POSITION | LODEMARK_VIEW_HAS_GRAVITY | LODEMARK_VIEW_HAS_HEADING |
                 LODEMARK_VIEW_HAS_ORIENTATION,
             "present");
  check.Within(stated.search_radius_px, 0.0, 65'535.0, "search_radius_px");
  check.Within(stated.farthest_m, 0.0, 1e6, "farthest_m");
  if (has_position) {
    CheckGroundPoint(stated.position_in_ecef_m, "position_in_ecef_m", &check);
    CheckCovariance(stated.position_covariance_enu_m2, true, "position_covariance_enu_m2", &check);
  }
  if (has(LODEMARK_VIEW_HAS_GRAVITY)) {
    check.Point(stated.up_in_camera, "up_in_camera");
    check.True(Eigen::Map<const Eigen::Vector3d>(stated.up_in_camera).norm() > 0.0, "up_in_camera",
               "has no length");
    check.Within(stated.up_sigma_deg, kSmallestAngle_deg, 180.0, "up_sigma_deg");
  }
  if (has(LODEMARK_VIEW_HAS_HEADING)) {
    check.True(has_position, "present", "has HAS_HEADING without HAS_POSITION");
    check.Within(stated.heading_deg, -360.0, 360.0, "heading_deg");
    check.Within(stated.heading_sigma_deg, kSmallestAngle_deg, 180.0, "heading_sigma_deg");
  }
  if (has(LODEMARK_VIEW_HAS_ORIENTATION)) {
    check.True(has_position, "present", "has HAS_ORIENTATION without HAS_POSITION");
    double norm = 0.0;
    for (const double value : stated.camera_from_enu) {
      check.Finite(value, "camera_from_enu");
      norm += value * value;
    }
    check.True(norm > 0.25 && norm < 4.0, "camera_from_enu", "is not a unit quaternion");
  }
  if (check.status() != LODEMARK_OK) return check.status();

  if (has(LODEMARK_VIEW_HAS_GRAVITY)) {
    GravityPrior gravity;
    gravity.up_in_camera = Eigen::Map<const Eigen::Vector3d>(stated.up_in_camera).normalized();
    gravity.sigma_rad = stated.up_sigma_deg * kRadiansPerDegree;
    out->resection.gravity = gravity;
  }
  if (!has_position) return LODEMARK_OK;

  const Eigen::Vector3d place_in_ecef =
      Eigen::Map<const Eigen::Vector3d>(stated.position_in_ecef_m);
  const Eigen::Matrix3d frame_from_local = FrameFromLocal(frame, place_in_ecef);
  ViewPrior view;
  view.position_in_enu_m = frame.FromEcef(place_in_ecef);
  view.position_covariance_m2 = InFrame(stated.position_covariance_enu_m2, frame_from_local);
  view.farthest_m = stated.farthest_m > 0.0 ? stated.farthest_m : kDefaultFarthest_m;
  out->resection.position = PositionPrior{view.position_in_enu_m, view.position_covariance_m2};
  if (has(LODEMARK_VIEW_HAS_HEADING)) {
    view.heading_rad = stated.heading_deg * kRadiansPerDegree;
    view.heading_sigma_rad = stated.heading_sigma_deg * kRadiansPerDegree;
  }
  out->view = view;
  if (has(LODEMARK_VIEW_HAS_ORIENTATION)) {
    const auto& q = stated.camera_from_enu;
    const Eigen::Quaterniond camera_from_local =
        Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
    const Eigen::Quaterniond camera_from_frame(camera_from_local.toRotationMatrix() *
                                               frame_from_local.transpose());
    ExpectedPose expected;
    expected.camera_from_enu =
        Rigid3(camera_from_frame, -(camera_from_frame * view.position_in_enu_m));
    expected.radius_px =
        stated.search_radius_px > 0.0 ? stated.search_radius_px : kDefaultRadius_px;
    out->expected = expected;
  }
  return LODEMARK_OK;
}

lodemark_status ReadResectOptions(const lodemark_resect_options* options, ResectionOptions* out,
                                  bool* is_focal_known) {
  *is_focal_known = true;
  if (options == nullptr) return LODEMARK_OK;
  lodemark_resect_options stated = {};
  if (const lodemark_status status = ReadStruct(options, {"options"}, &stated);
      status != LODEMARK_OK) {
    return status;
  }
  Check check({"options"});
  check.Bits(stated.present, LODEMARK_RESECT_HAS_INTRINSICS_COVARIANCE, "present");
  check.Within(stated.inlier_threshold_px, 0.0, kLargestSigma_px, "inlier_threshold_px");
  check.Within(stated.most_samples, 0, 100'000'000, "most_samples");
  check.Reserved(static_cast<std::uint32_t>(stated.reserved));
  check.Constant(stated.focal, LODEMARK_FOCAL_UNKNOWN, "focal");
  check.Reserved(static_cast<std::uint32_t>(stated.reserved_2));
  const bool has_covariance = (stated.present & LODEMARK_RESECT_HAS_INTRINSICS_COVARIANCE) != 0;
  if (has_covariance) {
    for (const double value : stated.intrinsics_covariance) {
      check.Within(value, -1e12, 1e12, "intrinsics_covariance");
    }
  }
  if (check.status() != LODEMARK_OK) return check.status();
  if (stated.inlier_threshold_px > 0.0) out->inlier_threshold_px = stated.inlier_threshold_px;
  if (stated.seed != 0) out->seed = stated.seed;
  *is_focal_known = stated.focal == LODEMARK_FOCAL_KNOWN;
  if (stated.most_samples > 0) out->most_samples = stated.most_samples;
  if (has_covariance) {
    out->intrinsics_covariance = Eigen::Map<const RowMajorIntrinsics>(stated.intrinsics_covariance);
  }
  return LODEMARK_OK;
}

lodemark_status ReadSights(const lodemark_sight* sights, std::int32_t count, FramedSights* out) {
  const StructArray<lodemark_sight> array(sights, count, "sights");
  if (const lodemark_status status = array.CheckCount(); status != LODEMARK_OK) return status;
  std::vector<lodemark_sight> stated(static_cast<std::size_t>(count));
  Eigen::Vector3d middle_in_ecef = Eigen::Vector3d::Zero();
  const lodemark_status status =
      array.ForEach([&](const lodemark_sight& sight, Where where, std::size_t i) {
        stated[i] = sight;
        middle_in_ecef += Eigen::Map<const Eigen::Vector3d>(sight.landmark_in_ecef_m) / count;
        return CheckSight(sight, where);
      });
  if (status != LODEMARK_OK) return status;
  if (count == 0) return LODEMARK_OK;

  out->frame = EnuFrame(GeodeticFromEcef(middle_in_ecef));
  out->sights.reserve(stated.size());
  for (const lodemark_sight& from : stated) {
    const Eigen::Vector3d landmark_in_ecef =
        Eigen::Map<const Eigen::Vector3d>(from.landmark_in_ecef_m);
    LandmarkSight to;
    to.pixel = Eigen::Map<const Eigen::Vector2d>(from.pixel_px);
    if (from.sigma_px > 0.0) to.pixel_sigma_px = from.sigma_px;
    to.landmark_in_enu_m = out->frame.FromEcef(landmark_in_ecef);
    if ((from.present & LODEMARK_SIGHT_HAS_COVARIANCE) != 0) {
      to.landmark_covariance_m2 =
          InFrame(from.landmark_covariance_enu_m2, FrameFromLocal(out->frame, landmark_in_ecef));
    }
    to.quality = from.quality;
    out->sights.push_back(to);
  }
  return LODEMARK_OK;
}

lodemark_lens ToC(const LensParameters& from) {
  lodemark_lens to = {};
  to.model = static_cast<std::int32_t>(from.model);
  to.width_px = from.width_px;
  to.height_px = from.height_px;
  to.fx_px = from.fx_px;
  to.fy_px = from.fy_px;
  to.cx_px = from.cx_px;
  to.cy_px = from.cy_px;
  std::memcpy(to.coefficients, from.coefficients.data(), sizeof to.coefficients);
  return to;
}

lodemark_sight ToC(const LandmarkMatch& from, const EnuFrame& frame) {
  lodemark_sight to = {};
  to.present = LODEMARK_SIGHT_HAS_COVARIANCE | LODEMARK_SIGHT_HAS_LANDMARK_ID;
  to.landmark_id = from.landmark.id;
  to.pixel_px[0] = from.pixel.x();
  to.pixel_px[1] = from.pixel.y();
  to.sigma_px = from.pixel_sigma_px;
  const Eigen::Vector3d landmark_in_ecef = frame.ToEcef(from.landmark.position_in_enu_m);
  std::memcpy(to.landmark_in_ecef_m, landmark_in_ecef.data(), sizeof to.landmark_in_ecef_m);
  const Eigen::Matrix3d local_from_frame = FrameFromLocal(frame, landmark_in_ecef).transpose();
  const Eigen::Matrix3d covariance =
      local_from_frame * from.landmark.covariance_m2 * local_from_frame.transpose();
  Eigen::Map<RowMajor3>(to.landmark_covariance_enu_m2) =
      0.5 * (covariance + covariance.transpose());
  to.quality = 1.0 - from.ratio;
  return to;
}

}  // namespace lodemark
