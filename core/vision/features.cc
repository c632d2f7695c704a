#include "core/vision/features.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/base/units.h"
#include "core/vision/feature_budget.h"
#include "core/vision/working_size.h"

namespace lodemark {
namespace {

constexpr int kLongestSide_px = 65'535;
constexpr double kMostPixels = 200.0e6;

// Below this there is no octave to look for features in, and OpenCV does not expect it.
constexpr int kShortestSide_px = 16;

// SIFT doubles the image first with pixel centres kept in place, so that x becomes 2 x + 1/2, but
// OpenCV halves the found positions as though x had become 2 x: all are a quarter pixel too far
// right and down. https://github.com/opencv/opencv/issues/23123; still so by default in 4.12.
constexpr double kSiftShift_px = 0.25;

constexpr float kOrbScale = 1.2F;
constexpr int kOrbLevels = 8;
constexpr int kOrbPatch_px = 31;

Error Invalid(const std::string& message) {
  return {ErrorCode::kInvalidArgument, "image: " + message};
}

Status CheckImage(const GrayImage& image) {
  if (image.width_px < 1 || image.height_px < 1 || image.width_px > kLongestSide_px ||
      image.height_px > kLongestSide_px) {
    return Invalid("size " + std::to_string(image.width_px) + " x " +
                   std::to_string(image.height_px) + " is not in 1 .. 65535");
  }
  if (static_cast<double>(image.width_px) * image.height_px > kMostPixels) {
    return Invalid("more than 200 megapixels");
  }
  if (image.pixels == nullptr) return Invalid("no pixels");
  if (image.stride_bytes < image.width_px) {
    return Invalid("stride of " + std::to_string(image.stride_bytes) + " bytes is below the width");
  }
  return {};
}

// The image at the resolution it is worked at, and how positions lead back.
struct WorkingImage {
  cv::Mat pixels;
  double x_scale = 1.0;  // pixels of the photograph in one of these
  double y_scale = 1.0;
};

WorkingImage ScaleDown(const GrayImage& image, const DetectorOptions& options) {
  // OpenCV has no view of constant pixels; nothing writes to them.
  const cv::Mat given(image.height_px, image.width_px, CV_8UC1,
                      const_cast<std::uint8_t*>(image.pixels),  // NOLINT
                      static_cast<std::size_t>(image.stride_bytes));
  const WorkingSize size = WorkingSizeOf(image.width_px, image.height_px, options);
  if (size.width_px == image.width_px && size.height_px == image.height_px) return {given};
  WorkingImage working;
  cv::resize(given, working.pixels, cv::Size(size.width_px, size.height_px), 0.0, 0.0,
             cv::INTER_AREA);
  working.x_scale = static_cast<double>(image.width_px) / size.width_px;
  working.y_scale = static_cast<double>(image.height_px) / size.height_px;
  return working;
}

struct Detected {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;  // one row each
};

Detected DetectSift(const cv::Mat& image) {
  Detected detected;
  cv::SIFT::create()->detectAndCompute(image, cv::noArray(), detected.keypoints,
                                       detected.descriptors);
  for (cv::KeyPoint& keypoint : detected.keypoints) {
    keypoint.pt.x = static_cast<float>(keypoint.pt.x - kSiftShift_px);
    keypoint.pt.y = static_cast<float>(keypoint.pt.y - kSiftShift_px);
  }
  return detected;
}

Detected DetectOrb(const cv::Mat& image, int most) {
  Detected detected;
  cv::ORB::create(most, kOrbScale, kOrbLevels, kOrbPatch_px)
      ->detectAndCompute(image, cv::noArray(), detected.keypoints, detected.descriptors);
  for (cv::KeyPoint& keypoint : detected.keypoints) {
    // OpenCV gives level pixel u as u * scale. But levels have whole sizes, and are shrunk with the
    // image's edges kept in place.
    const float scale = std::pow(kOrbScale, static_cast<float>(keypoint.octave));
    const auto in_image = [scale](float position, int size_px) {
      const float level_size_px = std::nearbyint(static_cast<float>(size_px) / scale);
      return (position / scale + 0.5F) * static_cast<float>(size_px) / level_size_px - 0.5F;
    };
    keypoint.pt.x = in_image(keypoint.pt.x, image.cols);
    keypoint.pt.y = in_image(keypoint.pt.y, image.rows);
  }
  return detected;
}

// RootSIFT of Arandjelovic and Zisserman (2012), section 3, in bytes.
void WriteRootSift(const float* histogram, std::uint8_t* bytes) {
  constexpr std::size_t kLength = DescriptorBytes(DescriptorKind::kRootSift);
  float sum = 0.0F;
  for (std::size_t i = 0; i < kLength; ++i) sum += histogram[i];
  const float scale = sum > 0.0F ? 1.0F / sum : 0.0F;
  for (std::size_t i = 0; i < kLength; ++i) {
    const float root = std::sqrt(histogram[i] * scale) * 512.0F;
    bytes[i] = static_cast<std::uint8_t>(std::min(root + 0.5F, 255.0F));
  }
}

Features Gather(const Detected& detected, const WorkingImage& working, const GrayImage& image,
                const DetectorOptions& options) {
  const double size_scale = std::sqrt(working.x_scale * working.y_scale);
  std::vector<Keypoint> all;
  all.reserve(detected.keypoints.size());
  for (const cv::KeyPoint& found : detected.keypoints) {
    Keypoint keypoint;
    keypoint.x_px = static_cast<float>((found.pt.x + 0.5) * working.x_scale - 0.5);
    keypoint.y_px = static_cast<float>((found.pt.y + 0.5) * working.y_scale - 0.5);
    keypoint.size_px = static_cast<float>(found.size * size_scale);
    keypoint.angle_rad = static_cast<float>(found.angle * kPi / 180.0);
    keypoint.response = found.response;
    all.push_back(keypoint);
  }

  const std::size_t length = DescriptorBytes(options.kind);
  const std::vector<std::uint32_t> kept =
      SpreadOverImage(all, image.width_px, image.height_px, options.most_features);
  Features features;
  features.kind = options.kind;
  features.keypoints.reserve(kept.size());
  features.descriptors.resize(kept.size() * length);
  std::uint8_t* bytes = features.descriptors.data();
  for (const std::uint32_t i : kept) {
    features.keypoints.push_back(all[i]);
    const int row = static_cast<int>(i);
    if (options.kind == DescriptorKind::kOrb) {
      std::memcpy(bytes, detected.descriptors.ptr<std::uint8_t>(row), length);
    } else {
      WriteRootSift(detected.descriptors.ptr<float>(row), bytes);
    }
    bytes += length;
  }
  return features;
}

}  // namespace

Result<Features> DetectFeatures(const GrayImage& image, const DetectorOptions& options) {
  if (const Status status = CheckImage(image); !status) return status.error();
  if (options.most_features < 1 || options.longest_side_px < 0) {
    return Error{ErrorCode::kInvalidArgument, "detector: a budget or size that is not positive"};
  }
  try {
    const WorkingImage working = ScaleDown(image, options);
    if (std::min(working.pixels.cols, working.pixels.rows) < kShortestSide_px) {
      return Features{options.kind, {}, {}};
    }
    // Twice the budget, for the spread to choose from.
    const int most_found = std::min(options.most_features, 1'000'000) * 2;
    const Detected detected = options.kind == DescriptorKind::kOrb
                                  ? DetectOrb(working.pixels, most_found)
                                  : DetectSift(working.pixels);
    return Gather(detected, working, image, options);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::kOutOfMemory, "image: not enough memory to find its features"};
  } catch (const cv::Exception& exception) {
    const bool memory = exception.code == cv::Error::StsNoMem;
    return Error{memory ? ErrorCode::kOutOfMemory : ErrorCode::kInternal,
                 "image: OpenCV: " + exception.err};
  } catch (const std::exception& exception) {
    return Error{ErrorCode::kInternal, std::string("image: ") + exception.what()};
  }
}

}  // namespace lodemark
