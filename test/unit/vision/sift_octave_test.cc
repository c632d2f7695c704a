#include "core/vision/sift_octave.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/base/random.h"
#include "core/vision/sift_description.h"

namespace lodemark {
namespace {

constexpr int kWidth_px = 37;

std::vector<float> RandomPixels(int height_px) {
  Random random(3);
  std::vector<float> pixels(static_cast<std::size_t>(kWidth_px) *
                            static_cast<std::size_t>(height_px));
  for (float& pixel : pixels) pixel = static_cast<float>(random.Uniform(0.0, 255.0));
  return pixels;
}

// All layers of the whole picture, blurred one after another at once.
std::vector<cv::Mat> WholeLayers(std::vector<float>* pixels, double given_sigma_px) {
  const int height_px = static_cast<int>(pixels->size()) / kWidth_px;
  cv::Mat at(height_px, kWidth_px, CV_32FC1, pixels->data());
  std::vector<cv::Mat> layers;
  double sigma_px = given_sigma_px;
  for (int layer = 0; layer < kSiftLayers; ++layer) {
    const double next_px = 1.6 * std::cbrt(std::exp2(layer));
    cv::Mat blurred;
    if (next_px - sigma_px < 1e-9) {
      blurred = at.clone();
    } else {
      cv::GaussianBlur(at, blurred, cv::Size(), std::sqrt(next_px * next_px - sigma_px * sigma_px));
    }
    layers.push_back(blurred);
    at = blurred;
    sigma_px = next_px;
  }
  return layers;
}

// Feeds the picture so many rows at a time and compares every row that may be looked at.
void ExpectWholeLayers(int height_px, int rows_at_once, double given_sigma_px) {
  std::vector<float> pixels = RandomPixels(height_px);
  const std::vector<cv::Mat> whole = WholeLayers(&pixels, given_sigma_px);
  SiftOctave octave(kWidth_px, height_px, given_sigma_px);
  int searched = 0;
  double largest_off = 0.0;
  for (int y = 0; y < height_px; y += rows_at_once) {
    const int rows = std::min(rows_at_once, height_px - y);
    std::copy_n(pixels.begin() + y * kWidth_px, rows * kWidth_px, octave.Append(rows));
    octave.Advance();
    const int end = octave.searchable_rows();
    for (int layer = 0; layer < kSiftLayers; ++layer) {
      const bool is_described = layer >= 1 && layer <= kScalesInOctave;
      const int reach = is_described ? kDescriptorReach_px : kExtremumReach_px;
      if (end <= searched) continue;
      const int bottom = std::min(height_px, end + reach);
      ASSERT_GE(octave.ready_rows(layer), bottom);
      for (int row = std::max(0, searched - reach); row < bottom; ++row) {
        for (int x = 0; x < kWidth_px; ++x) {
          const float expected = whole[static_cast<std::size_t>(layer)].at<float>(row, x);
          largest_off =
              std::max<double>(largest_off, std::abs(octave.row(layer, row)[x] - expected));
        }
      }
    }
    searched = std::max(searched, end);
    octave.ForgetBefore(searched);
  }
  EXPECT_EQ(searched, height_px);
  EXPECT_LT(largest_off, 1e-4) << height_px << " rows, " << rows_at_once << " at once";
}

TEST(SiftOctave, BlursInStepsAsAtOnce) {
  for (const int height_px : {11, 40, 130, 400}) {
    for (const int rows_at_once : {1, 7, 64, 400}) {
      ExpectWholeLayers(height_px, rows_at_once, 1.6);
      ExpectWholeLayers(height_px, rows_at_once, 1.0);
    }
  }
}

// A pixel on the last number below the edge of the cells is rounded up beyond them; sanitizers see
// what is then written where.
TEST(SiftDescription, PixelsOnTheEdgeOfTheCellsStayWithinThem) {
  constexpr int kHeight_px = 37;
  std::vector<float> pixels = RandomPixels(kHeight_px);
  SiftOctave octave(kWidth_px, kHeight_px);
  std::copy(pixels.begin(), pixels.end(), octave.Append(kHeight_px));
  octave.Advance();
  SiftDescription description;
  SiftExtremum extremum;
  extremum.layer = 1;
  extremum.x = kWidth_px / 2;
  extremum.y = kHeight_px / 2;
  for (int pixel = 10; pixel <= 17; ++pixel) {
    // Cells are three sigmas wide, and the outermost ends two and a half of them off the middle.
    float sigma_px = static_cast<float>(pixel) / 7.5F;
    for (int i = 0; i < 64; ++i) sigma_px = std::nextafter(sigma_px, 0.0F);
    for (int i = 0; i < 128; ++i) {
      sigma_px = std::nextafter(sigma_px, 10.0F);
      extremum.sigma_px = sigma_px;
      for (const float turn_deg : {0.0F, 90.0F, 180.0F, 270.0F}) {
        double square = 0.0;
        for (const std::uint8_t value : description.Describe(octave, extremum, turn_deg)) {
          square += static_cast<double>(value) * value;
        }
        ASSERT_NEAR(std::sqrt(square), 512.0, 10.0) << pixel << " " << turn_deg;
      }
    }
  }
}

}  // namespace
}  // namespace lodemark
