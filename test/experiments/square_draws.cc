#include "test/experiments/square_draws.h"

#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "test/experiments/photo_bound.h"

namespace lodemark {
namespace {

constexpr double kOrbit_m = 2.2e7;
constexpr double kClock_m = 54'321.0;

struct SkyPlace {
  double azimuth_deg;
  double elevation_deg;
};

// A sky of ten satellites. The first three stand for the paper's G22, G09 and G31: in front of a
// building to the north the east, the west and the south stay free.
constexpr SkyPlace kSky[] = {{100.0, 36.0}, {262.0, 42.0}, {185.0, 55.0}, {320.0, 24.0},
                             {60.0, 22.0},  {210.0, 17.0}, {5.0, 72.0},   {35.0, 48.0},
                             {240.0, 33.0}, {130.0, 62.0}};

struct Standpoint {
  double east_m;
  double north_m;
  double heading_deg;
};

// All look at one building, as in the paper.
constexpr Standpoint kStandpoints[] = {
    {-18.0, -5.0, 12.0}, {10.0, -12.0, -6.0}, {24.0, 9.0, -15.0}, {-2.0, 10.0, 3.0}};
constexpr double kEye_m = 1.5;

// Most lie on the wall in front or what juts out of it by some metres, up to 20 m high; some on the
// ground before it.
Eigen::Vector3d DrawLandmark(const Standpoint& place, double wall_m, Random* random) {
  const double heading_rad = place.heading_deg * kRadiansPerDegree;
  const bool on_ground = random->Uniform() < 0.15;
  const double ahead_m =
      wall_m - (on_ground ? random->Uniform(5.0, 30.0) : random->Uniform(0.0, 4.0));
  const double aside_m = ahead_m * random->Uniform(-0.6, 0.6);
  return {place.east_m + ahead_m * std::sin(heading_rad) + aside_m * std::cos(heading_rad),
          place.north_m + ahead_m * std::cos(heading_rad) - aside_m * std::sin(heading_rad),
          on_ground ? 0.0 : random->Uniform(0.0, 20.0)};
}

}  // namespace

Lens SquareLens() {
  LensParameters parameters;
  parameters.width_px = 1280;
  parameters.height_px = 960;
  parameters.fx_px = parameters.fy_px = 1000.0;
  parameters.cx_px = 639.5;
  parameters.cy_px = 479.5;
  return *Lens::Create(parameters);
}

SquareDraw DrawSquare(const SquareNoise& noise, int landmarks, std::uint64_t seed, int draw) {
  Random random(seed * 1'000'003ULL + static_cast<std::uint64_t>(draw));
  const Lens lens = SquareLens();
  SquareDraw square;
  square.noise = noise;
  square.frame = EnuFrame({30.53 * kRadiansPerDegree, 114.36 * kRadiansPerDegree, 25.0});  // Wuhan
  const Standpoint& place = kStandpoints[draw % 4];
  square.truth_in_enu_m = {place.east_m, place.north_m, kEye_m};
  square.truth_in_ecef = square.frame.ToEcef(square.truth_in_enu_m);
  square.camera_from_enu = LevelCamera(
      (place.heading_deg + random.Uniform(-5.0, 5.0)) * kRadiansPerDegree,
      random.Uniform(-2.0, 6.0) * kRadiansPerDegree, random.Uniform(-2.0, 2.0) * kRadiansPerDegree);

  const Eigen::Vector3d up = square.camera_from_enu * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d across = up.unitOrthogonal();
  square.gravity.sigma_rad = noise.gravity_sigma_rad;
  square.gravity.up_in_camera =
      (up + noise.gravity_sigma_rad *
                (random.Gaussian() * across + random.Gaussian() * up.cross(across)))
          .normalized();

  const double zenith_delay_m = random.Gaussian(0.0, noise.zenith_delay_sigma_m);
  for (const SkyPlace& sky : kSky) {
    const double azimuth_rad = sky.azimuth_deg * kRadiansPerDegree;
    const double elevation_rad = sky.elevation_deg * kRadiansPerDegree;
    const Eigen::Vector3d direction(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                    std::cos(azimuth_rad) * std::cos(elevation_rad),
                                    std::sin(elevation_rad));
    RangeObservation range;
    range.point_in_ecef = square.frame.ToEcef(kOrbit_m * direction);
    range.error.sigma_m =
        std::hypot(noise.elevation_a_m, noise.elevation_b_m / std::sin(elevation_rad));
    range.clock_group = 0;
    range.zenith_delay_factor = 1.0 / std::sin(elevation_rad);
    range.range_m = (range.point_in_ecef - square.truth_in_ecef).norm() + kClock_m +
                    range.zenith_delay_factor * zenith_delay_m +
                    random.Gaussian(0.0, range.error.sigma_m);
    square.satellites.push_back(range);
  }

  const double wall_m = random.Uniform(50.0, 100.0);
  for (int tried = 0; tried < 1000 && static_cast<int>(square.sights.size()) < landmarks; ++tried) {
    const Eigen::Vector3d landmark = DrawLandmark(place, wall_m, &random);
    const Eigen::Vector3d in_camera = square.camera_from_enu * (landmark - square.truth_in_enu_m);
    const std::optional<Eigen::Vector2d> pixel = lens.Project(in_camera);
    if (!pixel || in_camera.z() <= 0.0 || pixel->x() < 0.0 || pixel->x() > 1279.0 ||
        pixel->y() < 0.0 || pixel->y() > 959.0) {
      continue;
    }
    LandmarkSight sight;
    sight.pixel =
        *pixel + noise.pixel_sigma_px * Eigen::Vector2d(random.Gaussian(), random.Gaussian());
    sight.pixel_sigma_px = noise.pixel_sigma_px;
    const double sigma_m = noise.landmark_sigma_m;
    sight.landmark_in_enu_m =
        landmark +
        sigma_m * Eigen::Vector3d(random.Gaussian(), random.Gaussian(), random.Gaussian());
    sight.landmark_covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    square.sights.push_back(sight);
  }
  return square;
}

std::vector<RangeObservation> Visible(const SquareDraw& draw, int count) {
  return {draw.satellites.begin(), draw.satellites.begin() + count};
}

}  // namespace lodemark
