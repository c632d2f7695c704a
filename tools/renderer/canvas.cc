#include "tools/renderer/canvas.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

void Blend(const Paint& paint, float share, Paint* texel) {
  texel->colour = Mix(texel->colour, paint.colour, share);
  texel->alpha += share * (paint.alpha - texel->alpha);
}

// Length of [a, b] within [low, high].
double Overlap(double a, double b, double low, double high) {
  return std::max(0.0, std::min(b, high) - std::max(a, low));
}

}  // namespace

Canvas::Canvas(double width_m, double height_m, double texel_m)
    : width_m_(width_m),
      height_m_(height_m),
      texel_m_(texel_m),
      columns_(std::max(1, static_cast<int>(std::ceil(width_m / texel_m)))),
      rows_(std::max(1, static_cast<int>(std::ceil(height_m / texel_m)))),
      texels_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

Canvas::Range Canvas::RangeOf(double low_m, double high_m, int count) const {
  // Texels touched, clipped before the conversion.
  const double begin = std::clamp(std::floor(low_m / texel_m_), 0.0, static_cast<double>(count));
  const double end = std::clamp(std::ceil(high_m / texel_m_), begin, static_cast<double>(count));
  return {static_cast<int>(begin), static_cast<int>(end)};
}

void Canvas::FillRect(const CanvasRect& rect, const Paint& paint, float share) {
  ForTexels(rect, [&](double u_m, double v_m, Paint* texel) {
    const double half_m = 0.5 * texel_m_;
    const double covered = Overlap(u_m - half_m, u_m + half_m, rect.left_m, rect.right_m) *
                           Overlap(v_m - half_m, v_m + half_m, rect.low_m, rect.high_m) /
                           (texel_m_ * texel_m_);
    Blend(paint, share * static_cast<float>(covered), texel);
  });
}

void Canvas::FillEllipse(CanvasPoint centre, double radius_u_m, double radius_v_m,
                         const Paint& paint, float share) {
  const double soft_m = 0.5 * texel_m_;
  const CanvasRect around = {centre.u_m - radius_u_m - soft_m, centre.v_m - radius_v_m - soft_m,
                             centre.u_m + radius_u_m + soft_m, centre.v_m + radius_v_m + soft_m};
  const double least_m = std::min(radius_u_m, radius_v_m);
  // One smaller than a texel covers what its area is.
  const double thin = std::min(1.0, 4.0 * radius_u_m * radius_v_m / (texel_m_ * texel_m_));
  ForTexels(around, [&](double u_m, double v_m, Paint* texel) {
    const double du = (u_m - centre.u_m) / std::max(radius_u_m, soft_m);
    const double dv = (v_m - centre.v_m) / std::max(radius_v_m, soft_m);
    const double outside_m = (std::sqrt(du * du + dv * dv) - 1.0) * std::max(least_m, soft_m);
    const double covered = std::clamp(0.5 - outside_m / texel_m_, 0.0, 1.0) * thin;
    Blend(paint, share * static_cast<float>(covered), texel);
  });
}

void Canvas::Stroke(CanvasPoint from, CanvasPoint to, double width_m, const Paint& paint,
                    float share) {
  const double half_m = 0.5 * std::max(width_m, texel_m_);
  const double thin = std::min(1.0, width_m / texel_m_);
  const double reach_m = half_m + texel_m_;
  const CanvasRect around = {
      std::min(from.u_m, to.u_m) - reach_m, std::min(from.v_m, to.v_m) - reach_m,
      std::max(from.u_m, to.u_m) + reach_m, std::max(from.v_m, to.v_m) + reach_m};
  const double du = to.u_m - from.u_m;
  const double dv = to.v_m - from.v_m;
  const double square = std::max(du * du + dv * dv, 1e-12);
  ForTexels(around, [&](double u_m, double v_m, Paint* texel) {
    const double along =
        std::clamp(((u_m - from.u_m) * du + (v_m - from.v_m) * dv) / square, 0.0, 1.0);
    const double away_m =
        std::hypot(u_m - from.u_m - along * du, v_m - from.v_m - along * dv) - half_m;
    const double covered = std::clamp(0.5 - away_m / texel_m_, 0.0, 1.0) * thin;
    Blend(paint, share * static_cast<float>(covered), texel);
  });
}

void Canvas::Shade(const CanvasRect& rect, float factor) {
  ForTexels(rect, [&](double u_m, double v_m, Paint* texel) {
    const double half_m = 0.5 * texel_m_;
    const double covered = Overlap(u_m - half_m, u_m + half_m, rect.left_m, rect.right_m) *
                           Overlap(v_m - half_m, v_m + half_m, rect.low_m, rect.high_m) /
                           (texel_m_ * texel_m_);
    texel->colour = (1.0F + static_cast<float>(covered) * (factor - 1.0F)) * texel->colour;
  });
}

void Canvas::FrameRect(const CanvasRect& rect, double width_m, const Paint& paint) {
  FillRect({rect.left_m, rect.low_m, rect.right_m, rect.low_m + width_m}, paint);
  FillRect({rect.left_m, rect.high_m - width_m, rect.right_m, rect.high_m}, paint);
  FillRect({rect.left_m, rect.low_m + width_m, rect.left_m + width_m, rect.high_m - width_m},
           paint);
  FillRect({rect.right_m - width_m, rect.low_m + width_m, rect.right_m, rect.high_m - width_m},
           paint);
}

}  // namespace lodemark
