#include "tools/lodemark/sight_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <vector>

#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

constexpr double kResidualScale = 10.0;
constexpr int kSubPixelBits = 4;

// Blue, green, red.
const cv::Scalar kUsed(80, 220, 60);
const cv::Scalar kNotUsed(60, 60, 235);
const cv::Scalar kResidual(0, 220, 255);

cv::Point Fixed(double x_px, double y_px) {
  const double scale = 1 << kSubPixelBits;
  return {static_cast<int>(std::lround(x_px * scale)), static_cast<int>(std::lround(y_px * scale))};
}

}  // namespace

Status DrawSights(const Photo& photo, const std::vector<lodemark_sight>& sights,
                  const std::vector<lodemark_sight_residual>& residuals, const std::string& path) {
  Picture drawn = {photo.width_px, photo.height_px, {}};
  try {
    const cv::Mat grey(photo.height_px, photo.width_px, CV_8U,
                       const_cast<std::uint8_t*>(photo.pixels.data()));
    cv::Mat picture;
    cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
    picture.convertTo(picture, -1, 0.75);  // dimmed, so that the marks stand out
    const int longest_px = std::max(photo.width_px, photo.height_px);
    const int radius = std::max(2, longest_px / 400) << kSubPixelBits;
    const int thickness = std::max(1, longest_px / 1200);
    const auto draw = [&](bool used) {
      for (std::size_t i = 0; i < sights.size(); ++i) {
        const bool is_used = i < residuals.size() && residuals[i].used != 0;
        if (is_used != used) continue;
        const double x = sights[i].pixel_px[0];
        const double y = sights[i].pixel_px[1];
        if (!(x > -1.0 && y > -1.0 && x < photo.width_px && y < photo.height_px)) continue;
        cv::circle(picture, Fixed(x, y), radius, used ? kUsed : kNotUsed, thickness, cv::LINE_AA,
                   kSubPixelBits);
        if (!used) continue;
        const auto& residual = residuals[i].residual_px;
        cv::line(picture, Fixed(x, y),
                 Fixed(x - kResidualScale * residual[0], y - kResidualScale * residual[1]),
                 kResidual, thickness, cv::LINE_AA, kSubPixelBits);
      }
    };
    draw(false);
    draw(true);
    drawn.pixels.assign(picture.datastart, picture.dataend);
  } catch (const cv::Exception& exception) {
    return Error{ErrorCode::kInternal, path + ": cannot be drawn: " + exception.err};
  }
  const Result<std::string> encoded = EncodePicture(drawn, path);
  if (!encoded) return encoded.error();
  return WriteFileWhole(path, *encoded);
}

}  // namespace lodemark
