#include "tools/lodemark/calibration_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tools/lodemark/command.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

constexpr int kLongestSide_px = 1280;
constexpr int kMargin_px = 32;
constexpr int kHeader_px = 84;
constexpr int kFooter_px = 72;
constexpr int kCells = 24;  // along the longer side
constexpr int kSubPixelBits = 4;
constexpr double kTypicalLine_px = 11.0;  // length that the middle residual is drawn with

// Blue, green, red.
const cv::Scalar kPaper(250, 250, 250);
const cv::Scalar kImage(255, 255, 255);
const cv::Scalar kFrame(190, 185, 180);
const cv::Scalar kInk(60, 50, 45);
const cv::Scalar kFaintInk(135, 128, 122);
const cv::Scalar kCovered(214, 190, 146);
const cv::Scalar kAxis(170, 160, 150);
const std::array<cv::Scalar, 4> kLengths = {cv::Scalar(150, 110, 30), cv::Scalar(70, 160, 60),
                                            cv::Scalar(30, 150, 240), cv::Scalar(50, 40, 210)};

cv::Scalar Mixed(const cv::Scalar& a, const cv::Scalar& b, double share) {
  return a * (1.0 - share) + b * share;
}

// From short to long, 0 to 1.
cv::Scalar ColourOf(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (kLengths.size() - 1);
  const auto lower = std::min(static_cast<std::size_t>(place), kLengths.size() - 2);
  return Mixed(kLengths[lower], kLengths[lower + 1], place - static_cast<double>(lower));
}

cv::Point Fixed(const Eigen::Vector2d& point) {
  const double scale = 1 << kSubPixelBits;
  return {static_cast<int>(std::lround(point.x() * scale)),
          static_cast<int>(std::lround(point.y() * scale))};
}

void Write(const cv::Mat& canvas, const std::string& text, int x, int y, double size,
           const cv::Scalar& colour) {
  cv::putText(canvas, text, {x, y}, cv::FONT_HERSHEY_DUPLEX, size, colour, 1, cv::LINE_AA);
}

int WidthOf(const std::string& text, double size) {
  int below = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, size, 1, &below).width;
}

class Drawing {
 public:
  Drawing(const Calibration& calibration, std::span<const BoardView> views)
      : calibration_(calibration), views_(views) {
    const LensParameters& lens = calibration.lens;
    scale_ = static_cast<double>(kLongestSide_px) / std::max(lens.width_px, lens.height_px);
    image_ = cv::Rect(kMargin_px, kHeader_px,
                      std::max(1, static_cast<int>(std::lround(scale_ * lens.width_px))),
                      std::max(1, static_cast<int>(std::lround(scale_ * lens.height_px))));
    canvas_ = cv::Mat(image_.height + kHeader_px + kFooter_px,
                      std::max(image_.width, 900) + 2 * kMargin_px, CV_8UC3, kPaper);
    for (const CalibratedView& view : calibration.views) {
      for (const Eigen::Vector2d& residual : view.residuals_px) {
        lengths_px_.push_back(residual.norm());
      }
    }
    std::sort(lengths_px_.begin(), lengths_px_.end());
    const double middle_px = std::max(lengths_px_[lengths_px_.size() / 2], 1e-9);
    longest_px_ = std::max(lengths_px_[lengths_px_.size() * 98 / 100], middle_px);
    // 1, 2 or 5 times a power of ten
    const double wanted = kTypicalLine_px / (middle_px * scale_);
    const double ten = std::pow(10.0, std::floor(std::log10(wanted)));
    enlarged_ = ten * (wanted / ten >= 5.0 ? 5.0 : wanted / ten >= 2.0 ? 2.0 : 1.0);
  }

  cv::Mat Draw() {
    cv::rectangle(canvas_, image_, kImage, cv::FILLED);
    Coverage();
    cv::Mat inside = canvas_(image_);
    Axis(inside);
    Residuals(inside);
    cv::rectangle(canvas_, image_ + cv::Size(1, 1), kFrame, 1);
    Header();
    Footer();
    return canvas_;
  }

 private:
  // In the drawn image: a pixel's centre lies half a pixel from its border.
  Eigen::Vector2d At(const Eigen::Vector2d& pixel) const {
    return scale_ * (pixel.array() + 0.5).matrix() - Eigen::Vector2d(0.5, 0.5);
  }

  void Coverage() {
    const double side_px = static_cast<double>(kLongestSide_px) / kCells;
    const int columns = static_cast<int>(std::ceil(image_.width / side_px));
    const int rows = static_cast<int>(std::ceil(image_.height / side_px));
    std::vector<int> counts(static_cast<std::size_t>(columns * rows));
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (!calibration_.views[i].is_used) continue;
      for (const BoardCorner& corner : views_[i].corners) {
        const Eigen::Vector2d place = At(corner.pixel) / side_px;
        const int column = std::clamp(static_cast<int>(place.x()), 0, columns - 1);
        const int row = std::clamp(static_cast<int>(place.y()), 0, rows - 1);
        ++counts[static_cast<std::size_t>(row * columns + column)];
      }
    }
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const int count = counts[static_cast<std::size_t>(row * columns + column)];
        if (count == 0) {
          ++empty_cells_;
          continue;
        }
        const double share = 0.12 + 0.6 * std::min(1.0, std::sqrt(count / 20.0));
        const cv::Point corner(image_.x + static_cast<int>(std::lround(column * side_px)),
                               image_.y + static_cast<int>(std::lround(row * side_px)));
        const cv::Point next(image_.x + static_cast<int>(std::lround((column + 1) * side_px)),
                             image_.y + static_cast<int>(std::lround((row + 1) * side_px)));
        cv::rectangle(canvas_, cv::Rect(corner, next) & image_, Mixed(kImage, kCovered, share),
                      cv::FILLED);
      }
    }
    cells_ = columns * rows;
  }

  void Axis(cv::Mat& inside) const {
    const Eigen::Vector2d axis = At({calibration_.lens.cx_px, calibration_.lens.cy_px});
    for (const Eigen::Vector2d& arm : {Eigen::Vector2d(14.0, 0.0), Eigen::Vector2d(0.0, 14.0)}) {
      cv::line(inside, Fixed(axis - arm), Fixed(axis + arm), kAxis, 2, cv::LINE_AA, kSubPixelBits);
    }
    cv::circle(inside, Fixed(axis), 7 << kSubPixelBits, kAxis, 2, cv::LINE_AA, kSubPixelBits);
  }

  void Residuals(cv::Mat& inside) const {
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const auto& residuals = calibration_.views[i].residuals_px;
      for (std::size_t k = 0; k < residuals.size(); ++k) {
        const Eigen::Vector2d from = At(views_[i].corners[k].pixel);
        const cv::Scalar colour = ColourOf(residuals[k].norm() / longest_px_);
        const Eigen::Vector2d along = enlarged_ * scale_ * residuals[k];
        // A corner that is grossly off stays in the picture.
        const double shortened = std::min(1.0, 200.0 / std::max(along.norm(), 1e-9));
        cv::line(inside, Fixed(from), Fixed(from + shortened * along), colour, 1, cv::LINE_AA,
                 kSubPixelBits);
        cv::circle(inside, Fixed(from), 20, colour, cv::FILLED, cv::LINE_AA, kSubPixelBits);
      }
    }
  }

  void Header() {
    Write(canvas_, NameOf(calibration_.form), kMargin_px, 40, 0.9, kInk);
    Write(canvas_,
          Format("%d x %d px   rms %.3f px   f %.2f +- %.2f px   %d photographs, %s",
                 calibration_.lens.width_px, calibration_.lens.height_px, calibration_.rms_px,
                 calibration_.lens.fx_px, std::sqrt(calibration_.covariance(0, 0)),
                 calibration_.views_used,
                 Counted(static_cast<std::int64_t>(lengths_px_.size()), "corner").c_str()),
          kMargin_px, 68, 0.5, kFaintInk);
  }

  void Footer() {
    const int y = kHeader_px + image_.height + 28;
    const std::string left = Format("Corner seen less computed, drawn %g times as long", enlarged_);
    Write(canvas_, left, kMargin_px, y + 4, 0.5, kInk);
    Write(canvas_,
          Format("Shaded where corners were seen: %.0f %% of the image; the cross is the "
                 "principal point",
                 100.0 * (cells_ - empty_cells_) / std::max(cells_, 1)),
          kMargin_px, y + 28, 0.5, kFaintInk);
    // A scale of colours with its length.
    const int width = 180;
    const std::string most = Format("%.2f px", longest_px_);
    const int right = canvas_.cols - kMargin_px - WidthOf(most, 0.5) - 8;
    for (int x = 0; x < width; ++x) {
      cv::line(canvas_, {right - width + x, y - 6}, {right - width + x, y + 4},
               ColourOf(static_cast<double>(x) / width), 1);
    }
    Write(canvas_, "0", right - width - 16, y + 4, 0.5, kInk);
    Write(canvas_, most, right + 8, y + 4, 0.5, kInk);
  }

  const Calibration& calibration_;
  std::span<const BoardView> views_;
  double scale_ = 1.0;
  cv::Rect image_;
  cv::Mat canvas_;
  std::vector<double> lengths_px_;  // of the residuals, sorted
  double longest_px_ = 0.0;         // all but the longest two hundredths
  double enlarged_ = 1.0;
  int cells_ = 0;
  int empty_cells_ = 0;
};

}  // namespace

Status DrawCalibration(const Calibration& calibration, std::span<const BoardView> views,
                       const std::string& path) {
  Picture picture;
  try {
    const cv::Mat canvas = Drawing(calibration, views).Draw();
    picture = {canvas.cols, canvas.rows, {}};
    picture.pixels.assign(canvas.datastart, canvas.dataend);
  } catch (const cv::Exception& exception) {
    return Error{ErrorCode::kInternal, path + ": cannot be drawn: " + exception.err};
  }
  const Result<std::string> encoded = EncodePicture(picture, path);
  if (!encoded) return encoded.error();
  return WriteFileWhole(path, *encoded);
}

}  // namespace lodemark
