#include "tools/lodemark/report_landmarks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/units.h"

namespace lodemark {
namespace {

// How far from its photograph an estimate may be that still looks at it (docs/formats.md).
constexpr std::int64_t kLongestAway_ns = 1'500'000'000;

// More than any photograph has, and more than a page can draw.
constexpr std::size_t kMostSights = 5000;
constexpr std::size_t kMostLandmarks = 200'000;
constexpr std::size_t kDrawnSights = 600;
constexpr std::size_t kDrawnLandmarks = 6000;

ReportSignalState StateOf(const RunLandmark& row) {
  if (row.used) {
    return row.reason == "down_weighted" ? ReportSignalState::kDownWeighted
                                         : ReportSignalState::kUsed;
  }
  return row.reason == "photo_not_used" ? ReportSignalState::kUnusable
                                        : ReportSignalState::kRejected;
}

bool IsPlace(const RunLandmark& row) {
  return row.latitude_deg && row.longitude_deg && std::abs(*row.latitude_deg) <= 90.0 &&
         std::abs(*row.longitude_deg) <= 360.0;
}

// Every so many of the sights, so that no more than the page can draw are left.
template <typename Sights>
std::size_t StrideOf(const Sights& sights) {
  return std::max<std::size_t>(1, (sights.size() + kDrawnSights - 1) / kDrawnSights);
}

}  // namespace

RunLandmarks::RunLandmarks(std::vector<std::int64_t> photo_times_gps_ns)
    : photo_times_gps_ns_(std::move(photo_times_gps_ns)), photos_(photo_times_gps_ns_.size()) {}

void RunLandmarks::Add(const RunLandmark& row) {
  if (row.time_gps_ns != group_gps_ns_) FinishGroup();
  group_gps_ns_ = row.time_gps_ns;
  const ReportSignalState state = StateOf(row);
  auto found = landmarks_.find(row.landmark_id);
  if (found == landmarks_.end() && landmarks_.size() < kMostLandmarks) {
    found = landmarks_.emplace(row.landmark_id, Seen{}).first;
  }
  if (found != landmarks_.end()) {
    Seen& seen = found->second;
    ++seen.states[static_cast<std::size_t>(state)];
    if (!seen.place_known && IsPlace(row)) {
      seen.place = {*row.latitude_deg * kRadiansPerDegree, *row.longitude_deg * kRadiansPerDegree,
                    row.height_m.value_or(0.0)};
      seen.place_known = true;
    }
  }
  if (group_.size() >= kMostSights) return;
  Sight sight;
  sight.landmark_id = row.landmark_id;
  sight.sight.x_px = row.x_px;
  sight.sight.y_px = row.y_px;
  sight.sight.state = state;
  if (row.residual_x_px && row.residual_y_px && std::isfinite(*row.residual_x_px) &&
      std::isfinite(*row.residual_y_px)) {
    sight.sight.residual_px = std::array{*row.residual_x_px, *row.residual_y_px};
  }
  group_.push_back(sight);
}

void RunLandmarks::FinishGroup() {
  if (!group_.empty() && !photo_times_gps_ns_.empty()) {
    const auto after =
        std::lower_bound(photo_times_gps_ns_.begin(), photo_times_gps_ns_.end(), group_gps_ns_);
    std::size_t nearest = static_cast<std::size_t>(after - photo_times_gps_ns_.begin());
    if (nearest == photo_times_gps_ns_.size() ||
        (nearest > 0 && group_gps_ns_ - photo_times_gps_ns_[nearest - 1] <
                            photo_times_gps_ns_[nearest] - group_gps_ns_)) {
      --nearest;
    }
    const std::int64_t distance_ns = std::abs(photo_times_gps_ns_[nearest] - group_gps_ns_);
    Photo& photo = photos_[nearest];
    if (distance_ns <= kLongestAway_ns &&
        (!photo.distance_ns || distance_ns < *photo.distance_ns)) {
      photo.distance_ns = distance_ns;
      photo.sights = group_;
    }
  }
  group_.clear();
}

void RunLandmarks::Finish() { FinishGroup(); }

void ReportLandmarks::Finish(const EnuFrame& frame, ReportScene* scene,
                             std::vector<ReportRun>* runs) const {
  // All landmarks with a place, in order of their ids, thinned to what can be drawn.
  std::map<std::int64_t, std::size_t> places;
  for (const RunLandmarks* run : runs_) {
    for (const auto& [id, seen] : run->landmarks_) {
      if (seen.place_known) places.emplace(id, 0);
    }
  }
  const std::size_t stride =
      std::max<std::size_t>(1, (places.size() + kDrawnLandmarks - 1) / kDrawnLandmarks);
  std::size_t count = 0;
  std::size_t drawn = 0;
  for (auto& [id, place] : places) {
    place = count++ % stride == 0 ? drawn++ : places.size();
  }
  scene->landmarks.assign(drawn, ReportPlace{});
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const RunLandmarks& run = *runs_[i];
    ReportRun& of = (*runs)[i];
    if (run.empty()) continue;
    of.landmarks.assign(drawn, ReportSignalState::kAbsent);
    for (const auto& [id, seen] : run.landmarks_) {
      const auto found = places.find(id);
      if (found == places.end() || found->second >= drawn) continue;
      if (seen.place_known) {
        const Eigen::Vector3d enu_m = frame.FromEcef(EcefFromGeodetic(seen.place));
        scene->landmarks[found->second] = {enu_m.x(), enu_m.y(), enu_m.z()};
      }
      of.landmarks[found->second] = static_cast<ReportSignalState>(
          std::max_element(seen.states.begin(), seen.states.end()) - seen.states.begin());
    }
    for (std::size_t p = 0; p < run.photos_.size(); ++p) {
      const std::vector<RunLandmarks::Sight>& sights = run.photos_[p].sights;
      if (sights.empty()) continue;
      ReportSights shown;
      shown.photo = p;
      std::vector<double> lengths_px;
      for (std::size_t s = 0; s < sights.size(); ++s) {
        ReportSight sight = sights[s].sight;
        ++shown.counts[static_cast<std::size_t>(sight.state)];
        if (sight.residual_px && sight.state != ReportSignalState::kRejected) {
          lengths_px.push_back(std::hypot((*sight.residual_px)[0], (*sight.residual_px)[1]));
        }
        if (s % StrideOf(sights) != 0) continue;
        const auto found = places.find(sights[s].landmark_id);
        sight.landmark = found != places.end() ? found->second : places.size();
        shown.sights.push_back(sight);
      }
      if (!lengths_px.empty()) {
        const auto middle = lengths_px.begin() + static_cast<std::ptrdiff_t>(lengths_px.size() / 2);
        std::nth_element(lengths_px.begin(), middle, lengths_px.end());
        shown.median_px = *middle;
      }
      of.sights.push_back(std::move(shown));
    }
  }
}

}  // namespace lodemark
