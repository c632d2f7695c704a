// Where differences of Gaussians are extreme.
#pragma once

#include <vector>

#include "core/vision/sift_octave.h"

namespace lodemark {

// In pixels of its octave.
struct SiftExtremum {
  int layer = 0;  // it lies nearest to this one's pixel x, y
  int x = 0;
  int y = 0;
  float x_off_px = 0.0F;  // and off that by so much
  float y_off_px = 0.0F;
  float layer_off = 0.0F;  // likewise
  float response = 0.0F;   // difference of Gaussians there, of grey in 0 .. 1
  float sigma_px = 0.0F;
};

// Those found from the rows begin .. end - 1 on, by rows. The octave must be searchable up to end.
// The rules and thresholds are those of Lowe (2004) section 3.1, 4 and 4.1 as OpenCV sets them:
// contrast 0.04 shared among the scales, edges up to 10.
std::vector<SiftExtremum> FindExtrema(const SiftOctave& octave, int begin, int end);

}  // namespace lodemark
