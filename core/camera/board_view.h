// What one photograph shows of a calibration board.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lodemark {

// An inner corner of the board.
struct BoardCorner {
  Eigen::Vector2d board_m;  // in the board's plane
  Eigen::Vector2d pixel;
};

struct BoardView {
  std::string name;  // of the photograph, for messages
  std::vector<BoardCorner> corners;
};

}  // namespace lodemark
