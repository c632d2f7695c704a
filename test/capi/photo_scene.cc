#include "test/capi/photo_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/map/feature_map_writer.h"
#include "core/vision/features.h"

namespace lodemark::test {
namespace {

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 480;
constexpr double kFocal_px = 520.0;

// How far the wall is along the ray of a pixel: curved, so that no plane explains it.
double Distance_m(double x_px, double y_px) {
  return 14.0 + 3.0 * std::sin(x_px / 90.0) + 2.0 * std::cos(y_px / 70.0);
}

}  // namespace

std::vector<std::uint8_t> Painting(std::uint64_t seed, int width_px, int height_px) {
  Random random(seed);
  std::vector<double> light(
      static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 128.0);
  for (int blob = 0; blob < 900; ++blob) {
    const double x0 = random.Uniform(0.0, width_px);
    const double y0 = random.Uniform(0.0, height_px);
    const double radius_px = random.Uniform(2.0, 14.0);
    const double stretch = random.Uniform(0.5, 2.0);
    const double strength = random.Uniform(-90.0, 90.0);
    const int reach = static_cast<int>(4.0 * radius_px);
    for (int y = std::max(0, static_cast<int>(y0) - reach);
         y < std::min(height_px, static_cast<int>(y0) + reach); ++y) {
      for (int x = std::max(0, static_cast<int>(x0) - reach);
           x < std::min(width_px, static_cast<int>(x0) + reach); ++x) {
        const double u = (x - x0) / (radius_px * stretch);
        const double v = (y - y0) / radius_px;
        light[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
              static_cast<std::size_t>(x)] += strength * std::exp(-0.5 * (u * u + v * v));
      }
    }
  }
  std::vector<std::uint8_t> image(light.size());
  std::transform(light.begin(), light.end(), image.begin(), [](double value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
  });
  return image;
}

PhotoScene::PhotoScene(const std::string& path) : photo(Painting(1, kWidth_px, kHeight_px)) {
  problem = MakeMap(path);
}

std::string PhotoScene::MakeMap(const std::string& path) {
  lens.struct_size = sizeof lens;
  lens.model = LODEMARK_LENS_PINHOLE;
  lens.width_px = kWidth_px;
  lens.height_px = kHeight_px;
  lens.fx_px = lens.fy_px = kFocal_px;
  lens.cx_px = 0.5 * (kWidth_px - 1);
  lens.cy_px = 0.5 * (kHeight_px - 1);
  lodemark_ecef_from_enu(kOrigin_geodetic, kCamera_enu_m, camera_in_ecef_m);

  std::remove(path.c_str());
  MapInfo info;
  info.origin = {kOrigin_geodetic[0] * kRadiansPerDegree, kOrigin_geodetic[1] * kRadiansPerDegree,
                 kOrigin_geodetic[2]};
  info.datum = "WGS84 (G2139)";
  info.epoch_year = 2024.5;
  info.provenance = "painted";
  Result<std::unique_ptr<FeatureMapWriter>> writer = FeatureMapWriter::Create(path, info);
  if (!writer) return writer.error().message;

  const Result<Features> features =
      DetectFeatures({photo.data(), kWidth_px, kHeight_px, kWidth_px}, {});
  if (!features) return features.error().message;
  std::vector<DescriptorOrigin> origins;
  for (const Keypoint& keypoint : features->keypoints) {
    // Axes of the camera in the map: x is east, y is down, z is north.
    const Eigen::Vector3d ray((keypoint.x_px - lens.cx_px) / kFocal_px,
                              (keypoint.y_px - lens.cy_px) / kFocal_px, 1.0);
    const Eigen::Vector3d point = ray.normalized() * Distance_m(keypoint.x_px, keypoint.y_px);
    Landmark landmark;
    landmark.id = static_cast<std::uint32_t>(++landmarks);
    landmark.position_in_enu_m = Eigen::Vector3d(
        kCamera_enu_m[0] + point.x(), kCamera_enu_m[1] + point.z(), kCamera_enu_m[2] - point.y());
    landmark.covariance_m2 = 1e-6 * Eigen::Matrix3d::Identity();
    const Status added = (*writer)->AddLandmark(landmark);
    if (!added) return added.error().message;
    DescriptorOrigin origin;
    origin.landmark_id = landmark.id;
    origin.image_id = 1;
    origins.push_back(origin);
  }
  DatabaseImage image;
  image.id = 1;
  image.name = "wall.jpg";
  const Status image_added = (*writer)->AddImage(image);
  if (!image_added) return image_added.error().message;
  const Status described = (*writer)->AddDescriptors(origins, features->descriptors);
  if (!described) return described.error().message;
  const Status committed = (*writer)->Commit();
  return committed ? std::string() : committed.error().message;
}

}  // namespace lodemark::test
