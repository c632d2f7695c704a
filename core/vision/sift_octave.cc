#include "core/vision/sift_octave.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace lodemark {
namespace {

// Rows that come before older ones are moved out: more of them cost memory, fewer time.
constexpr int kSlack_rows = 64;

// Half the width of the kernel, which ends where a Gaussian has fallen to 1/3000.
int RadiusOf(double blur_px) { return static_cast<int>(std::lround(8.0 * blur_px + 1.0)) / 2; }

double LayerSigma_px(int layer) {
  return kFirstSigma_px * std::exp2(static_cast<double>(layer) / kScalesInOctave);
}

double BlurBetween(double from_px, double to_px) {
  return std::sqrt(to_px * to_px - from_px * from_px);
}

// OpenCV has no view of constant numbers; nothing writes to these.
cv::Mat Band(const RowWindow& window, int width_px, int begin, int end) {
  return {end - begin, width_px, CV_32FC1, const_cast<float*>(window.row(begin))};  // NOLINT
}

}  // namespace

SiftOctave::SiftOctave(int width_px, int height_px, double given_sigma_px)
    : width_px_(width_px), height_px_(height_px) {
  if (given_sigma_px < kFirstSigma_px) {
    blurs_px_.push_back(0.0);
    blurs_px_.push_back(BlurBetween(given_sigma_px, kFirstSigma_px));
  } else {
    blurs_px_.push_back(0.0);
  }
  for (int layer = 1; layer < kSiftLayers; ++layer) {
    blurs_px_.push_back(BlurBetween(LayerSigma_px(layer - 1), LayerSigma_px(layer)));
  }

  // How far each window is ahead of the last, hence of what is searched, and how far it goes back.
  std::vector<int> ahead(blurs_px_.size(), 0);
  for (std::size_t i = blurs_px_.size() - 1; i > 0; --i) {
    ahead[i - 1] = ahead[i] + RadiusOf(blurs_px_[i]);
  }
  const std::size_t first = blurs_px_.size() - kSiftLayers;
  const int searched = ahead[first + kScalesInOctave] - kDescriptorReach_px;
  for (std::size_t i = 0; i < blurs_px_.size(); ++i) {
    const bool is_described = i > first && i <= first + kScalesInOctave;
    const int back = i < first      ? 2 * RadiusOf(blurs_px_[i + 1])
                     : is_described ? ahead[i] - searched + kDescriptorReach_px
                                    : ahead[i] - searched + kExtremumReach_px;
    windows_.emplace_back(width_px, std::min(height_px, back + kSlack_rows + 1));
  }
}

void SiftOctave::Advance() {
  for (std::size_t i = 1; i < windows_.size(); ++i) {
    const RowWindow& from = windows_[i - 1];
    const int radius = RadiusOf(blurs_px_[i]);
    const int begin = windows_[i].end();
    const int end = from.end() == height_px_ ? height_px_ : from.end() - radius;
    if (end <= begin) continue;
    // Rows around a part of a matrix are read, not mirrored: the band ends where the picture does,
    // or a radius further.
    const int top = std::max(0, begin - radius);
    const cv::Mat band = Band(from, width_px_, top, std::min(height_px_, end + radius));
    cv::Mat blurred(end - begin, width_px_, CV_32FC1, windows_[i].Append(end - begin));
    cv::GaussianBlur(band.rowRange(begin - top, end - top), blurred,
                     cv::Size(2 * radius + 1, 2 * radius + 1), blurs_px_[i], blurs_px_[i]);
  }
}

int SiftOctave::searchable_rows() const {
  if (ready_rows(kSiftLayers - 1) == height_px_) return height_px_;
  return std::max(0, std::min(ready_rows(kScalesInOctave) - kDescriptorReach_px,
                              ready_rows(kSiftLayers - 1) - kExtremumReach_px));
}

void SiftOctave::ForgetBefore(int y) {
  const std::size_t first = windows_.size() - kSiftLayers;
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    const bool is_described = i > first && i <= first + kScalesInOctave;
    int keep = i < first      ? windows_[i].end()
               : is_described ? y - kDescriptorReach_px
                              : y - kExtremumReach_px;
    if (i + 1 < windows_.size()) {
      keep = std::min(keep, windows_[i + 1].end() - RadiusOf(blurs_px_[i + 1]));
    }
    windows_[i].ForgetBefore(keep);
  }
}

}  // namespace lodemark
