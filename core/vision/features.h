// Points of a photograph that can be found again, and what they look like.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/camera/gray_image.h"
#include "core/map/descriptor.h"

namespace lodemark {

struct Keypoint {
  float x_px = 0.0F;  // in the photograph as given, whatever resolution it was worked at
  float y_px = 0.0F;
  float size_px = 0.0F;    // diameter of what was looked at
  float angle_rad = 0.0F;  // of the dominant gradient, clockwise from x
  float response = 0.0F;   // contrast: larger is more distinct
};

struct Features {
  DescriptorKind kind = DescriptorKind::kRootSift;
  std::vector<Keypoint> keypoints;
  std::vector<std::uint8_t> descriptors;  // one after another, in the order of the keypoints
};

struct DetectorOptions {
  DescriptorKind kind = DescriptorKind::kRootSift;
  int most_features = 4000;    // kept by contrast, spread over the image
  int longest_side_px = 1600;  // larger ones are scaled down first; 0: as WorkingSizeOf
};

// Error if the image is not one: no pixels, a size not in 1 .. 65535, a stride below the width, or
// more than 200 megapixels. An image that shows nothing has no features, which is no error. The
// same image gives the same features in the same order.
Result<Features> DetectFeatures(const GrayImage& image, const DetectorOptions& options);

}  // namespace lodemark
