#include "core/vision/sift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>

#include "core/base/units.h"
#include "core/vision/sift_description.h"
#include "core/vision/sift_extrema.h"
#include "core/vision/sift_octave.h"

namespace lodemark {
namespace {

// Of the photograph, taken in at once.
constexpr int kRowsAtOnce = 32;

// What a photograph is taken to be blurred by, and hence twice as much once doubled.
constexpr double kPhotoSigma_px = 0.5;

// An octave in which every pixel is at the border holds no extremum.
constexpr int kSmallestOctave_px = 11;

class Sift {
 public:
  explicit Sift(const GrayImage& image) : image_(image) {
    int width_px = 2 * image.width_px;
    int height_px = 2 * image.height_px;
    double given_sigma_px = 2.0 * kPhotoSigma_px;
    while (std::min(width_px, height_px) >= kSmallestOctave_px) {
      octaves_.push_back({SiftOctave(width_px, height_px, given_sigma_px), 0, {}});
      given_sigma_px = kFirstSigma_px;
      width_px /= 2;
      height_px /= 2;
    }
  }

  SiftFeatures Detect() {
    if (octaves_.empty()) return {};
    for (int y = 0; y < image_.height_px; y += kRowsAtOnce) {
      Double(y, std::min(image_.height_px, y + kRowsAtOnce));
      for (std::size_t i = 0; i < octaves_.size(); ++i) {
        SiftOctave& octave = octaves_[i].scales;
        octave.Advance();
        Search(i);
        if (i + 1 < octaves_.size()) Halve(octave, &octaves_[i + 1].scales);
        octave.ForgetBefore(octaves_[i].searched_rows);
      }
    }
    return std::move(features_);
  }

 private:
  struct Octave {
    SiftOctave scales;
    int searched_rows = 0;
    // Row, column and layer of what was found lately: two pixels may lead to one extremum.
    std::set<std::array<int, 3>> found;
  };

  // Rows begin .. end - 1 at twice the resolution; interpolating needs one more on either side.
  void Double(int begin, int end) {
    const int top = std::max(0, begin - 1);
    const int bottom = std::min(image_.height_px, end + 1);
    // OpenCV has no view of constant pixels; nothing writes to them.
    const std::uint8_t* const pixels = image_.pixels + top * image_.stride_bytes;
    const cv::Mat given(bottom - top, image_.width_px, CV_8UC1,
                        const_cast<std::uint8_t*>(pixels),  // NOLINT
                        static_cast<std::size_t>(image_.stride_bytes));
    given.convertTo(grey_, CV_32F);
    cv::resize(grey_, doubled_, cv::Size(), 2.0, 2.0, cv::INTER_LINEAR);
    cv::Mat rows(2 * (end - begin), 2 * image_.width_px, CV_32FC1,
                 octaves_.front().scales.Append(2 * (end - begin)));
    doubled_.rowRange(2 * (begin - top), 2 * (end - top)).copyTo(rows);
  }

  // Every other pixel of the layer that is blurred twice as much as the first.
  static void Halve(const SiftOctave& finer, SiftOctave* coarser) {
    const int begin = coarser->given_rows();
    const int end = std::min(coarser->height_px(), (finer.ready_rows(kScalesInOctave) + 1) / 2);
    if (end <= begin) return;
    float* out = coarser->Append(end - begin);
    for (int y = begin; y < end; ++y) {
      const float* const row = finer.row(kScalesInOctave, 2 * y);
      for (int x = 0; x < coarser->width_px(); ++x) *out++ = row[2 * x];
    }
  }

  void Search(std::size_t index) {
    Octave& octave = octaves_[index];
    const int end = octave.scales.searchable_rows();
    // Doubled pixel x lies at x / 2 - 1/4 of the photograph's, as pixel centres do.
    const float scale = std::ldexp(0.5F, static_cast<int>(index));
    for (const SiftExtremum& extremum : FindExtrema(octave.scales, octave.searched_rows, end)) {
      if (!octave.found.insert({extremum.y, extremum.x, extremum.layer}).second) continue;
      Keypoint keypoint;
      keypoint.x_px = (static_cast<float>(extremum.x) + extremum.x_off_px) * scale - 0.25F;
      keypoint.y_px = (static_cast<float>(extremum.y) + extremum.y_off_px) * scale - 0.25F;
      keypoint.size_px = 2.0F * extremum.sigma_px * scale;
      keypoint.response = extremum.response;
      for (const float turn_deg : description_.Turns(octave.scales, extremum)) {
        keypoint.angle_rad = static_cast<float>(turn_deg * kPi / 180.0);
        const auto histogram = description_.Describe(octave.scales, extremum, turn_deg);
        features_.keypoints.push_back(keypoint);
        features_.histograms.insert(features_.histograms.end(), histogram.begin(), histogram.end());
      }
    }
    octave.searched_rows = std::max(octave.searched_rows, end);
    octave.found.erase(octave.found.begin(),
                       octave.found.lower_bound({end - kFarthestMove_px, 0, 0}));
  }

  const GrayImage image_;
  std::vector<Octave> octaves_;
  cv::Mat grey_;
  cv::Mat doubled_;
  SiftDescription description_;
  SiftFeatures features_;
};

}  // namespace

SiftFeatures DetectSift(const GrayImage& image) { return Sift(image).Detect(); }

}  // namespace lodemark
