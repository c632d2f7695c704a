#include "core/vision/features.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <utility>

#include "core/base/units.h"
#include "core/vision/feature_budget.h"
#include "core/vision/sift.h"
#include "core/vision/sift_description.h"
#include "core/vision/working_size.h"

namespace lodemark {
namespace {

constexpr int kLongestSide_px = 65'535;
constexpr double kMostPixels = 200.0e6;

// Below this there is no octave to look for features in, and OpenCV does not expect it.
constexpr int kShortestSide_px = 16;

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

// In pixels of the image that was looked at; descriptors as Features has them.
struct Detected {
  std::vector<Keypoint> keypoints;
  std::vector<std::uint8_t> descriptors;
};

Detected DetectOrbFeatures(const cv::Mat& image, int most) {
  std::vector<cv::KeyPoint> found;
  cv::Mat rows;
  cv::ORB::create(most, kOrbScale, kOrbLevels, kOrbPatch_px)
      ->detectAndCompute(image, cv::noArray(), found, rows);
  Detected detected;
  detected.keypoints.reserve(found.size());
  for (const cv::KeyPoint& orb : found) {
    // OpenCV gives level pixel u as u * scale. But levels have whole sizes, and are shrunk with the
    // image's edges kept in place.
    const float scale = std::pow(kOrbScale, static_cast<float>(orb.octave));
    const auto in_image = [scale](float position, int size_px) {
      const float level_size_px = std::nearbyint(static_cast<float>(size_px) / scale);
      return (position / scale + 0.5F) * static_cast<float>(size_px) / level_size_px - 0.5F;
    };
    Keypoint keypoint;
    keypoint.x_px = in_image(orb.pt.x, image.cols);
    keypoint.y_px = in_image(orb.pt.y, image.rows);
    keypoint.size_px = orb.size;
    keypoint.angle_rad = static_cast<float>(orb.angle * kPi / 180.0);
    keypoint.response = orb.response;
    detected.keypoints.push_back(keypoint);
  }
  for (int i = 0; i < rows.rows; ++i) {
    const std::uint8_t* const row = rows.ptr<std::uint8_t>(i);
    detected.descriptors.insert(detected.descriptors.end(), row, row + rows.cols);
  }
  return detected;
}

// RootSIFT of Arandjelovic and Zisserman (2012), section 3, in bytes.
void ToRootSift(std::span<std::uint8_t> histogram) {
  float sum = 0.0F;
  for (const std::uint8_t value : histogram) sum += value;
  const float scale = sum > 0.0F ? 1.0F / sum : 0.0F;
  for (std::uint8_t& value : histogram) {
    const float root = std::sqrt(value * scale) * 512.0F;
    value = static_cast<std::uint8_t>(std::min(root + 0.5F, 255.0F));
  }
}

Detected DetectRootSift(const cv::Mat& image) {
  SiftFeatures sift =
      DetectSift({image.data, image.cols, image.rows, static_cast<std::ptrdiff_t>(image.step[0])});
  for (std::size_t i = 0; i < sift.histograms.size(); i += kSiftLength) {
    ToRootSift(std::span(sift.histograms).subspan(i, kSiftLength));
  }
  return {std::move(sift.keypoints), std::move(sift.histograms)};
}

Features Gather(Detected detected, const WorkingImage& working, const GrayImage& image,
                const DetectorOptions& options) {
  const double size_scale = std::sqrt(working.x_scale * working.y_scale);
  for (Keypoint& keypoint : detected.keypoints) {
    keypoint.x_px = static_cast<float>((keypoint.x_px + 0.5) * working.x_scale - 0.5);
    keypoint.y_px = static_cast<float>((keypoint.y_px + 0.5) * working.y_scale - 0.5);
    keypoint.size_px = static_cast<float>(keypoint.size_px * size_scale);
  }
  const std::size_t length = DescriptorBytes(options.kind);
  const std::vector<std::uint32_t> kept =
      SpreadOverImage(detected.keypoints, image.width_px, image.height_px, options.most_features);
  Features features;
  features.kind = options.kind;
  features.keypoints.reserve(kept.size());
  features.descriptors.reserve(kept.size() * length);
  for (const std::uint32_t i : kept) {
    features.keypoints.push_back(detected.keypoints[i]);
    const std::span descriptor = std::span(detected.descriptors).subspan(i * length, length);
    features.descriptors.insert(features.descriptors.end(), descriptor.begin(), descriptor.end());
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
    return Gather(options.kind == DescriptorKind::kOrb
                      ? DetectOrbFeatures(working.pixels, most_found)
                      : DetectRootSift(working.pixels),
                  working, image, options);
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
