#include "core/vision/sift_description.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/hal/hal.hpp>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr int kTurnBins = 36;
constexpr float kTurnSigma = 1.5F;   // of the extremum's
constexpr float kTurnReach = 4.5F;   // likewise
constexpr float kSecondTurn = 0.8F;  // of the highest

constexpr int kCells = 4;  // each way
constexpr int kDirections = 8;
constexpr float kCellWidth = 3.0F;  // of the extremum's sigma
constexpr float kLargestShare = 0.2F;
constexpr float kLength = 512.0F;

// Weights of a Gaussian at whole distances from its middle.
void FillGaussian(int radius, float sigma_px, float* weights) {
  const float scale = -0.5F / (sigma_px * sigma_px);
  for (int i = -radius; i <= radius; ++i) {
    weights[i + radius] = std::exp(static_cast<float>(i * i) * scale);
  }
}

constexpr int kLargestRadius_px = kDescriptorReach_px;

}  // namespace

void SiftDescription::Gradients::Resize(std::size_t count) {
  if (along_x.size() >= count) return;
  for (std::vector<float>* values : {&along_x, &up, &weight, &magnitude, &direction_deg}) {
    values->resize(count);
  }
}

void SiftDescription::Gradients::ToPolar(std::size_t count) {
  const int n = static_cast<int>(count);
  cv::hal::fastAtan32f(up.data(), along_x.data(), direction_deg.data(), n, true);
  cv::hal::magnitude32f(along_x.data(), up.data(), magnitude.data(), n);
}

std::vector<float> SiftDescription::Turns(const SiftOctave& octave, const SiftExtremum& extremum) {
  const int radius =
      std::min(kLargestRadius_px, static_cast<int>(std::lrint(kTurnReach * extremum.sigma_px)));
  std::array<float, 2 * kLargestRadius_px + 1> gaussian;
  FillGaussian(radius, kTurnSigma * extremum.sigma_px, gaussian.data());
  const int left = std::max(1, extremum.x - radius);
  const int right = std::min(octave.width_px() - 2, extremum.x + radius);
  const int top = std::max(1, extremum.y - radius);
  const int bottom = std::min(octave.height_px() - 2, extremum.y + radius);
  if (right < left || bottom < top) return {};
  const std::size_t count =
      static_cast<std::size_t>(right - left + 1) * static_cast<std::size_t>(bottom - top + 1);
  gradients_.Resize(count);
  std::size_t k = 0;
  for (int y = top; y <= bottom; ++y) {
    const float* const above = octave.row(extremum.layer, y - 1);
    const float* const row = octave.row(extremum.layer, y);
    const float* const below = octave.row(extremum.layer, y + 1);
    const float row_weight = gaussian[static_cast<std::size_t>(y - extremum.y + radius)];
    float* const along_x = gradients_.along_x.data() + k;
    float* const up = gradients_.up.data() + k;
    float* const weight = gradients_.weight.data() + k;
    for (int x = left; x <= right; ++x) {
      along_x[x - left] = row[x + 1] - row[x - 1];
      up[x - left] = above[x] - below[x];
      weight[x - left] = row_weight * gaussian[static_cast<std::size_t>(x - extremum.x + radius)];
    }
    k += static_cast<std::size_t>(right - left + 1);
  }
  gradients_.ToPolar(count);

  // With two bins more on either side, so that neighbours need no thought.
  std::array<float, kTurnBins + 4> raw = {};
  for (std::size_t i = 0; i < count; ++i) {
    const int bin = static_cast<int>(
        gradients_.direction_deg[i] * (static_cast<float>(kTurnBins) / 360.0F) + 0.5F);
    raw[static_cast<std::size_t>((bin >= kTurnBins ? bin - kTurnBins : bin) + 2)] +=
        gradients_.weight[i] * gradients_.magnitude[i];
  }
  raw[0] = raw[kTurnBins];
  raw[1] = raw[kTurnBins + 1];
  raw[kTurnBins + 2] = raw[2];
  raw[kTurnBins + 3] = raw[3];
  std::array<float, kTurnBins> bins;
  for (std::size_t i = 0; i < kTurnBins; ++i) {
    bins[i] = (raw[i] + raw[i + 4]) * (1.0F / 16.0F) + (raw[i + 1] + raw[i + 3]) * (4.0F / 16.0F) +
              raw[i + 2] * (6.0F / 16.0F);
  }
  const float least = kSecondTurn * *std::max_element(bins.begin(), bins.end());
  std::vector<float> turns_deg;
  for (std::size_t i = 0; i < kTurnBins; ++i) {
    const float before = bins[(i + kTurnBins - 1) % kTurnBins];
    const float after = bins[(i + 1) % kTurnBins];
    if (bins[i] <= before || bins[i] <= after || bins[i] < least) continue;
    const float peak =
        static_cast<float>(i) + 0.5F * (before - after) / (before - 2.0F * bins[i] + after);
    // The gradients were taken upwards, the turn is clockwise.
    float turn_deg = -peak * (360.0F / kTurnBins);
    if (turn_deg < 0.0F) turn_deg += 360.0F;
    if (turn_deg >= 360.0F) turn_deg -= 360.0F;
    turns_deg.push_back(turn_deg);
  }
  return turns_deg;
}

std::array<std::uint8_t, kSiftLength> SiftDescription::Describe(const SiftOctave& octave,
                                                                const SiftExtremum& extremum,
                                                                float turn_deg) {
  const float cell_px = kCellWidth * extremum.sigma_px;
  const int radius =
      std::min(kDescriptorReach_px - kFarthestMove_px - 2,
               static_cast<int>(std::lrint(cell_px * std::sqrt(2.0F) * (kCells + 1) * 0.5F)));
  std::array<float, 2 * kLargestRadius_px + 1> gaussian;
  FillGaussian(radius, 0.5F * kCells * cell_px, gaussian.data());
  const float counterclockwise_deg = turn_deg > 0.0F ? 360.0F - turn_deg : 0.0F;
  const float turn_rad = counterclockwise_deg * static_cast<float>(kPi / 180.0);
  const float cosine = std::cos(turn_rad) / cell_px;
  const float sine = std::sin(turn_rad) / cell_px;
  const int middle_x =
      static_cast<int>(std::lrint(static_cast<float>(extremum.x) + extremum.x_off_px));
  const int middle_y =
      static_cast<int>(std::lrint(static_cast<float>(extremum.y) + extremum.y_off_px));

  const std::size_t side = static_cast<std::size_t>(2 * radius + 1);
  gradients_.Resize(side * side);
  if (row_bins_.size() < side * side) {
    row_bins_.resize(side * side);
    column_bins_.resize(side * side);
  }
  // A cell's middle is at a whole number; what is a cell or more outside does not count.
  constexpr float kMiddle = 0.5F * kCells - 0.5F;
  std::size_t count = 0;
  const int top = std::max(1 - middle_y, -radius);
  const int bottom = std::min(octave.height_px() - 2 - middle_y, radius);
  const int left = std::max(1 - middle_x, -radius);
  const int right = std::min(octave.width_px() - 2 - middle_x, radius);
  for (int j = top; j <= bottom; ++j) {
    const float* const above = octave.row(extremum.layer, middle_y + j - 1) + middle_x;
    const float* const row = octave.row(extremum.layer, middle_y + j) + middle_x;
    const float* const below = octave.row(extremum.layer, middle_y + j + 1) + middle_x;
    const float row_weight = gaussian[static_cast<std::size_t>(j + radius)];
    const float column_start = kMiddle - static_cast<float>(j) * sine;
    const float row_start = kMiddle + static_cast<float>(j) * cosine;
    for (int i = left; i <= right; ++i) {
      const float column_bin = static_cast<float>(i) * cosine + column_start;
      const float row_bin = static_cast<float>(i) * sine + row_start;
      if (!(row_bin > -1.0F && row_bin < kCells && column_bin > -1.0F && column_bin < kCells)) {
        continue;
      }
      row_bins_[count] = row_bin;
      column_bins_[count] = column_bin;
      gradients_.along_x[count] = row[i + 1] - row[i - 1];
      gradients_.up[count] = above[i] - below[i];
      gradients_.weight[count] = row_weight * gaussian[static_cast<std::size_t>(i + radius)];
      ++count;
    }
  }
  gradients_.ToPolar(count);

  // One cell more on every side and two directions more, for what is shared with those.
  constexpr int kRow = (kCells + 2) * (kDirections + 2);
  std::array<float, (kCells + 2) * kRow> histogram = {};
  for (std::size_t k = 0; k < count; ++k) {
    float direction = (gradients_.direction_deg[k] - counterclockwise_deg) * (kDirections / 360.0F);
    if (direction < 0.0F) direction += kDirections;
    if (direction >= kDirections) direction -= kDirections;
    // All are above -1, so that cutting off rounds down; the last number below kCells rounds up.
    const int row = std::min(static_cast<int>(row_bins_[k] + 1.0F), kCells);
    const int column = std::min(static_cast<int>(column_bins_[k] + 1.0F), kCells);
    const int bin = static_cast<int>(direction);
    const float below = row_bins_[k] + 1.0F - static_cast<float>(row);
    const float right_of = column_bins_[k] + 1.0F - static_cast<float>(column);
    const float beyond = direction - static_cast<float>(bin);

    const float value = gradients_.magnitude[k] * gradients_.weight[k];
    const float lower = value * below;
    const float upper = value - lower;
    const float lower_right = lower * right_of;
    const float lower_left = lower - lower_right;
    const float upper_right = upper * right_of;
    const float upper_left = upper - upper_right;
    float* const at = histogram.data() + row * kRow + column * (kDirections + 2) + bin;
    const auto add = [beyond](float* bins, float share) {
      const float next = share * beyond;
      bins[0] += share - next;
      bins[1] += next;
    };
    add(at, upper_left);
    add(at + kDirections + 2, upper_right);
    add(at + kRow, lower_left);
    add(at + kRow + kDirections + 2, lower_right);
  }

  std::array<float, kSiftLength> values;
  float* value = values.data();
  for (int row = 1; row <= kCells; ++row) {
    for (int column = 1; column <= kCells; ++column) {
      float* const bins = histogram.data() + row * kRow + column * (kDirections + 2);
      bins[0] += bins[kDirections];
      bins[1] += bins[kDirections + 1];
      value = std::copy_n(bins, kDirections, value);
    }
  }
  float square = 0.0F;
  for (const float v : values) square += v * v;
  const float most = std::sqrt(square) * kLargestShare;
  square = 0.0F;
  for (float& v : values) {
    v = std::min(v, most);
    square += v * v;
  }
  const float scale = kLength / std::max(std::sqrt(square), 1.2e-7F);
  std::array<std::uint8_t, kSiftLength> bytes;
  for (std::size_t i = 0; i < kSiftLength; ++i) {
    bytes[i] = static_cast<std::uint8_t>(std::min(values[i] * scale + 0.5F, 255.0F));
  }
  return bytes;
}

}  // namespace lodemark
