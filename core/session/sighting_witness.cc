#include "core/session/sighting_witness.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/resection/visual_ranges.h"
#include "core/session/photo_position.h"

namespace lodemark {
namespace {

// Of a bearing, in pixels times its own sigma, where no resection could tell.
constexpr double kUncheckedNoise_px = 2.0;
// That a single look-up result is another landmark, where no resection could tell.
constexpr double kUncheckedWrong = 0.3;

// Ranges of one pose to known landmarks have a covariance of rank three: so many of them, well
// spread, say all that thousands do.
constexpr std::size_t kMostCorrelated = 48;

// Relative to the photograph's own covariance, beyond which another statement is more cautious.
constexpr double kAnyMore = 1e-9;

std::optional<BearingObservation> BearingOf(const LandmarkMatch& match, const EnuFrame& frame,
                                            const Lens& lens, double noise_px) {
  const std::optional<Eigen::Vector3d> direction = lens.Unproject(match.pixel);
  if (!direction) return std::nullopt;
  ProjectionJacobian jacobian;
  if (!lens.Project(*direction, &jacobian)) return std::nullopt;
  BearingObservation bearing;
  bearing.point_in_ecef = frame.ToEcef(match.landmark.position_in_enu_m);
  bearing.point_covariance_enu_m2 = match.landmark.covariance_m2;
  bearing.direction_in_camera = *direction;
  bearing.whitener = jacobian.by_point / (noise_px * match.pixel_sigma_px);
  return bearing;
}

// The part of a covariance that another lacks, positive semidefinite.
Eigen::Matrix3d Beyond(const Eigen::Matrix3d& whole, const Eigen::Matrix3d& part) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(whole - part);
  const Eigen::Vector3d kept = axes.eigenvalues().cwiseMax(kAnyMore * whole.trace());
  return axes.eigenvectors() * kept.asDiagonal() * axes.eigenvectors().transpose();
}

LandmarkVerdict VerdictOf(double weight) {
  if (weight >= 0.5) return LandmarkVerdict::kUsed;
  return weight >= 0.1 ? LandmarkVerdict::kDownWeighted : LandmarkVerdict::kOutlier;
}

}  // namespace

bool SightingWitness::Prepare(const PhotoSighting& sighting, const Displacement& moved,
                              Scheme scheme) {
  moved_ = moved;
  witness_ = nullptr;
  ranges_.clear();
  matches_.clear();
  start_in_ecef_.reset();
  if (scheme == Scheme::kGnss) return false;
  if (sighting.HasPose()) {
    start_in_ecef_ = sighting.frame.ToEcef(sighting.pose.centre_in_enu_m()) - moved_.in_ecef_m;
  }
  const bool by_ranges = scheme == Scheme::kTight || scheme == Scheme::kTightDiagonal;
  if (by_ranges) {
    if (!sighting.HasPose()) return false;
    PrepareVisualRanges(sighting, scheme == Scheme::kTight);
  } else {
    if (!sighting.HasPose() && !sighting.HasLines()) return false;
    PrepareBearings(sighting);
  }
  return !matches_.empty();
}

// What moves all landmarks alike: the receiver's own way since, and the map's datum.
Eigen::Matrix3d SightingWitness::CommonCovariance(const PhotoSighting& sighting) const {
  Eigen::Matrix3d common_m2 = moved_.covariance_enu_m2;
  common_m2.diagonal().array() += sighting.frame_sigma_m * sighting.frame_sigma_m;
  return common_m2;
}

void SightingWitness::PrepareBearings(const PhotoSighting& sighting) {
  const Eigen::Matrix3d common_m2 = CommonCovariance(sighting);
  const bool has_pose = sighting.HasPose();
  const double noise_px = has_pose ? std::max(sighting.pose.noise_px, 1e-3) : kUncheckedNoise_px;
  observations_.clear();
  for (std::size_t i = 0; i < sighting.matches.size(); ++i) {
    if (has_pose && sighting.pose.is_inlier[i] == 0) continue;
    std::optional<BearingObservation> bearing =
        BearingOf(sighting.matches[i], sighting.frame, sighting.lens, noise_px);
    if (!bearing) continue;
    // The camera at the moment of the estimate sees the landmark moved back as it saw it.
    bearing->point_in_ecef -= moved_.in_ecef_m;
    observations_.push_back(*bearing);
    matches_.push_back(i);
  }
  BearingOptions options;
  if (!has_pose) {
    options.wrong_probability = kUncheckedWrong;
    options.proven = sighting.pose.verdict == PoseVerdict::kTooFew;
  }
  options.common_covariance_enu_m2 = common_m2;
  Eigen::Quaterniond camera_from_ecef = Eigen::Quaterniond::Identity();
  if (has_pose) {
    camera_from_ecef = sighting.pose.camera_from_enu.rotation() *
                       Eigen::Quaterniond(sighting.frame.enu_from_ecef());
    // What the resection allows for beyond the noise of its sights: the lens, and what else they
    // have in common.
    bearings_.Set(observations_, sighting.attitude, camera_from_ecef, BearingOptions());
    const PositionStatement alone = bearings_.At(*start_in_ecef_);
    if (alone.Rank(1e3) == 3) {
      options.common_covariance_enu_m2 +=
          Beyond(sighting.pose.covariance.topLeftCorner<3, 3>(), alone.information_pm2.inverse());
    }
  }
  bearings_.Set(observations_, sighting.attitude, camera_from_ecef, options);
  witness_ = &bearings_;
}

void SightingWitness::PrepareVisualRanges(const PhotoSighting& sighting, bool full_covariance) {
  const VisualRanges visual =
      VisualRangesFrom(sighting.pose, SightsFrom(sighting.matches), sighting.lens);
  if (visual.ranges.size() < 3) return;
  const std::size_t step =
      full_covariance ? (visual.ranges.size() + kMostCorrelated - 1) / kMostCorrelated : 1;
  const Eigen::Matrix3d common_m2 = CommonCovariance(sighting);
  const Eigen::Matrix3d of_centre_m2 = visual.centre_covariance_m2 + common_m2;
  points_in_ecef_.clear();
  distances_m_.clear();
  Eigen::MatrixX3d directions(static_cast<Eigen::Index>(visual.ranges.size()), 3);
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < visual.ranges.size(); ++i) {
    const VisualRange& range = visual.ranges[i];
    matches_.push_back(range.sight);
    if (i % step != 0) continue;
    const LandmarkMatch& match = sighting.matches[range.sight];
    const Eigen::Vector3d point_in_ecef =
        sighting.frame.ToEcef(match.landmark.position_in_enu_m) - moved_.in_ecef_m;
    if (full_covariance) {
      points_in_ecef_.push_back(point_in_ecef);
      distances_m_.push_back(range.range_m);
      directions.row(count++) = range.direction_in_enu.transpose();
      continue;
    }
    // Each for itself, with the deviation that the distance model gives it (Xu et al., section 3).
    RangeObservation observation;
    observation.point_in_ecef = point_in_ecef;
    observation.range_m = range.range_m;
    const double modelled_m = visual.model.offset_m + visual.model.slope * range.range_m;
    const double moved_m2 = range.direction_in_enu.dot(common_m2 * range.direction_in_enu);
    observation.error.sigma_m =
        std::sqrt(std::max(modelled_m * std::abs(modelled_m), 1e-6) + moved_m2);
    observation.clock_group = kNoClock;
    ranges_.push_back(observation);
  }
  if (!full_covariance) return;
  const auto used = directions.topRows(count);
  visual_ranges_.Set(points_in_ecef_, distances_m_, used * of_centre_m2 * used.transpose());
  witness_ = &visual_ranges_;
}

void SightingWitness::Judge(const PhotoSighting& sighting,
                            std::span<const ObservationVerdict> range_verdicts,
                            SessionEstimate* estimate,
                            std::vector<LandmarkStatus>* statuses) const {
  ListUnused(sighting, statuses);
  estimate->landmarks_seen = static_cast<std::int32_t>(statuses->size());
  if (estimate->photo != PhotoOutcome::kUsed) return;

  Eigen::Vector3d camera_in_ecef = estimate->position_in_ecef + moved_.in_ecef_m;
  if (witness_ == &bearings_) camera_in_ecef += bearings_.common_shift_in_ecef_m();
  const Eigen::Quaterniond camera_from_ecef =
      witness_ == &bearings_ ? bearings_.camera_from_ecef()
                             : sighting.pose.camera_from_enu.rotation() *
                                   Eigen::Quaterniond(sighting.frame.enu_from_ecef());
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(estimate->position);
  estimate->has_orientation = true;
  estimate->camera_from_enu = camera_from_ecef * Eigen::Quaterniond(enu_from_ecef.transpose());
  // Resection left out what is no match here.
  for (LandmarkStatus& status : *statuses) status.verdict = LandmarkVerdict::kOutlier;
  for (std::size_t k = 0; k < matches_.size(); ++k) {
    LandmarkStatus& status = (*statuses)[matches_[k]];
    if (witness_ == &bearings_) {
      status.weight = bearings_.verdicts()[k].weight;
    } else {
      status.weight = k < range_verdicts.size() ? range_verdicts[k].weight : 1.0;
    }
    status.verdict = VerdictOf(status.weight);
    if (status.verdict == LandmarkVerdict::kUsed) ++estimate->landmarks_used;
  }
  for (LandmarkStatus& status : *statuses) {
    const Eigen::Vector3d ray = status.landmark_in_ecef - camera_in_ecef;
    const std::optional<Eigen::Vector2d> predicted = sighting.lens.Project(camera_from_ecef * ray);
    if (!predicted) continue;
    status.has_residual = true;
    status.residual_px = status.pixel - *predicted;
    status.range_m = ray.norm();
    const Eigen::Vector3d direction = enu_from_ecef * ray / status.range_m;
    status.range_sigma_m = std::sqrt(direction.dot(estimate->covariance_enu_m2 * direction));
  }
}

void ListUnused(const PhotoSighting& sighting, std::vector<LandmarkStatus>* statuses) {
  statuses->clear();
  for (const LandmarkMatch& match : sighting.matches) {
    LandmarkStatus status;
    status.landmark_id = match.landmark.id;
    status.pixel = match.pixel;
    status.landmark_in_ecef = sighting.frame.ToEcef(match.landmark.position_in_enu_m);
    statuses->push_back(status);
  }
}

}  // namespace lodemark
