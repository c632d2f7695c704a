// The size that a photograph's features are looked for at.
#pragma once

#include "core/vision/features.h"

namespace lodemark {

struct WorkingSize {
  int width_px = 0;
  int height_px = 0;
};

// The photograph's own, or smaller in its proportions: so that its longest side is what the options
// allow, and that SIFT has 12.5 megapixels at most, in time as in memory, which is for a few
// hundred of their rows. The size must be one that DetectFeatures takes, the options' longest side
// 0 or more.
WorkingSize WorkingSizeOf(int width_px, int height_px, const DetectorOptions& options);

}  // namespace lodemark
