// The size that a photograph's features are looked for at.
#pragma once

#include "core/vision/features.h"

namespace lodemark {

struct WorkingSize {
  int width_px = 0;
  int height_px = 0;
};

// The photograph's own, or smaller in its proportions: so that its longest side is what the options
// allow, and that SIFT, which holds some 240 bytes for each pixel at once, takes 3 GB at most. The
// size must be one that DetectFeatures takes, the options' longest side 0 or more.
WorkingSize WorkingSizeOf(int width_px, int height_px, const DetectorOptions& options);

}  // namespace lodemark
