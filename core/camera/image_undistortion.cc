#include "core/camera/image_undistortion.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace lodemark {
namespace {

constexpr std::int64_t kMostPixels = 64'000'000;
constexpr int kMostSide_px = 32'766;  // of OpenCV's remap

// Far enough outside every image that nothing of it is blended in, and inside 16 bits.
constexpr float kNowhere_px = -100.0F;

Status CheckSize(const LensParameters& p, const char* which) {
  if (std::int64_t{p.width_px} * p.height_px <= kMostPixels &&
      std::max(p.width_px, p.height_px) <= kMostSide_px) {
    return {};
  }
  return Error{ErrorCode::kUnsupported,
               std::string("undistortion: the ") + which + " image of " +
                   std::to_string(p.width_px) + " by " + std::to_string(p.height_px) +
                   " pixels is too large; 64 megapixels and 32766 a side are served"};
}

// Where in the source a pixel of the target comes from.
cv::Point2f SourceOf(const Lens& source, const LensParameters& target, int x, int y) {
  const LensParameters& p = source.parameters();
  const auto pixel =
      source.Project({(x - target.cx_px) / target.fx_px, (y - target.cy_px) / target.fy_px, 1.0});
  const bool seen = pixel && pixel->x() > -1.0 && pixel->y() > -1.0 && pixel->x() < p.width_px &&
                    pixel->y() < p.height_px;
  if (!seen) return {kNowhere_px, kNowhere_px};
  return {static_cast<float>(pixel->x()), static_cast<float>(pixel->y())};
}

Error FromOpenCv(const std::exception& exception) {
  const auto* const theirs = dynamic_cast<const cv::Exception*>(&exception);
  const bool memory = theirs != nullptr && theirs->code == cv::Error::StsNoMem;
  return {memory ? ErrorCode::kOutOfMemory : ErrorCode::kInternal,
          std::string("undistortion: ") + exception.what()};
}

}  // namespace

// OpenCV's fixed-point form: whole pixels and thirty-seconds of them.
struct ImageUndistortion::Remap {
  int source_width_px = 0;
  int source_height_px = 0;
  cv::Mat whole_px;
  cv::Mat fraction;
};

ImageUndistortion::ImageUndistortion(std::unique_ptr<Remap> remap) : remap_(std::move(remap)) {}
ImageUndistortion::ImageUndistortion(ImageUndistortion&&) noexcept = default;
ImageUndistortion& ImageUndistortion::operator=(ImageUndistortion&&) noexcept = default;
ImageUndistortion::~ImageUndistortion() = default;

Result<ImageUndistortion> ImageUndistortion::Create(const Lens& source, const Lens& target) {
  const LensParameters& to = target.parameters();
  if (to.model != LensModel::kPinhole) {
    return Error{ErrorCode::kInvalidArgument, "undistortion: the target lens is no pinhole"};
  }
  if (Status status = CheckSize(source.parameters(), "source"); !status.ok()) {
    return status.error();
  }
  if (Status status = CheckSize(to, "target"); !status.ok()) return status.error();
  try {
    auto remap = std::make_unique<Remap>();
    remap->source_width_px = source.parameters().width_px;
    remap->source_height_px = source.parameters().height_px;
    remap->whole_px.create(to.height_px, to.width_px, CV_16SC2);
    remap->fraction.create(to.height_px, to.width_px, CV_16UC1);
    cv::Mat row(1, to.width_px, CV_32FC2);
    for (int y = 0; y < to.height_px; ++y) {
      for (int x = 0; x < to.width_px; ++x) {
        row.at<cv::Point2f>(0, x) = SourceOf(source, to, x, y);
      }
      cv::Mat whole_row = remap->whole_px.row(y);
      cv::Mat fraction_row = remap->fraction.row(y);
      cv::convertMaps(row, cv::noArray(), whole_row, fraction_row, CV_16SC2);
    }
    return ImageUndistortion(std::move(remap));
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::kOutOfMemory, "undistortion: not enough memory for the map"};
  } catch (const std::exception& exception) {
    return FromOpenCv(exception);
  }
}

Status ImageUndistortion::Apply(const GrayImage& image, std::span<std::uint8_t> target,
                                std::ptrdiff_t target_stride_bytes) const {
  if (image.pixels == nullptr || image.width_px != remap_->source_width_px ||
      image.height_px != remap_->source_height_px || image.stride_bytes < image.width_px) {
    return Error{ErrorCode::kInvalidArgument, "undistortion: the image is not the lens's " +
                                                  std::to_string(remap_->source_width_px) + " by " +
                                                  std::to_string(remap_->source_height_px) +
                                                  " pixels, or its stride is short"};
  }
  const int width_px = remap_->whole_px.cols;
  const int height_px = remap_->whole_px.rows;
  const std::size_t rows_before_last = static_cast<std::size_t>(height_px) - 1;
  if (target_stride_bytes < width_px || target.size() < static_cast<std::size_t>(width_px) ||
      (target.size() - static_cast<std::size_t>(width_px)) /
              static_cast<std::size_t>(target_stride_bytes) <
          rows_before_last) {
    return Error{ErrorCode::kInvalidArgument, "undistortion: the target has not room for " +
                                                  std::to_string(width_px) + " by " +
                                                  std::to_string(height_px) + " pixels"};
  }
  try {
    // OpenCV reads the source only.
    const cv::Mat from(image.height_px, image.width_px, CV_8UC1,
                       const_cast<std::uint8_t*>(image.pixels),  // NOLINT
                       static_cast<std::size_t>(image.stride_bytes));
    cv::Mat to(height_px, width_px, CV_8UC1, target.data(),
               static_cast<std::size_t>(target_stride_bytes));
    cv::remap(from, to, remap_->whole_px, remap_->fraction, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::kOutOfMemory, "undistortion: not enough memory"};
  } catch (const std::exception& exception) {
    return FromOpenCv(exception);
  }
  return {};
}

}  // namespace lodemark
