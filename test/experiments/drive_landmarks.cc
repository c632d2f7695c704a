#include "test/experiments/drive_landmarks.h"

#include <cmath>
#include <utility>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/session/photo_position.h"
#include "test/experiments/photo_bound.h"
#include "test/experiments/square_draws.h"

namespace lodemark {
namespace {

// Facades, signs and poles: so far aside of the path, so high above the camera.
constexpr double kNearest_m = 6.0;
constexpr double kFarthest_m = 25.0;
constexpr double kLowest_m = -1.5;
constexpr double kHighest_m = 10.0;
// The street goes on beyond the end of the path.
constexpr double kBeyond_m = 100.0;
constexpr double kTilt_rad = 0.02;

Eigen::Vector3d Ahead(double heading_rad) {
  return {std::sin(heading_rad), std::cos(heading_rad), 0.0};
}

Eigen::Vector3d Scatter(double sigma, Random* random) {
  return sigma * Eigen::Vector3d(random->Gaussian(), random->Gaussian(), random->Gaussian());
}

}  // namespace

DriveLandmarks::DriveLandmarks(const EnuFrame& frame, const std::vector<PathPoint>& path,
                               const Street& street, std::uint64_t seed)
    : frame_(frame), street_(street), seed_(seed), lens_(SquareLens()) {
  Random random(seed);
  double left_m = 0.0;  // of the way to the next two
  const auto line = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double heading) {
    const double length_m = (to - from).norm();
    for (; left_m < length_m; left_m += street_.spacing_m) {
      const Eigen::Vector3d foot = from + (to - from) * (left_m / length_m);
      const Eigen::Vector3d right(std::cos(heading), -std::sin(heading), 0.0);
      for (const double side : {-1.0, 1.0}) {
        landmarks_.push_back(foot + side * random.Uniform(kNearest_m, kFarthest_m) * right +
                             random.Uniform(0.0, street_.spacing_m) * Ahead(heading) +
                             random.Uniform(kLowest_m, kHighest_m) * Eigen::Vector3d::UnitZ());
      }
    }
    left_m -= length_m;
  };
  for (std::size_t i = 1; i < path.size(); ++i) {
    line(path[i - 1].in_enu_m, path[i].in_enu_m, path[i - 1].heading_rad);
  }
  const PathPoint& last = path.back();
  line(last.in_enu_m, last.in_enu_m + kBeyond_m * Ahead(last.heading_rad), last.heading_rad);
  for (const Eigen::Vector3d& landmark : landmarks_) {
    mapped_.push_back(landmark + Scatter(street_.noise.landmark_sigma_m, &random));
  }
}

std::optional<DrawnPhoto> DriveLandmarks::Photograph(std::int64_t time_ns,
                                                     const PathPoint& place) const {
  const StreetNoise& noise = street_.noise;
  Random random(seed_ * 7'919ULL + static_cast<std::uint64_t>(time_ns / 1'000'000));
  const Eigen::Quaterniond camera_from_enu = LevelCamera(
      place.heading_rad, random.Gaussian(0.0, kTilt_rad), random.Gaussian(0.0, kTilt_rad));

  PhotoSighting sighting(lens_, frame_);
  sighting.time_ns = time_ns;
  const Eigen::Vector3d up = camera_from_enu * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_seen = (up + Scatter(noise.gravity_sigma_rad, &random)).normalized();
  sighting.attitude.gravity = AttitudePriors::Gravity{up_seen, noise.gravity_sigma_rad};
  sighting.attitude.heading = AttitudePriors::Heading{
      place.heading_rad + random.Gaussian(0.0, noise.heading_sigma_rad), noise.heading_sigma_rad};

  const double width_px = lens_.parameters().width_px - 1.0;
  const double height_px = lens_.parameters().height_px - 1.0;
  std::vector<LandmarkSight> right;  // those that are what they seem, for the bound
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const Eigen::Vector3d ray = landmarks_[i] - place.in_enu_m;
    if (ray.squaredNorm() > street_.farthest_m * street_.farthest_m) continue;
    const Eigen::Vector3d in_camera = camera_from_enu * ray;
    if (in_camera.z() < 1.0) continue;
    const std::optional<Eigen::Vector2d> pixel = lens_.Project(in_camera);
    if (!pixel || pixel->x() < 0.0 || pixel->x() > width_px || pixel->y() < 0.0 ||
        pixel->y() > height_px || random.Uniform() > street_.found ||
        static_cast<int>(sighting.matches.size()) >= street_.most_sights) {
      continue;
    }
    LandmarkMatch match;
    match.landmark.id = static_cast<std::uint32_t>(i + 1);
    match.landmark.position_in_enu_m = mapped_[i];
    match.landmark.covariance_m2 =
        noise.landmark_sigma_m * noise.landmark_sigma_m * Eigen::Matrix3d::Identity();
    match.pixel_sigma_px = noise.pixel_sigma_px;
    match.ratio = random.Uniform(0.3, 0.8);
    match.pixel =
        *pixel + noise.pixel_sigma_px * Eigen::Vector2d(random.Gaussian(), random.Gaussian());
    const bool mismatched = random.Uniform() < noise.mismatched;
    if (mismatched) {
      match.pixel = {random.Uniform(0.0, width_px), random.Uniform(0.0, height_px)};
    }
    sighting.matches.push_back(match);
    if (!mismatched) right.push_back(SightsFrom({match}).front());
  }
  ResectionPriors priors;
  priors.gravity = GravityPrior{up_seen, noise.gravity_sigma_rad};
  Result<ResectedPose> pose = Resect(SightsFrom(sighting.matches), lens_, priors, {});
  if (!pose) return std::nullopt;
  sighting.pose = std::move(*pose);

  Matrix6d information =
      PhotoInformation(right, lens_, camera_from_enu, place.in_enu_m, noise.gravity_sigma_rad);
  information(5, 5) += 1.0 / (noise.heading_sigma_rad * noise.heading_sigma_rad);
  return DrawnPhoto{std::move(sighting), CentreBound(information), CentreInformation(information)};
}

}  // namespace lodemark
