// Boards seen through a known lens, for the tests of calibration.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/camera/board_view.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"

namespace lodemark::test {

inline constexpr int kSceneColumns = 9;
inline constexpr int kSceneRows = 6;
inline constexpr double kSceneSquare_m = 0.025;

// Somewhere in front of the camera, tilted by up to 45 degrees, the board's middle within the
// given angle from the axis.
inline Rigid3 RandomBoardPose(double reach_rad, Random* random) {
  const Eigen::Vector3d axis(random->Uniform(-1.0, 1.0), random->Uniform(-1.0, 1.0), 0.0);
  const Eigen::Quaterniond tilt(
      Eigen::AngleAxisd(45.0 * kRadiansPerDegree * random->Uniform(), axis.normalized()));
  const Eigen::Quaterniond roll(
      Eigen::AngleAxisd(random->Uniform(-0.5, 0.5), Eigen::Vector3d::UnitZ()));
  const double azimuth_rad = random->Uniform(-kPi, kPi);
  const Eigen::Quaterniond aside(
      Eigen::AngleAxisd(reach_rad * std::sqrt(random->Uniform()),
                        Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0)));
  const Eigen::Vector3d middle(0.5 * (kSceneColumns - 1) * kSceneSquare_m,
                               0.5 * (kSceneRows - 1) * kSceneSquare_m, 0.0);
  const Eigen::Quaterniond rotation = aside * tilt * roll;
  const Eigen::Vector3d place = aside * Eigen::Vector3d(0.0, 0.0, random->Uniform(0.2, 0.5));
  return {rotation, place - rotation * middle};
}

// The corners with noise; without corners if not all are inside the image.
inline BoardView SeeBoard(const Lens& lens, const Rigid3& camera_from_board, double noise_px,
                          Random* random) {
  BoardView view;
  for (int row = 0; row < kSceneRows; ++row) {
    for (int column = 0; column < kSceneColumns; ++column) {
      const Eigen::Vector2d board_m(column * kSceneSquare_m, row * kSceneSquare_m);
      const auto pixel =
          lens.Project(camera_from_board * Eigen::Vector3d(board_m.x(), board_m.y(), 0.0));
      if (!pixel || pixel->minCoeff() < 0.0 || pixel->x() > lens.parameters().width_px - 1 ||
          pixel->y() > lens.parameters().height_px - 1) {
        return {};
      }
      view.corners.push_back(
          {board_m, *pixel + noise_px * Eigen::Vector2d(random->Gaussian(), random->Gaussian())});
    }
  }
  return view;
}

// As many boards as asked for, everywhere in the image.
inline std::vector<BoardView> SeeBoards(const Lens& lens, int count, double noise_px,
                                        std::uint64_t seed, double reach_rad = 0.6) {
  Random random(seed);
  std::vector<BoardView> views;
  while (static_cast<int>(views.size()) < count) {
    BoardView view = SeeBoard(lens, RandomBoardPose(reach_rad, &random), noise_px, &random);
    if (view.corners.empty()) continue;
    view.name = "photo " + std::to_string(views.size() + 1);
    views.push_back(std::move(view));
  }
  return views;
}

inline Eigen::VectorXd IntrinsicsOf(const LensParameters& lens) {
  Eigen::VectorXd values(4 + CoefficientCount(lens.model));
  values.head<4>() << lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px;
  for (int i = 0; i < CoefficientCount(lens.model); ++i) {
    values[4 + i] = lens.coefficients[static_cast<std::size_t>(i)];
  }
  return values;
}

}  // namespace lodemark::test
