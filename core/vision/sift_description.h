// Which way an extremum is turned, and what is around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vision/sift_extrema.h"
#include "core/vision/sift_octave.h"

namespace lodemark {

inline constexpr std::size_t kSiftLength = 128;

// Lowe (2004) sections 5 and 6. Keeps room for what it works with.
class SiftDescription {
 public:
  // Directions of the dominant gradients, in degrees in 0 .. 360 clockwise from x; one mostly.
  std::vector<float> Turns(const SiftOctave& octave, const SiftExtremum& extremum);

  // 4 x 4 histograms of 8 directions, in whole numbers whose squares sum to about 512².
  std::array<std::uint8_t, kSiftLength> Describe(const SiftOctave& octave,
                                                 const SiftExtremum& extremum, float turn_deg);

 private:
  // Gradients in parts of a row that lie side by side in these.
  struct Gradients {
    std::vector<float> along_x;
    std::vector<float> up;
    std::vector<float> weight;
    std::vector<float> magnitude;
    std::vector<float> direction_deg;
    void Resize(std::size_t count);
    void ToPolar(std::size_t count);
  };

  Gradients gradients_;
  std::vector<float> row_bins_;
  std::vector<float> column_bins_;
};

}  // namespace lodemark
