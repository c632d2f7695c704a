// Simulated photographs of landmarks, with mistaken sights.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/random.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/resection/resection.h"
#include "core/resection/sights.h"

namespace lodemark {

struct SceneOptions {
  int sights = 200;
  double outlier_share = 0.4;
  double noise_px = 1.0;
  double nearest_m = 5.0;
  double farthest_m = 60.0;
  std::uint64_t seed = 1;
};

// 1920 by 1080, horizontal field of 65 degrees.
inline Lens SceneLens() {
  LensParameters parameters;
  parameters.width_px = 1920;
  parameters.height_px = 1080;
  parameters.fx_px = 1500.0;
  parameters.fy_px = 1500.0;
  parameters.cx_px = 959.5;
  parameters.cy_px = 539.5;
  return *Lens::Create(parameters);
}

struct ResectionScene {
  Lens lens = SceneLens();
  Rigid3 camera_from_enu;
  Eigen::Vector3d centre_in_enu_m = Eigen::Vector3d::Zero();
  std::vector<LandmarkSight> sights;
  std::vector<std::uint8_t> is_mistaken;
  ResectionPriors priors;  // none, until asked for

  // What a phone and its satellite receiver say.
  void AddGravity(double sigma_rad, Random* random) {
    const Eigen::Vector3d tilt =
        sigma_rad * Eigen::Vector3d(random->Gaussian(), random->Gaussian(), random->Gaussian());
    const Eigen::Vector3d up = camera_from_enu.rotation() * Eigen::Vector3d::UnitZ();
    priors.gravity = GravityPrior{(up + tilt.cross(up)).normalized(), sigma_rad};
  }
  void AddPosition(double sigma_m, Random* random) {
    const Eigen::Vector3d error =
        sigma_m * Eigen::Vector3d(random->Gaussian(), random->Gaussian(), random->Gaussian());
    priors.position =
        PositionPrior{centre_in_enu_m + error, sigma_m * sigma_m * Eigen::Matrix3d::Identity()};
  }
};

// A camera held about level, somewhere within 100 m, looking anywhere.
inline Rigid3 SceneCamera(Random* random) {
  Eigen::Matrix3d level;  // camera from ENU, looking north
  level << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(random->Uniform(-0.2, 0.2), Eigen::Vector3d::UnitZ())) *
      Eigen::Quaterniond(Eigen::AngleAxisd(random->Uniform(-0.2, 0.2), Eigen::Vector3d::UnitX())) *
      Eigen::Quaterniond(level) *
      Eigen::Quaterniond(Eigen::AngleAxisd(random->Uniform(-3.1, 3.1), Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d centre(random->Uniform(-100, 100), random->Uniform(-100, 100),
                               random->Uniform(-10, 10));
  return {rotation, -(rotation * centre)};
}

inline ResectionScene MakeResectionScene(const SceneOptions& options) {
  Random random(options.seed);
  ResectionScene scene;
  scene.camera_from_enu = SceneCamera(&random);
  const Rigid3 enu_from_camera = scene.camera_from_enu.Inverse();
  scene.centre_in_enu_m = enu_from_camera.translation();
  const auto anywhere = [&] {
    return Eigen::Vector2d(random.Uniform(0, 1919), random.Uniform(0, 1079));
  };
  for (int i = 0; i < options.sights; ++i) {
    const Eigen::Vector2d pixel = anywhere();
    const double depth_m = random.Uniform(options.nearest_m, options.farthest_m);
    const Eigen::Vector3d bearing = *scene.lens.Unproject(pixel);
    LandmarkSight sight;
    sight.landmark_in_enu_m = enu_from_camera * (bearing * (depth_m / bearing.z()));
    sight.pixel = pixel + options.noise_px * Eigen::Vector2d(random.Gaussian(), random.Gaussian());
    const bool mistaken = i < options.outlier_share * options.sights;
    if (mistaken) sight.pixel = anywhere();
    scene.sights.push_back(sight);
    scene.is_mistaken.push_back(mistaken ? 1 : 0);
  }
  return scene;
}

}  // namespace lodemark
