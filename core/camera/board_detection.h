// Finds the corners of chessboards and ChArUco boards in photographs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/camera/board_view.h"
#include "core/camera/gray_image.h"

namespace lodemark {

// Markers in the white squares of a board, by which a board that is partly hidden is still read.
struct BoardMarkers {
  std::string dictionary;  // as ArUco calls it: "4x4_50" to "7x7_1000", "april_36h11"
  double side_m = 0.0;     // less than a square's
};

struct BoardPattern {
  int columns = 0;  // of inner corners: one fewer than squares
  int rows = 0;
  double square_m = 0.0;
  std::optional<BoardMarkers> markers;
};

// Error if there are not 3 to 100 corners a side, a length is not positive, a marker is not smaller
// than its square, or the dictionary is unknown or has too few markers.
Status CheckPattern(const BoardPattern& pattern);

// The corners to a fraction of a pixel: all of a chessboard, in rows; of a board with markers those
// that can be told, at least four. Nothing if the board is not found. The pattern has been checked,
// and which way round a symmetric board lies is not known.
std::optional<BoardView> FindBoard(const GrayImage& image, const BoardPattern& pattern);

// Names of the dictionaries, separated by spaces.
std::string KnownDictionaries();

}  // namespace lodemark
