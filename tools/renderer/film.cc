#include "tools/renderer/film.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/random.h"

namespace lodemark {
namespace {

constexpr float kMiddleGrey = 0.33F;

std::size_t Index(int x_px, int y_px, int width_px) {
  return static_cast<std::size_t>(y_px) * static_cast<std::size_t>(width_px) +
         static_cast<std::size_t>(x_px);
}

// Weights from -reach to reach, 1 together.
std::vector<float> GaussianWeights(double sigma_px) {
  const int reach = std::clamp(static_cast<int>(std::ceil(3.0 * sigma_px)), 1, 30);
  std::vector<float> weights;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    const double weight = std::exp(-0.5 * i * i / (sigma_px * sigma_px));
    weights.push_back(static_cast<float>(weight));
    sum += weight;
  }
  for (float& weight : weights) weight /= static_cast<float>(sum);
  return weights;
}

void BlurRow(const Colour* row, int count, std::ptrdiff_t stride, const std::vector<float>& weights,
             std::vector<Colour>* to) {
  const int reach = static_cast<int>(weights.size() / 2);
  for (int i = 0; i < count; ++i) {
    Colour sum;
    for (int k = -reach; k <= reach; ++k) {
      const int from = std::clamp(i + k, 0, count - 1);
      sum += weights[static_cast<std::size_t>(k + reach)] * row[from * stride];
    }
    (*to)[static_cast<std::size_t>(i)] = sum;
  }
}

void Blur(double sigma_px, LightImage* image) {
  if (sigma_px < 0.05) return;
  const std::vector<float> weights = GaussianWeights(sigma_px);
  std::vector<Colour> line(static_cast<std::size_t>(std::max(image->width_px, image->height_px)));
  for (int y_px = 0; y_px < image->height_px; ++y_px) {
    Colour* const row = &image->pixels[Index(0, y_px, image->width_px)];
    BlurRow(row, image->width_px, 1, weights, &line);
    std::copy_n(line.begin(), image->width_px, row);
  }
  for (int x_px = 0; x_px < image->width_px; ++x_px) {
    Colour* const column = &image->pixels[static_cast<std::size_t>(x_px)];
    BlurRow(column, image->height_px, image->width_px, weights, &line);
    for (int y_px = 0; y_px < image->height_px; ++y_px) {
      column[Index(0, y_px, image->width_px)] = line[static_cast<std::size_t>(y_px)];
    }
  }
}

Colour Between(const LightImage& image, double x_px, double y_px) {
  const double x = std::clamp(x_px, 0.0, image.width_px - 1.0);
  const double y = std::clamp(y_px, 0.0, image.height_px - 1.0);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width_px - 1);
  const int y1 = std::min(y0 + 1, image.height_px - 1);
  const auto fx = static_cast<float>(x - x0);
  const auto fy = static_cast<float>(y - y0);
  const auto at = [&](int i, int k) { return image.pixels[Index(i, k, image.width_px)]; };
  return Mix(Mix(at(x0, y0), at(x1, y0), fx), Mix(at(x0, y1), at(x1, y1), fx), fy);
}

// The mean along the way of the shake.
void Shake(double length_px, double direction_rad, LightImage* image) {
  if (length_px < 0.2) return;
  const LightImage still = *image;
  const int steps = std::clamp(static_cast<int>(std::ceil(length_px)) + 1, 2, 64);
  for (int y_px = 0; y_px < image->height_px; ++y_px) {
    for (int x_px = 0; x_px < image->width_px; ++x_px) {
      Colour sum;
      for (int i = 0; i < steps; ++i) {
        const double along = length_px * (static_cast<double>(i) / (steps - 1) - 0.5);
        sum += (1.0F / static_cast<float>(steps)) * Between(still,
                                                            x_px + along * std::cos(direction_rad),
                                                            y_px + along * std::sin(direction_rad));
      }
      image->pixels[Index(x_px, y_px, image->width_px)] = sum;
    }
  }
}

// The factor that brings the mean, the brightest clipped so that the sun does not count, to a
// middle grey.
float Exposure(const LightImage& image, double exposure_ev) {
  double sum = 0.0;
  for (const Colour& pixel : image.pixels) {
    sum += std::min(0.25F * pixel.r + 0.6F * pixel.g + 0.15F * pixel.b, 1.2F);
  }
  const double mean = sum / static_cast<double>(std::max<std::size_t>(image.pixels.size(), 1));
  return static_cast<float>(kMiddleGrey / std::max(mean, 1e-4) * std::exp2(exposure_ev));
}

// Straight up to half of full scale, then ever flatter: bright things keep their drawing.
float Shoulder(float light) {
  constexpr float kKnee = 0.5F;
  if (light <= kKnee) return light;
  const float over = light - kKnee;
  return kKnee + (1.0F - kKnee) * over / (over + (1.0F - kKnee));
}

}  // namespace

Picture Develop(const LightImage& light, const FilmOptions& options) {
  LightImage image = light;
  Blur(options.blur_sigma_px, &image);
  Shake(options.shake_px, options.shake_direction_rad, &image);
  const float exposure = Exposure(image, options.exposure_ev);
  const auto warmth = static_cast<float>(options.warmth);
  const Colour gain = {exposure * (1.0F + 0.08F * warmth), exposure,
                       exposure * (1.0F - 0.08F * warmth)};
  Random random(options.seed);
  const auto noisy = [&](float level) {
    const double variance = options.read_noise * options.read_noise +
                            std::max(level, 0.0F) / std::max(options.electrons, 1.0);
    return level + static_cast<float>(std::sqrt(variance) * random.Gaussian());
  };
  Picture picture;
  picture.width_px = image.width_px;
  picture.height_px = image.height_px;
  picture.pixels.reserve(3 * image.pixels.size());
  const double middle_x = 0.5 * (image.width_px - 1);
  const double middle_y = 0.5 * (image.height_px - 1);
  const double corner = std::max(middle_x * middle_x + middle_y * middle_y, 1.0);
  for (int y_px = 0; y_px < image.height_px; ++y_px) {
    for (int x_px = 0; x_px < image.width_px; ++x_px) {
      const double away =
          ((x_px - middle_x) * (x_px - middle_x) + (y_px - middle_y) * (y_px - middle_y)) / corner;
      const auto fall = static_cast<float>(1.0 - options.vignetting * away);
      const Colour level = fall * (gain * image.pixels[Index(x_px, y_px, image.width_px)]);
      picture.pixels.push_back(ByteFromLight(Shoulder(noisy(level.b))));
      picture.pixels.push_back(ByteFromLight(Shoulder(noisy(level.g))));
      picture.pixels.push_back(ByteFromLight(Shoulder(noisy(level.r))));
    }
  }
  return picture;
}

}  // namespace lodemark
