#include "core/session/photo_fusion.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/base/units.h"
#include "core/fusion/protection.h"
#include "core/session/map_buildings.h"
#include "core/session/photo_attitude.h"
#include "core/session/stated_accuracy.h"

namespace lodemark {
namespace {

// Photographs that may wait: each is as large as its pixels are many.
constexpr std::size_t kFrames = 4;

// A photograph and an epoch farther apart in time are not adjusted together.
constexpr std::int64_t kReach_ns = 3 * kSecond_ns / 2;

// How long a fix is a prior for the look-up, and how fast one may have gone since, 1 sigma.
constexpr std::int64_t kPriorLasts_ns = 30 * kSecond_ns;
constexpr double kPriorSpeed_mps = 5.0;

// How long a fix tells which walls are around.
constexpr std::int64_t kSightsLast_ns = 3 * kSecond_ns;

// Sigmas that all but the risk of the protection levels stay within.
constexpr double kProtectionSigmas = 4.42;

}  // namespace

PhotoFusion::PhotoFusion(const SessionOptions& options)
    : scheme_(options.scheme),
      estimator_(options.estimator),
      time_base_(options.time_base),
      queue_(kFrames) {}

Status PhotoFusion::UseMap(const FeatureMap* map) {
  map_ = nullptr;
  map_frame_.reset();
  sights_.Use({});
  if (map == nullptr) return {};
  Result<BuildingScene> buildings = BuildingsOf(*map);
  if (!buildings) return buildings.error();
  map_ = map;
  undated_frame_ = FrameForFix(map->info(), std::nullopt);
  sights_.Use(std::move(*buildings));
  return {};
}

SightSource* PhotoFusion::SightsAt(std::int64_t time_ns, std::int64_t time_gps_ns,
                                   EventLog* events) {
  if (!sights_.has_buildings()) return nullptr;
  sights_.Stand(FrameAt(time_gps_ns, events).frame, PredictedPlaceAt(time_ns));
  return &sights_;
}

// Worked out once: within a recording the ground moves by micrometres.
const MapFrame& PhotoFusion::FrameAt(std::int64_t time_gps_ns, EventLog* events) {
  if (map_frame_) return *map_frame_;
  if (time_gps_ns == 0) return undated_frame_;
  map_frame_ = FrameForFix(map_->info(), YearOfGps(time_gps_ns));
  if (!map_frame_->remark.empty()) events->NoteMapDatum(map_frame_->remark);
  return *map_frame_;
}

Status PhotoFusion::Push(const CameraFrame& frame) {
  if (map_ == nullptr) {
    return Error{ErrorCode::kOutOfOrder, "photograph: the session has no map; use one first"};
  }
  const LensParameters& size = frame.lens.parameters();
  if (frame.image.pixels == nullptr || frame.image.width_px != size.width_px ||
      frame.image.height_px != size.height_px || frame.image.stride_bytes < size.width_px) {
    return Error{ErrorCode::kInvalidArgument, "photograph: its size is not that of the lens"};
  }
  if (!queue_.Push(frame)) {
    return Error{ErrorCode::kQueueFull, "session: " + std::to_string(kFrames) +
                                            " photographs wait already; process first"};
  }
  return {};
}

std::optional<PlacePrior> PhotoFusion::PlaceAt(std::int64_t time_ns) const {
  if (!past_.last_fix || std::abs(time_ns - past_.last_fix->time_ns) > kPriorLasts_ns)
    return std::nullopt;
  PlacePrior prior;
  prior.position_in_ecef = past_.last_fix->position_in_ecef;
  prior.covariance_enu_m2 = past_.last_fix->covariance_enu_m2;
  const double gone_m = 1.0 + kPriorSpeed_mps * 1e-9 *
                                  static_cast<double>(std::abs(time_ns - past_.last_fix->time_ns));
  prior.covariance_enu_m2.diagonal().array() += gone_m * gone_m;
  return prior;
}

// The walls around a place need it better known than a look-up does: as long as a velocity holds.
std::optional<PlacePrior> PhotoFusion::PredictedPlaceAt(std::int64_t time_ns) const {
  if (!past_.last_fix || std::abs(time_ns - past_.last_fix->time_ns) > kSightsLast_ns)
    return std::nullopt;
  const Displacement moved = past_.motion.Between(past_.last_fix->time_ns, time_ns);
  PlacePrior prior;
  prior.position_in_ecef = past_.last_fix->position_in_ecef + moved.in_ecef_m;
  prior.covariance_enu_m2 = past_.last_fix->covariance_enu_m2 + moved.covariance_enu_m2;
  return prior;
}

void PhotoFusion::Hold(const SensorBuffer& sensors, const std::optional<DeviceAttitude>& attitude) {
  CameraFrame& frame = queue_.front();
  if (!frame.camera_from_device) return;
  const std::optional<GravityPrior> felt =
      LevelAt(sensors, frame.time_ns, *frame.camera_from_device);
  if (attitude) HoldByAttitude(*attitude, felt, &frame);
  if (!frame.gravity) frame.gravity = felt;
}

void PhotoFusion::Look(EpochSolver* solver, SessionEstimate* estimate,
                       std::vector<LandmarkStatus>* landmarks, EventLog* events) {
  const CameraFrame& frame = queue_.front();
  const std::int64_t time_ns = frame.time_ns;
  SetTime(time_ns, estimate);
  events->SetTime(time_ns, estimate->time_gps_ns);
  estimate->status = EstimateStatus::kTooFewSatellites;
  sighting_.reset();
  if (scheme_ != Scheme::kGnss && map_ != nullptr) {
    const MapFrame& map_frame = FrameAt(estimate->time_gps_ns, events);
    const std::optional<PlacePrior> place = PlaceAt(time_ns);
    sights_.Stand(map_frame.frame, place);
    Result<PhotoSighting> sighting = Sight(*map_, map_frame, frame, place, sights_);
    if (sighting) {
      sighting_ = std::move(*sighting);
    } else {
      events->NotePhotoFailed(sighting.error().message);
    }
  }
  queue_.Pop();
  if (sighting_ || estimator_ != Estimator::kEpoch) {
    EstimateAtSighting(solver, estimate, landmarks);
  }
}

void PhotoFusion::SetTime(std::int64_t time_ns, SessionEstimate* estimate) const {
  estimate->time_ns = time_ns;
  if (time_base_ == TimeBase::kGps) {
    estimate->time_gps_ns = time_ns;
  } else if (past_.epoch_gps_ns != 0) {
    estimate->time_gps_ns = past_.epoch_gps_ns + (time_ns - past_.epoch_ns);
  }
}

void PhotoFusion::Take(PhotoSighting sighting, EpochSolver* solver, SessionEstimate* estimate,
                       std::vector<LandmarkStatus>* landmarks) {
  estimate->time_ns = sighting.time_ns;
  estimate->status = EstimateStatus::kTooFewSatellites;
  sighting_ = std::move(sighting);
  EstimateAtSighting(solver, estimate, landmarks);
}

void PhotoFusion::TakeAgain(std::int64_t time_ns, const std::optional<PhotoSighting>& sighting,
                            EpochSolver* solver, SessionEstimate* estimate,
                            std::vector<LandmarkStatus>* landmarks) {
  SetTime(time_ns, estimate);
  estimate->status = EstimateStatus::kTooFewSatellites;
  sighting_ = sighting;
  EstimateAtSighting(solver, estimate, landmarks);
}

// Estimated at the moment of the epoch, then carried to that of the photograph.
void PhotoFusion::EstimateAtSighting(EpochSolver* solver, SessionEstimate* estimate,
                                     std::vector<LandmarkStatus>* landmarks) {
  const std::int64_t time_ns = estimate->time_ns;
  const bool with_epoch = past_.has_epoch && std::abs(time_ns - past_.epoch_ns) <= kReach_ns &&
                          scheme_ != Scheme::kVision;
  std::int64_t at_ns = with_epoch ? past_.epoch_ns : time_ns;
  if (estimator_ != Estimator::kEpoch) at_ns = solver->MomentFor(at_ns, kReach_ns);
  const PhotoPart& part = PartAt(at_ns);
  estimate->time_ns = at_ns;
  solver->SolvePhoto(part, with_epoch, estimate);
  estimate->time_ns = time_ns;
  Judge(*solver, estimate, landmarks);
  if (estimate->status != EstimateStatus::kFix) return;
  if (at_ns != time_ns) {
    const Displacement moved = past_.motion.Between(at_ns, time_ns);
    estimate->position_in_ecef += moved.in_ecef_m;
    estimate->position = GeodeticFromEcef(estimate->position_in_ecef);
    estimate->covariance_enu_m2 += moved.covariance_enu_m2;
    StateAccuracy(estimate);
    if (estimate->protection_level_m > 0.0) {
      estimate->protection_level_m += kProtectionSigmas * HorizontalSigma(moved.covariance_enu_m2);
    }
    if (estimate->vertical_protection_level_m > 0.0) {
      estimate->vertical_protection_level_m +=
          kProtectionSigmas * std::sqrt(moved.covariance_enu_m2(2, 2));
    }
  }
  past_.last_fix = *estimate;
  // The place by itself, not the estimate's, which has been carried from one moment to the other.
  if (estimate->photo == PhotoOutcome::kUsed && sighting_->HasPose()) {
    past_.motion.LearnPlace(time_ns, sighting_->frame.ToEcef(sighting_->pose.centre_in_enu_m()),
                            sighting_->pose.covariance.topLeftCorner<3, 3>());
  }
}

const PhotoPart& PhotoFusion::PartForEpoch(std::int64_t time_ns) {
  if (estimator_ == Estimator::kEpoch) return PartAt(time_ns);
  part_ = PhotoPart();
  sighting_near_ = false;
  return part_;
}

const PhotoPart& PhotoFusion::PartAt(std::int64_t time_ns) {
  part_ = PhotoPart();
  sighting_near_ = sighting_ && std::abs(sighting_->time_ns - time_ns) <= kReach_ns;
  if (!sighting_near_) return part_;
  const Displacement moved = past_.motion.Between(time_ns, sighting_->time_ns);
  if (!witness_.Prepare(*sighting_, moved, scheme_)) return part_;
  part_.witness = witness_.witness();
  part_.ranges = witness_.ranges();
  part_.start_in_ecef = witness_.start_in_ecef();
  part_.taken_ns = sighting_->time_ns;
  return part_;
}

void PhotoFusion::Judge(const EpochSolver& solver, SessionEstimate* estimate,
                        std::vector<LandmarkStatus>* landmarks) const {
  if (!sighting_near_) return;
  if (part_.empty()) {
    estimate->photo = PhotoOutcome::kNotRecognised;
    ListUnused(*sighting_, landmarks);
    estimate->landmarks_seen = static_cast<std::int32_t>(landmarks->size());
    return;
  }
  witness_.Judge(*sighting_, solver.visual_verdicts(), estimate, landmarks);
}

void PhotoFusion::NoteEpoch(std::int64_t time_gps_ns, const SessionEstimate& estimate) {
  past_.has_epoch = true;
  past_.epoch_ns = estimate.time_ns;
  past_.epoch_gps_ns = time_gps_ns;
  past_.motion.Learn(estimate);
  if (estimate.status == EstimateStatus::kFix) past_.last_fix = estimate;
}

void PhotoFusion::Forget() {
  queue_.Clear();
  sighting_.reset();
  sighting_near_ = false;
  past_ = Memory();
}

}  // namespace lodemark
