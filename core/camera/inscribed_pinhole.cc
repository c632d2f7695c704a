#include <algorithm>
#include <array>
#include <cmath>

#include "core/camera/image_undistortion.h"

namespace lodemark {
namespace {

constexpr int kSamples = 64;  // a side while searching
constexpr double kRounding_px = 1e-6;
constexpr double kSmallest = 1e-3;  // of the image's own size
constexpr double kGrowth = 1.05;
constexpr int kBisections = 24;

// A rectangle of the plane z = 1 with the shape of the image.
struct Window {
  Eigen::Vector2d centre;
  Eigen::Vector2d half_size;
};

class WindowSearch {
 public:
  explicit WindowSearch(const Lens& source) : source_(source) {
    const LensParameters& p = source.parameters();
    // Half the image of a single pixel has no size; let it be half a pixel.
    unit_ = {std::max(p.width_px - 1, 1) / (2.0 * p.fx_px),
             std::max(p.height_px - 1, 1) / (2.0 * p.fy_px)};
    most_scale_ = kWidestPinhole / unit_.norm();
  }

  // By moving the centre in ever smaller steps, as long as that lets the window grow.
  Window Best(const Eigen::Vector2d& start) const {
    Eigen::Vector2d centre = start;
    double scale = Grown(centre, kSmallest);
    for (double step = 0.25; step > 1e-4;) {
      bool better = false;
      for (const auto& [x, y] : kDirections) {
        const Eigen::Vector2d next = centre + step * Eigen::Vector2d(x * unit_.x(), y * unit_.y());
        const double larger = scale * (1.0 + 1e-4);
        if (larger > most_scale_ || !Sees({next, larger * unit_}, kSamples, kSamples)) continue;
        centre = next;
        scale = Grown(centre, larger);
        better = true;
      }
      if (!better) step *= 0.5;
    }
    // To the last pixel of the edge.
    const LensParameters& p = source_.parameters();
    while (scale > kSmallest && !Sees({centre, scale * unit_}, p.width_px - 1, p.height_px - 1)) {
      scale *= 1.0 - 1e-5;
    }
    return {centre, scale * unit_};
  }

 private:
  // Half the diagonal of the pinhole's image in focal lengths: 76 degrees from its middle. A lens
  // that sees more would be shown as a dot in a smear.
  static constexpr double kWidestPinhole = 4.0;

  static constexpr std::array<std::array<int, 2>, 8> kDirections = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

  bool SeesPoint(const Eigen::Vector2d& point) const {
    const LensParameters& p = source_.parameters();
    const auto pixel = source_.Project({point.x(), point.y(), 1.0});
    return pixel && pixel->x() >= -kRounding_px && pixel->y() >= -kRounding_px &&
           pixel->x() <= p.width_px - 1 + kRounding_px &&
           pixel->y() <= p.height_px - 1 + kRounding_px;
  }

  // Whether the source sees the whole edge. Lens and image are without holes, so it then sees what
  // is within as well.
  bool Sees(const Window& window, int across, int down) const {
    const auto sees = [&](double x, double y) {
      return SeesPoint(window.centre + window.half_size.cwiseProduct(Eigen::Vector2d(x, y)));
    };
    for (int i = 0; i <= across; ++i) {
      const double t = across == 0 ? 0.0 : 2.0 * i / across - 1.0;
      if (!sees(t, -1.0) || !sees(t, 1.0)) return false;
    }
    for (int i = 0; i <= down; ++i) {
      const double t = down == 0 ? 0.0 : 2.0 * i / down - 1.0;
      if (!sees(-1.0, t) || !sees(1.0, t)) return false;
    }
    return true;
  }

  // The largest scale about a centre, from one that is seen.
  double Grown(const Eigen::Vector2d& centre, double scale) const {
    double low = scale;
    double high = scale;
    do {
      low = high;
      high = std::min(high * kGrowth, most_scale_);
    } while (high > low && Sees({centre, high * unit_}, kSamples, kSamples));
    for (int i = 0; i < kBisections && high > low; ++i) {
      const double middle = 0.5 * (low + high);
      (Sees({centre, middle * unit_}, kSamples, kSamples) ? low : high) = middle;
    }
    return low;
  }

  const Lens& source_;
  Eigen::Vector2d unit_;
  double most_scale_ = 0.0;
};

}  // namespace

Result<Lens> ImageUndistortion::InscribedPinhole(const Lens& source) {
  const LensParameters& p = source.parameters();
  const auto middle = source.Unproject({0.5 * (p.width_px - 1), 0.5 * (p.height_px - 1)});
  if (!middle || !(middle->z() > 0.1)) {
    return Error{ErrorCode::kUnsupported,
                 "the lens does not see forwards in the middle of its image"};
  }
  const Window window = WindowSearch(source).Best(middle->head<2>() / middle->z());
  LensParameters pinhole;
  pinhole.width_px = p.width_px;
  pinhole.height_px = p.height_px;
  pinhole.fx_px = std::max(p.width_px - 1, 1) / (2.0 * window.half_size.x());
  pinhole.fy_px = std::max(p.height_px - 1, 1) / (2.0 * window.half_size.y());
  pinhole.cx_px = 0.5 * (p.width_px - 1) - pinhole.fx_px * window.centre.x();
  pinhole.cy_px = 0.5 * (p.height_px - 1) - pinhole.fy_px * window.centre.y();
  return Lens::Create(pinhole);
}

}  // namespace lodemark
