// One octave of Gaussian scale space, of which only the rows in use are held.
#pragma once

#include <vector>

#include "core/vision/row_window.h"

namespace lodemark {

// Lowe, "Distinctive image features from scale-invariant keypoints" (2004): section 3.3 for the
// scales of an octave, 3.2 for what they begin with.
inline constexpr int kScalesInOctave = 3;
inline constexpr int kSiftLayers = kScalesInOctave + 3;
inline constexpr double kFirstSigma_px = 1.6;

// Rows above and below an extremum that finding, moving and describing it may look at. The largest
// descriptor reaches 38 rows (hence 39 for gradients), from where the extremum moved to.
inline constexpr int kFarthestMove_px = 5;
inline constexpr int kDescriptorReach_px = 39 + kFarthestMove_px + 1;
inline constexpr int kExtremumReach_px = kFarthestMove_px + 1;

// Layer i is the picture at a blur of kFirstSigma_px * 2^(i / kScalesInOctave). Each row is what it
// would be if the whole picture had been blurred at once, whichever steps it came in.
class SiftOctave {
 public:
  // given_sigma_px: the blur of the rows that come; those that have the first already come as they
  // are.
  SiftOctave(int width_px, int height_px, double given_sigma_px = kFirstSigma_px);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

  // Room for the next rows, for the caller to fill before Advance.
  float* Append(int rows) { return windows_.front().Append(rows); }
  int given_rows() const { return windows_.front().end(); }

  // Blurs what can be, may throw what OpenCV throws.
  void Advance();

  // Rows 0 .. ready_rows(layer) - 1 have been made.
  int ready_rows(int layer) const { return Window(layer).end(); }
  const float* row(int layer, int y) const { return Window(layer).row(y); }

  // Rows whose extrema can be found and described.
  int searchable_rows() const;

  // Extrema will be looked for from this row on.
  void ForgetBefore(int y);

 private:
  const RowWindow& Window(int layer) const {
    return windows_[windows_.size() - kSiftLayers + static_cast<std::size_t>(layer)];
  }

  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<RowWindow> windows_;  // the layers, before them what was given if it was sharper
  std::vector<double> blurs_px_;    // that make each window of the one before
};

}  // namespace lodemark
