// The camera's pose from landmarks in a photograph, many of them possibly mistaken.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/resection/sights.h"

namespace lodemark {

// What became of a resection. Only kPose and kWeak have a pose to use.
enum class PoseVerdict : std::uint8_t {
  kPose,
  kWeak,        // a pose, but the geometry holds it badly: the covariance says how badly
  kAmbiguous,   // two poses explain the sights equally well: see alternative
  kTooFew,      // fewer sights than a pose needs
  kDegenerate,  // the landmarks do not determine a pose: on one line, all but coincident
  kNotHere,     // no more sights agree than chance explains: this is not that place
};

// "pose", "weak", "ambiguous", ...
std::string_view NameOf(PoseVerdict verdict);

struct ResectionOptions {
  // Times a sight's own sigma: what agrees while a pose is sought. Once it is found, the noise of
  // the sights sets what is mistaken.
  double inlier_threshold_px = 5.0;
  std::uint64_t seed = 1;
  int most_samples = 100'000;
  double wanted_confidence = 0.9999;  // that a better pose was not missed
  // 18 x 18 in the order of ProjectionJacobian::by_intrinsics, zero where a number is held fixed.
  std::optional<Eigen::Matrix<double, kMostIntrinsics, kMostIntrinsics>> intrinsics_covariance;
};

struct ResectedPose {
  PoseVerdict verdict = PoseVerdict::kTooFew;
  Rigid3 camera_from_enu;
  // Of the camera's centre (east, north, up, in m2) and then of small rotations of the camera about
  // east, north and up (rad2): enu_from_camera = exp(rotation) * estimate.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  // The same were the lens known exactly and the landmarks' errors independent of each other.
  Eigen::Matrix<double, 6, 6> covariance_given_lens = Eigen::Matrix<double, 6, 6>::Zero();
  // Of each coordinate of what neighbouring landmarks' errors have in common, as the residuals show
  // it. The covariance counts it.
  double shared_sigma_m = 0.0;
  std::optional<Rigid3> alternative;    // camera_from_enu, when ambiguous
  double noise_px = 0.0;                // of a sight with pixel_sigma_px 1, estimated
  std::vector<std::uint8_t> is_inlier;  // one for each sight
  // Seen minus predicted, one for each sight; not a number where the lens does not image it.
  std::vector<Eigen::Vector2d> residuals_px;
  int inliers = 0;
  // Decimal logarithm of how often random sights would agree so well; -3 is once in a thousand.
  double log10_chance = 0.0;
  int samples = 0;  // tried

  Eigen::Vector3d centre_in_enu_m() const {
    return camera_from_enu.rotation().conjugate() * -camera_from_enu.translation();
  }
};

// Deterministic by seed; the order of the sights matters not, their frame's origin may be as far as
// the earth's centre. Error only for input that is no input: values that are not finite, a sigma
// that is not positive, a covariance that is none.
Result<ResectedPose> Resect(std::span<const LandmarkSight> sights, const Lens& lens,
                            const ResectionPriors& priors, const ResectionOptions& options);

}  // namespace lodemark
