// Lenses of every kind that the camera tests share.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "core/camera/lens.h"

namespace lodemark::test {

struct NamedLens {
  std::string name;
  LensParameters parameters;
};

inline LensParameters Lens1000(LensModel model, double f_px,
                               std::initializer_list<double> coefficients) {
  LensParameters p;
  p.model = model;
  p.width_px = 1000;
  p.height_px = 700;
  p.fx_px = f_px;
  p.fy_px = 1.01 * f_px;
  p.cx_px = 505.0;
  p.cy_px = 340.0;
  std::copy(coefficients.begin(), coefficients.end(), p.coefficients.begin());
  return p;
}

inline std::vector<NamedLens> ManyLenses() {
  using enum LensModel;
  return {
      {"pinhole", Lens1000(kPinhole, 800.0, {})},
      {"barrel", Lens1000(kBrown, 536.0, {-0.28, 0.07})},
      {"barrel five", Lens1000(kBrown, 536.0, {-0.266, -0.0386, 1.78e-3, -2.8e-4, 0.238})},
      {"pincushion", Lens1000(kBrown, 536.0, {0.3, 0.1})},
      {"fold in the image", Lens1000(kBrown, 400.0, {-0.35, 0.05})},
      {"moustache", Lens1000(kBrown, 500.0, {-0.3, 0.5, 0.0, 0.0, -0.05})},
      {"decentred", Lens1000(kBrown, 400.0, {-0.3, 0.09, 0.02, -0.03})},
      {"rational wide", Lens1000(kBrown, 300.0, {0.9, 0.2, 1e-4, 2e-4, 0.01, 1.25, 0.45, 0.05})},
      {"prism", Lens1000(kBrown, 600.0,
                         {-0.2, 0.05, 1e-3, 2e-3, 0.0, 0.0, 0.0, 0.0, 0.02, -0.01, 0.015, 0.01})},
      {"tilted",
       Lens1000(kBrown, 700.0,
                {-0.1, 0.05, 1e-3, 2e-3, 0.0, 0.01, 0.0, 0.0, 1e-3, 1e-3, 2e-3, 1e-3, 0.12, -0.2})},
      {"equidistant", Lens1000(kFisheye, 150.0, {})},
      {"fisheye", Lens1000(kFisheye, 320.0, {-0.02, 0.006, -0.004, 0.0005})},
      {"fisheye 270", Lens1000(kFisheye, 180.0, {0.01, -0.002, 0.0001, -0.00001})},
      {"fisheye fold", Lens1000(kFisheye, 400.0, {-0.15, 0.01})},
      {"thin prism",
       Lens1000(kThinPrismFisheye, 300.0, {-0.02, 0.005, 1e-3, -2e-3, 1e-3, -2e-4, 3e-3, -1e-3})},
      {"thin prism wide",
       Lens1000(kThinPrismFisheye, 170.0, {0.01, -1e-3, 1e-3, -2e-3, 1e-4, -1e-6, 2e-3, 1e-3})},
  };
}

}  // namespace lodemark::test
