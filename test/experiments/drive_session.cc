#include "test/experiments/drive_session.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/units.h"
#include "core/session/epoch_solver.h"
#include "core/session/photo_fusion.h"

namespace lodemark {
namespace {

// Before its epoch, as a camera that does not wait for it.
constexpr std::int64_t kPhotoBefore_ns = 100'000'000;

// Below this, the course is that of before.
constexpr double kStanding_mps = 1.0;

constexpr std::uint32_t kGpsOnly = 1u << static_cast<unsigned>(System::kGps);

Eigen::Matrix3d NoBound() {
  return std::numeric_limits<double>::infinity() * Eigen::Matrix3d::Ones();
}

}  // namespace

DriveSession::DriveSession(const DriveRecording& drive, std::size_t epochs)
    : drive_(drive), epochs_(std::min(epochs, drive.epochs.size())) {
  path_.resize(epochs_);
  bool has_frame = false;
  for (std::size_t i = 0; i < epochs_; ++i) {
    const std::int64_t time_ns = drive.epochs[i].time_gps_ns;
    const std::optional<Eigen::Vector3d> place = drive.TruthAt(time_ns);
    if (!place) {
      if (i > 0) path_[i] = path_[i - 1];
      continue;
    }
    if (!has_frame) frame_ = EnuFrame(GeodeticFromEcef(*place));
    has_frame = true;
    path_[i].in_enu_m = frame_.FromEcef(*place);
    const auto velocity_mps = drive.truth->At(time_ns)->velocity_enu_mps;  // a copy
    const double east_mps = velocity_mps[0].value_or(0.0);
    const double north_mps = velocity_mps[1].value_or(0.0);
    if (std::hypot(east_mps, north_mps) > kStanding_mps) {
      path_[i].heading_rad = std::atan2(east_mps, north_mps);
    } else if (i > 0) {
      path_[i].heading_rad = path_[i - 1].heading_rad;
    }
  }
  RankSatellites();
}

std::vector<std::optional<DrawnPhoto>> DriveSession::Photograph(const Street& street,
                                                                std::uint64_t seed) const {
  const DriveLandmarks landmarks(frame_, path_, street, seed);
  std::vector<std::optional<DrawnPhoto>> photos(epochs_);
  for (std::size_t i = 0; i < epochs_; ++i) {
    const std::int64_t time_ns = drive_.epochs[i].time_gps_ns - kPhotoBefore_ns;
    const std::optional<Eigen::Vector3d> place = drive_.TruthAt(time_ns);
    if (!place) continue;
    photos[i] = landmarks.Photograph(time_ns, {frame_.FromEcef(*place), path_[i].heading_rad});
  }
  return photos;
}

void DriveSession::RankSatellites() {
  SessionOptions options;
  options.scheme = Scheme::kGnss;
  options.systems = kGpsOnly;
  EpochSolver solver(options);
  for (const NavigationRecord& record : drive_.navigation) {
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) solver.orbits().Add(*kepler);
  }
  rankings_.resize(epochs_);
  std::vector<SatelliteStatus> statuses;
  for (std::size_t i = 0; i < epochs_; ++i) {
    SessionEstimate estimate;
    solver.Solve(drive_.epochs[i], {}, &estimate, &statuses);
    // Above the roofs to the left and right a satellite stands by its height over its way across.
    std::vector<std::pair<double, SatelliteId>> free;
    for (const SatelliteStatus& status : statuses) {
      if (!status.has_direction || !status.has_residual) continue;
      const double across = std::cos(status.elevation_rad) *
                            std::abs(std::sin(status.azimuth_rad - path_[i].heading_rad));
      free.emplace_back(-std::atan2(std::sin(status.elevation_rad), across), status.satellite);
    }
    std::stable_sort(free.begin(), free.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [angle, satellite] : free) {
      const bool known =
          std::find(rankings_[i].begin(), rankings_[i].end(), satellite) != rankings_[i].end();
      if (!known) rankings_[i].push_back(satellite);
    }
  }
}

ObservationEpoch DriveSession::Seen(std::size_t epoch, const DriveRun& run) const {
  ObservationEpoch seen = drive_.epochs[epoch];
  if (run.satellites == 0) return seen;
  const Ranking& ranking = rankings_[epoch];
  const auto end = ranking.begin() + static_cast<std::ptrdiff_t>(std::min(
                                         ranking.size(), static_cast<std::size_t>(run.satellites)));
  std::erase_if(seen.signals, [&](const SignalObservation& signal) {
    return std::find(ranking.begin(), end, signal.satellite) == end;
  });
  return seen;
}

std::vector<DriveAnswer> DriveSession::Replay(
    const DriveRun& run, const std::vector<std::optional<DrawnPhoto>>& photos) {
  SessionOptions options;
  options.scheme = run.scheme;
  options.estimator = run.estimator;
  if (!run.all_systems) options.systems = kGpsOnly;
  EpochSolver solver(options);
  for (const NavigationRecord& record : drive_.navigation) {
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) solver.orbits().Add(*kepler);
    if (const auto* sky = std::get_if<IonosphereMessage>(&record)) solver.ionosphere().Add(*sky);
  }
  if (run.all_systems) solver.orbits().Add(*drive_.orbits);
  PhotoFusion fusion(options);
  std::vector<DriveAnswer> answers(epochs_);
  std::vector<SatelliteStatus> statuses;
  std::vector<LandmarkStatus> landmarks;
  for (std::size_t i = 0; i < epochs_; ++i) {
    SessionEstimate& estimate = answers[i].estimate;
    answers[i].bound_enu_m2 = NoBound();
    if (run.scheme != Scheme::kGnss && i < photos.size() && photos[i]) {
      answers[i].bound_enu_m2 = photos[i]->bound_enu_m2;
      fusion.Take(photos[i]->sighting, &solver, &estimate, &landmarks);
      estimate.time_gps_ns = estimate.time_ns;
    }
    ObservationEpoch epoch = Seen(i, run);
    if (run.outage.Holds(i)) {
      // A phone goes on reporting; without a filter nothing comes of it.
      if (run.estimator == Estimator::kEpoch) continue;
      epoch.signals.clear();
    }
    estimate = SessionEstimate();
    estimate.time_ns = estimate.time_gps_ns = epoch.time_gps_ns;
    solver.Solve(epoch, fusion.PartForEpoch(epoch.time_gps_ns), &estimate, &statuses);
    fusion.Judge(solver, &estimate, &landmarks);
    fusion.NoteEpoch(epoch.time_gps_ns, estimate);
  }
  return answers;
}

}  // namespace lodemark
