#include "core/vision/sift_extrema.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>

namespace lodemark {
namespace {

constexpr int kDifferences = kSiftLayers - 1;
constexpr int kBorder_px = 5;
constexpr int kMostMoves = 5;
constexpr float kGrey = 1.0F / 255.0F;
constexpr float kContrast = 0.04F;
constexpr float kEdge = 10.0F;

// What an extremum must exceed before it is located: half of what it must in the end, in whole
// greys.
const float kThreshold = std::floor(0.5F * kContrast / kScalesInOctave * 255.0F);

// Columns that are looked at together before any of them is.
constexpr int kBlock_px = 16;

// Three rows of each difference, around the one that is searched.
class DifferenceRows {
 public:
  explicit DifferenceRows(const SiftOctave& octave) : octave_(octave) {
    const std::size_t width = static_cast<std::size_t>(octave.width_px());
    for (auto& rows : rows_) {
      for (auto& row : rows) row.resize(width);
    }
  }

  void Make(int y) {
    const int width_px = octave_.width_px();
    for (int i = 0; i < kDifferences; ++i) {
      const float* const finer = octave_.row(i, y);
      const float* const coarser = octave_.row(i + 1, y);
      float* const out = rows_[static_cast<std::size_t>(i)][Slot(y)].data();
      for (int x = 0; x < width_px; ++x) out[x] = coarser[x] - finer[x];
    }
  }

  const float* row(int i, int y) const {
    return rows_[static_cast<std::size_t>(i)][Slot(y)].data();
  }

 private:
  static std::size_t Slot(int y) { return static_cast<std::size_t>(y % 3); }

  const SiftOctave& octave_;
  std::array<std::array<std::vector<float>, 3>, kDifferences> rows_;
};

// The nine rows around one.
struct Neighbours {
  std::array<const float*, 9> rows;  // the searched one first, then those likely to exceed it

  Neighbours(const DifferenceRows& differences, int i, int y)
      : rows{differences.row(i, y),         differences.row(i, y - 1),
             differences.row(i, y + 1),     differences.row(i - 1, y),
             differences.row(i + 1, y),     differences.row(i - 1, y - 1),
             differences.row(i - 1, y + 1), differences.row(i + 1, y - 1),
             differences.row(i + 1, y + 1)} {}

  bool HasPeakAt(int x) const {
    const float value = rows[0][x];
    for (const float* row : rows) {
      if (row[x - 1] > value || row[x] > value || row[x + 1] > value) return false;
    }
    return true;
  }

  bool HasPitAt(int x) const {
    const float value = rows[0][x];
    for (const float* row : rows) {
      if (row[x - 1] < value || row[x] < value || row[x + 1] < value) return false;
    }
    return true;
  }
};

bool AnyExceeds(const float* values, int count, float threshold) {
  int exceeding = 0;
  for (int i = 0; i < count; ++i) exceeding += std::abs(values[i]) > threshold ? 1 : 0;
  return exceeding > 0;
}

// Slope and curvature of the difference at a pixel of a layer, grey in 0 .. 1.
struct Shape {
  float value = 0.0F;
  Eigen::Vector3f slope;  // along x, y, layer
  Eigen::Matrix3f curvature;
};

Shape ShapeAt(const SiftOctave& octave, int layer, int x, int y) {
  const auto at = [&](int dx, int dy, int di) {
    const int i = layer + di;
    return octave.row(i + 1, y + dy)[x + dx] - octave.row(i, y + dy)[x + dx];
  };
  Shape shape;
  const float value = at(0, 0, 0);
  shape.value = value * kGrey;
  const auto slope = [&](int dx, int dy, int di) {
    return (at(dx, dy, di) - at(-dx, -dy, -di)) * (0.5F * kGrey);
  };
  const auto bend = [&](int dx, int dy, int di) {
    return (at(dx, dy, di) + at(-dx, -dy, -di) - 2.0F * value) * kGrey;
  };
  const auto twist = [&](int ax, int ay, int bx, int by, int bi) {
    return (at(ax + bx, ay + by, bi) - at(bx - ax, by - ay, bi) - at(ax - bx, ay - by, -bi) +
            at(-ax - bx, -ay - by, -bi)) *
           (0.25F * kGrey);
  };
  shape.slope << slope(1, 0, 0), slope(0, 1, 0), slope(0, 0, 1);
  const float xx = bend(1, 0, 0);
  const float yy = bend(0, 1, 0);
  const float ss = bend(0, 0, 1);
  const float xy = twist(1, 0, 0, 1, 0);
  const float xs = twist(1, 0, 0, 0, 1);
  const float ys = twist(0, 1, 0, 0, 1);
  shape.curvature << xx, xy, xs, xy, yy, ys, xs, ys, ss;
  return shape;
}

// Where a parabola through the neighbours has no slope (Lowe 2004 section 4), if that is near the
// pixel it was found at, and neither flat nor on an edge.
std::optional<SiftExtremum> Locate(const SiftOctave& octave, int layer, const int x_found,
                                   const int y_found) {
  int x = x_found;
  int y = y_found;
  for (int move = 0; move < kMostMoves; ++move) {
    const Shape shape = ShapeAt(octave, layer, x, y);
    const Eigen::Vector3f off = -shape.curvature.partialPivLu().solve(shape.slope);
    if (!off.allFinite() || off.cwiseAbs().maxCoeff() > 1e6F) return std::nullopt;
    if (off.cwiseAbs().maxCoeff() >= 0.5F) {
      x += static_cast<int>(std::lrint(off.x()));
      y += static_cast<int>(std::lrint(off.y()));
      layer += static_cast<int>(std::lrint(off.z()));
      if (layer < 1 || layer > kScalesInOctave || std::abs(x - x_found) > kFarthestMove_px ||
          std::abs(y - y_found) > kFarthestMove_px || x < kBorder_px ||
          x >= octave.width_px() - kBorder_px || y < kBorder_px ||
          y >= octave.height_px() - kBorder_px) {
        return std::nullopt;
      }
      continue;
    }
    const float response = std::abs(shape.value + 0.5F * shape.slope.dot(off));
    if (response * kScalesInOctave < kContrast) return std::nullopt;
    const Eigen::Matrix2f plane = shape.curvature.topLeftCorner<2, 2>();
    const float trace = plane.trace();
    const float determinant = plane(0, 0) * plane(1, 1) - plane(0, 1) * plane(0, 1);
    if (determinant <= 0.0F ||
        trace * trace * kEdge >= (kEdge + 1.0F) * (kEdge + 1.0F) * determinant) {
      return std::nullopt;
    }
    SiftExtremum extremum{layer, x, y, off.x(), off.y(), off.z(), response, 0.0F};
    extremum.sigma_px = static_cast<float>(kFirstSigma_px) *
                        std::exp2((static_cast<float>(layer) + off.z()) / kScalesInOctave);
    return extremum;
  }
  return std::nullopt;
}

}  // namespace

std::vector<SiftExtremum> FindExtrema(const SiftOctave& octave, int begin, int end) {
  std::vector<SiftExtremum> extrema;
  begin = std::max(begin, kBorder_px);
  end = std::min(end, octave.height_px() - kBorder_px);
  if (begin >= end) return extrema;
  DifferenceRows differences(octave);
  differences.Make(begin - 1);
  differences.Make(begin);
  const int right = octave.width_px() - kBorder_px;
  for (int y = begin; y < end; ++y) {
    differences.Make(y + 1);
    for (int layer = 1; layer <= kScalesInOctave; ++layer) {
      const Neighbours around(differences, layer, y);
      const float* const values = around.rows[0];
      for (int block = kBorder_px; block < right; block += kBlock_px) {
        const int width = std::min(kBlock_px, right - block);
        if (!AnyExceeds(values + block, width, kThreshold)) continue;
        for (int x = block; x < block + width; ++x) {
          const bool is_extreme = values[x] > kThreshold    ? around.HasPeakAt(x)
                                  : values[x] < -kThreshold ? around.HasPitAt(x)
                                                            : false;
          if (!is_extreme) continue;
          if (const auto extremum = Locate(octave, layer, x, y)) extrema.push_back(*extremum);
        }
      }
    }
  }
  return extrema;
}

}  // namespace lodemark
