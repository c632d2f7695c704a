#include "core/camera/board_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace lodemark {
namespace {

constexpr int kFewestCornersASide = 3;
constexpr int kMostCornersASide = 100;
constexpr int kLeastMarkedCorners = 4;

// Boards are looked for in a copy of at most this size, and their corners then refined in the
// photograph: the search takes seconds on a phone's 12 megapixels and finds no more there.
constexpr int kSearchSide_px = 1600;

// Half the side of the square in which a corner is refined, in pixels and in squares: within a
// square so that no other corner disturbs.
constexpr double kMostRefinement_px = 11.0;
constexpr double kRefinement_squares = 0.35;

using Dictionary = cv::aruco::PREDEFINED_DICTIONARY_NAME;

constexpr std::array<std::pair<std::string_view, Dictionary>, 21> kDictionaries = {{
    {"4x4_50", cv::aruco::DICT_4X4_50},
    {"4x4_100", cv::aruco::DICT_4X4_100},
    {"4x4_250", cv::aruco::DICT_4X4_250},
    {"4x4_1000", cv::aruco::DICT_4X4_1000},
    {"5x5_50", cv::aruco::DICT_5X5_50},
    {"5x5_100", cv::aruco::DICT_5X5_100},
    {"5x5_250", cv::aruco::DICT_5X5_250},
    {"5x5_1000", cv::aruco::DICT_5X5_1000},
    {"6x6_50", cv::aruco::DICT_6X6_50},
    {"6x6_100", cv::aruco::DICT_6X6_100},
    {"6x6_250", cv::aruco::DICT_6X6_250},
    {"6x6_1000", cv::aruco::DICT_6X6_1000},
    {"7x7_50", cv::aruco::DICT_7X7_50},
    {"7x7_100", cv::aruco::DICT_7X7_100},
    {"7x7_250", cv::aruco::DICT_7X7_250},
    {"7x7_1000", cv::aruco::DICT_7X7_1000},
    {"original", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"april_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"april_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"april_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"april_36h11", cv::aruco::DICT_APRILTAG_36h11},
}};

cv::Ptr<cv::aruco::Dictionary> DictionaryOf(std::string_view name) {
  for (const auto& [known, dictionary] : kDictionaries) {
    if (known == name) return cv::aruco::getPredefinedDictionary(dictionary);
  }
  return nullptr;
}

Error Invalid(const std::string& what) { return {ErrorCode::kInvalidArgument, "board: " + what}; }

using Corners = std::vector<cv::Point2f>;

// Distance from each corner to its neighbour in the row or column, the least of all.
double LeastSpacing(const Corners& corners, const BoardPattern& pattern) {
  double least_px = std::numeric_limits<double>::infinity();
  for (int row = 0; row < pattern.rows; ++row) {
    for (int column = 0; column < pattern.columns; ++column) {
      const auto at = [&](int r, int c) {
        return corners[static_cast<std::size_t>(r * pattern.columns + c)];
      };
      if (column > 0)
        least_px = std::min(least_px, cv::norm(at(row, column) - at(row, column - 1)));
      if (row > 0) least_px = std::min(least_px, cv::norm(at(row, column) - at(row - 1, column)));
    }
  }
  return least_px;
}

void Refine(const cv::Mat& image, double spacing_px, Corners* corners) {
  const int half_px = static_cast<int>(
      std::clamp(std::floor(kRefinement_squares * spacing_px), 2.0, kMostRefinement_px));
  cv::cornerSubPix(image, *corners, cv::Size(half_px, half_px), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 1e-3));
}

std::optional<Corners> FindChessboard(const cv::Mat& image, const BoardPattern& pattern) {
  const double scale =
      std::min(1.0, static_cast<double>(kSearchSide_px) / std::max(image.cols, image.rows));
  cv::Mat searched = image;
  if (scale < 1.0) cv::resize(image, searched, {}, scale, scale, cv::INTER_AREA);

  const cv::Size size(pattern.columns, pattern.rows);
  Corners corners;
  // The older search is the quicker one and finds more boards seen through wide lenses; the newer
  // finds blurred and faint ones. Its own refinement is not asked for: it is less exact than the
  // one below.
  if (!cv::findChessboardCorners(searched, size, corners,
                                 cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE) &&
      !cv::findChessboardCornersSB(searched, size, corners,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE)) {
    return std::nullopt;
  }
  if (corners.size() != static_cast<std::size_t>(size.area())) return std::nullopt;

  // Centres of pixels: x + 0.5 = (x' + 0.5) / scale.
  for (cv::Point2f& corner : corners) {
    corner.x = static_cast<float>((corner.x + 0.5) * image.cols / searched.cols - 0.5);
    corner.y = static_cast<float>((corner.y + 0.5) * image.rows / searched.rows - 0.5);
  }
  Refine(image, LeastSpacing(corners, pattern), &corners);
  return corners;
}

BoardCorner CornerAt(int index, const cv::Point2f& pixel, const BoardPattern& pattern) {
  const int row = index / pattern.columns;
  const int column = index % pattern.columns;
  return {{pattern.square_m * column, pattern.square_m * row}, {pixel.x, pixel.y}};
}

BoardView FindMarkedCorners(const cv::Mat& image, const BoardPattern& pattern) {
  const cv::Ptr<cv::aruco::Dictionary> dictionary = DictionaryOf(pattern.markers->dictionary);
  const cv::Ptr<cv::aruco::CharucoBoard> board = cv::aruco::CharucoBoard::create(
      pattern.columns + 1, pattern.rows + 1, static_cast<float>(pattern.square_m),
      static_cast<float>(pattern.markers->side_m), dictionary);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> marker_ids;
  cv::aruco::detectMarkers(image, dictionary, markers, marker_ids);
  BoardView view;
  if (markers.empty()) return view;
  Corners corners;
  std::vector<int> ids;
  cv::aruco::interpolateCornersCharuco(markers, marker_ids, image, board, corners, ids);
  for (std::size_t i = 0; i < ids.size() && i < corners.size(); ++i) {
    // OpenCV's ArUco counts from the pixel's border and not from its centre.
    const cv::Point2f pixel = corners[i] - cv::Point2f(0.5f, 0.5f);
    view.corners.push_back(CornerAt(ids[i], pixel, pattern));
  }
  return view;
}

bool IsInside(const BoardView& view, const GrayImage& image) {
  return std::all_of(view.corners.begin(), view.corners.end(), [&](const BoardCorner& corner) {
    return corner.pixel.x() > -1.0 && corner.pixel.y() > -1.0 &&
           corner.pixel.x() < image.width_px && corner.pixel.y() < image.height_px;
  });
}

}  // namespace

std::string KnownDictionaries() {
  std::string names;
  for (const auto& [name, dictionary] : kDictionaries) {
    if (!names.empty()) names += ' ';
    names += name;
  }
  return names;
}

Status CheckPattern(const BoardPattern& pattern) {
  for (const int side : {pattern.columns, pattern.rows}) {
    if (side < kFewestCornersASide || side > kMostCornersASide) {
      return Invalid("has " + std::to_string(pattern.columns) + " x " +
                     std::to_string(pattern.rows) +
                     " inner corners; 3 to 100 a side are served, and there is one fewer than "
                     "there are squares");
    }
  }
  if (!(pattern.square_m > 0.0) || !std::isfinite(pattern.square_m)) {
    return Invalid("the side of its squares is not positive");
  }
  if (!pattern.markers) return {};
  if (!(pattern.markers->side_m > 0.0 && pattern.markers->side_m < pattern.square_m)) {
    return Invalid("a marker is not smaller than the square it lies in");
  }
  const cv::Ptr<cv::aruco::Dictionary> dictionary = DictionaryOf(pattern.markers->dictionary);
  if (dictionary == nullptr) {
    return Invalid("the dictionary '" + pattern.markers->dictionary +
                   "' is unknown; these are known: " + KnownDictionaries());
  }
  const int needed = (pattern.columns + 1) * (pattern.rows + 1) / 2;
  if (dictionary->bytesList.rows < needed) {
    return Invalid("it has " + std::to_string(needed) + " markers, the dictionary '" +
                   pattern.markers->dictionary + "' only " +
                   std::to_string(dictionary->bytesList.rows));
  }
  return {};
}

std::optional<BoardView> FindBoard(const GrayImage& image, const BoardPattern& pattern) {
  if (image.pixels == nullptr || image.width_px < 1 || image.height_px < 1) return std::nullopt;
  try {
    const cv::Mat pixels(image.height_px, image.width_px, CV_8U,
                         const_cast<std::uint8_t*>(image.pixels),
                         static_cast<std::size_t>(image.stride_bytes));
    BoardView view;
    if (pattern.markers) {
      view = FindMarkedCorners(pixels, pattern);
      if (view.corners.size() < kLeastMarkedCorners) return std::nullopt;
    } else {
      const std::optional<Corners> corners = FindChessboard(pixels, pattern);
      if (!corners) return std::nullopt;
      for (std::size_t i = 0; i < corners->size(); ++i) {
        view.corners.push_back(CornerAt(static_cast<int>(i), (*corners)[i], pattern));
      }
    }
    if (!IsInside(view, image)) return std::nullopt;
    return view;
  } catch (const cv::Exception&) {
    return std::nullopt;  // what OpenCV cannot process shows no board
  }
}

}  // namespace lodemark
