// From light to the bytes of a photograph: blur, exposure, vignetting, noise, tone.
#pragma once

#include <cstdint>

#include "tools/photos/photo_file.h"
#include "tools/renderer/scene_renderer.h"

namespace lodemark {

// How the camera was set and held.
struct FilmOptions {
  double exposure_ev = 0.0;          // beyond what makes the mean a middle grey
  double blur_sigma_px = 0.6;        // of lens and focus
  double shake_px = 0.0;             // length of the way the image made while the shutter was open
  double shake_direction_rad = 0.0;  // in the image, from x towards y
  double vignetting = 0.35;          // light lost in the corners, as a share
  double read_noise = 0.004;         // of full scale
  double electrons = 4'000.0;        // at full scale: fewer, noisier
  double warmth = 0.0;               // -1 bluish .. 1 reddish
  std::uint64_t seed = 1;
};

// Blue, green, red. The same for the same light and options.
Picture Develop(const LightImage& light, const FilmOptions& options);

}  // namespace lodemark
