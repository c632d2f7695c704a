#include "tools/renderer/texture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace lodemark {
namespace {

constexpr int kMostProbes = 8;

std::size_t Index(int column, int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

std::array<std::uint8_t, 4> Packed(const Paint& paint) {
  return {ByteFromLight(paint.colour.r), ByteFromLight(paint.colour.g),
          ByteFromLight(paint.colour.b),
          static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(paint.alpha, 0.0F, 1.0F)))};
}

}  // namespace

Texture::Texture(const Canvas& canvas)
    : width_m_(canvas.width_m()),
      height_m_(canvas.height_m()),
      texel_m_(canvas.texel_m()),
      light_(LightOfBytes()) {
  int columns = canvas.columns();
  int rows = canvas.rows();
  std::vector<Paint> means;
  means.reserve(Index(0, rows, columns));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) means.push_back(canvas.At(column, row));
  }
  while (true) {
    Level level;
    level.columns = columns;
    level.rows = rows;
    level.texels.reserve(means.size());
    for (const Paint& paint : means) level.texels.push_back(Packed(paint));
    levels_.push_back(std::move(level));
    if (columns == 1 && rows == 1) break;
    const int half_columns = (columns + 1) / 2;
    const int half_rows = (rows + 1) / 2;
    std::vector<Paint> halved;
    halved.reserve(Index(0, half_rows, half_columns));
    for (int row = 0; row < half_rows; ++row) {
      for (int column = 0; column < half_columns; ++column) {
        Paint sum;
        for (int i = 0; i < 4; ++i) {
          const Paint& part = means[Index(std::min(2 * column + i % 2, columns - 1),
                                          std::min(2 * row + i / 2, rows - 1), columns)];
          sum.colour += 0.25F * part.colour;
          sum.alpha += 0.25F * part.alpha;
        }
        halved.push_back(sum);
      }
    }
    means = std::move(halved);
    columns = half_columns;
    rows = half_rows;
  }
}

void Texture::Probe(double column, double row, const Level& level, double scale, float share,
                    Paint* sum) const {
  const double x = std::clamp(column * scale - 0.5, 0.0, level.columns - 1.0);
  const double y = std::clamp(row * scale - 0.5, 0.0, level.rows - 1.0);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, level.columns - 1);
  const int y1 = std::min(y0 + 1, level.rows - 1);
  const float fx = static_cast<float>(x) - static_cast<float>(x0);
  const float fy = static_cast<float>(y) - static_cast<float>(y0);
  const auto add = [&](int at_x, int at_y, float weight) {
    const std::array<std::uint8_t, 4>& texel = level.texels[Index(at_x, at_y, level.columns)];
    sum->colour.r += weight * light_[texel[0]];
    sum->colour.g += weight * light_[texel[1]];
    sum->colour.b += weight * light_[texel[2]];
    sum->alpha += weight * (1.0F / 255.0F) * static_cast<float>(texel[3]);
  };
  add(x0, y0, share * (1.0F - fx) * (1.0F - fy));
  add(x1, y0, share * fx * (1.0F - fy));
  add(x0, y1, share * (1.0F - fx) * fy);
  add(x1, y1, share * fx * fy);
}

Paint Texture::Look(CanvasPoint at, const Footprint& footprint) const {
  const double by_texel = 1.0 / texel_m_;
  double long_u = footprint.u_by_x_m * by_texel;
  double long_v = footprint.v_by_x_m * by_texel;
  double longer = std::sqrt(long_u * long_u + long_v * long_v);
  double shorter = std::hypot(footprint.u_by_y_m, footprint.v_by_y_m) * by_texel;
  if (shorter > longer) {
    std::swap(longer, shorter);
    long_u = footprint.u_by_y_m * by_texel;
    long_v = footprint.v_by_y_m * by_texel;
  }
  const int probes =
      std::clamp(static_cast<int>(std::ceil(longer / std::max(shorter, 1.0))), 1, kMostProbes);
  const double width = std::max({1.0, shorter, longer / probes});
  const double depth = std::min(std::log2(width), static_cast<double>(levels_.size() - 1));
  const auto fine = static_cast<std::size_t>(depth);
  const auto blend = static_cast<float>(depth - static_cast<double>(fine));
  const std::size_t coarse = std::min(fine + 1, levels_.size() - 1);
  const double fine_scale = std::ldexp(1.0, -static_cast<int>(fine));

  Paint sum;
  const float share = 1.0F / static_cast<float>(probes);
  for (int i = 0; i < probes; ++i) {
    const double offset = (i + 0.5) / probes - 0.5;
    const double column = at.u_m * by_texel + offset * long_u;
    const double row = at.v_m * by_texel + offset * long_v;
    Probe(column, row, levels_[fine], fine_scale, share * (1.0F - blend), &sum);
    if (blend > 0.0F) {
      Probe(column, row, levels_[coarse], 0.5 * fine_scale, share * blend, &sum);
    }
  }
  return sum;
}

}  // namespace lodemark
