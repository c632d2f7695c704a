// A painting of soft spots whose picture can be worked out exactly at any place, size and turn.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/camera/gray_image.h"

namespace lodemark::test {

struct Blob {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double sigma = 1.0;
  double contrast = 0.0;  // grey levels at the centre
};

// Turned about the scene's origin from x to y, then scaled, then moved.
struct SceneToImage {
  double turn_rad = 0.0;
  double scale = 1.0;
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();

  Eigen::Vector2d operator*(const Eigen::Vector2d& point) const {
    return scale * (Eigen::Rotation2Dd(turn_rad) * point) + offset_px;
  }
};

// A photograph that owns its pixels.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;
  std::vector<std::uint8_t> pixels;

  GrayImage view() const { return {pixels.data(), width_px, height_px, stride_bytes}; }
};

// Spots of all sizes all over a scene of the given size, many overlapping.
std::vector<Blob> RandomBlobs(std::uint64_t seed, int count, double width, double height);

// Grey 110 with the spots added, each pixel the value at its centre.
Picture Paint(const std::vector<Blob>& blobs, const SceneToImage& image_from_scene, int width_px,
              int height_px);

}  // namespace lodemark::test
