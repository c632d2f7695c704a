// A painted surface ready to be looked at from any distance without aliasing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/renderer/canvas.h"

namespace lodemark {

// A canvas and its averages over 2 x 2, 4 x 4 ... texels (Williams 1983, pyramidal parametrics).
class Texture {
 public:
  explicit Texture(const Canvas& canvas);

  // How far, in metres on the surface, one step in either direction of the sensor leads.
  struct Footprint {
    double u_by_x_m = 0.0;
    double v_by_x_m = 0.0;
    double u_by_y_m = 0.0;
    double v_by_y_m = 0.0;
  };

  // The mean over the footprint: several probes along its longer side, each as wide as the shorter.
  // Outside the surface its edge goes on.
  Paint Look(CanvasPoint at, const Footprint& footprint) const;

  double width_m() const { return width_m_; }
  double height_m() const { return height_m_; }

 private:
  struct Level {
    int columns = 0;
    int rows = 0;
    std::vector<std::array<std::uint8_t, 4>> texels;
  };

  // Sum of share times level at a point in texels of level 0.
  void Probe(double column, double row, const Level& level, double scale, float share,
             Paint* sum) const;

  double width_m_;
  double height_m_;
  double texel_m_;
  const std::array<float, 256>& light_;
  std::vector<Level> levels_;
};

}  // namespace lodemark
