// A flat surface to paint on, in metres.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/renderer/colour.h"

namespace lodemark {

// u to the right and v up, from the lower left corner, as seen by who stands before the surface.
struct CanvasPoint {
  double u_m = 0.0;
  double v_m = 0.0;
};

struct CanvasRect {
  double left_m = 0.0;
  double low_m = 0.0;
  double right_m = 0.0;
  double high_m = 0.0;

  double width_m() const { return right_m - left_m; }
  double height_m() const { return high_m - low_m; }
  CanvasPoint centre() const { return {0.5 * (left_m + right_m), 0.5 * (low_m + high_m)}; }
  CanvasRect Inset(double by_m) const {
    return {left_m + by_m, low_m + by_m, right_m - by_m, high_m - by_m};
  }
};

// What a texel holds. The alpha of a wall is its gloss (glass 1, plaster 0), that of a card how
// much of it is there.
struct Paint {
  Colour colour;
  float alpha = 0.0F;
};

class Canvas {
 public:
  Canvas(double width_m, double height_m, double texel_m);

  double width_m() const { return width_m_; }
  double height_m() const { return height_m_; }
  double texel_m() const { return texel_m_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }  // row 0 is the lowest

  const Paint& At(int column, int row) const {
    return texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(column)];
  }

  // Shapes cover a texel by the share of it that they fill, so their edges are smooth; share makes
  // all of it thinner.
  void FillRect(const CanvasRect& rect, const Paint& paint, float share = 1.0F);
  void FillEllipse(CanvasPoint centre, double radius_u_m, double radius_v_m, const Paint& paint,
                   float share = 1.0F);
  void Stroke(CanvasPoint from, CanvasPoint to, double width_m, const Paint& paint,
              float share = 1.0F);
  // The colour times the factor: shadow and dirt.
  void Shade(const CanvasRect& rect, float factor);
  void FrameRect(const CanvasRect& rect, double width_m, const Paint& paint);

  // paint(u_m, v_m, texel) for the texels whose centres lie in the rectangle.
  template <class Painter>
  void ForTexels(const CanvasRect& rect, const Painter& paint) {
    const Range columns = RangeOf(rect.left_m, rect.right_m, columns_);
    const Range rows = RangeOf(rect.low_m, rect.high_m, rows_);
    for (int row = rows.begin; row < rows.end; ++row) {
      for (int column = columns.begin; column < columns.end; ++column) {
        paint((column + 0.5) * texel_m_, (row + 0.5) * texel_m_, &Texel(column, row));
      }
    }
  }

  CanvasRect whole() const { return {0.0, 0.0, width_m_, height_m_}; }

 private:
  struct Range {
    int begin = 0;
    int end = 0;
  };
  Range RangeOf(double low_m, double high_m, int count) const;

  Paint& Texel(int column, int row) {
    return texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(column)];
  }

  double width_m_;
  double height_m_;
  double texel_m_;
  int columns_;
  int rows_;
  std::vector<Paint> texels_;
};

}  // namespace lodemark
