// SIFT keypoints of a photograph of any size, in memory for some hundred of its rows.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera/gray_image.h"
#include "core/vision/features.h"

namespace lodemark {

struct SiftFeatures {
  std::vector<Keypoint> keypoints;       // each once, in no order
  std::vector<std::uint8_t> histograms;  // 128 each, as SiftDescription makes them
};

// Those that Lowe (2004) describes, the image doubled first. Rows come in at the top, go through
// one octave after another and are forgotten when nothing looks at them any more; what is found
// does not depend on how many come at a time. The image must be one; may throw what OpenCV throws.
SiftFeatures DetectSift(const GrayImage& image);

}  // namespace lodemark
