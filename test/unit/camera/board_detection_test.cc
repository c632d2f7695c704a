// Boards drawn with OpenCV, seen in perspective.
#include "core/camera/board_detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

#include "core/camera/calibration.h"
#include "test/unit/camera/board_scene.h"

namespace lodemark {
namespace {

constexpr double kSquare_m = 0.025;
constexpr int kSquare_px = 60;

BoardPattern Pattern(int columns, int rows) { return {columns, rows, kSquare_m, {}}; }

BoardPattern MarkedPattern(int columns, int rows) {
  return {columns, rows, kSquare_m, BoardMarkers{"5x5_100", 0.018}};
}

// Squares with a margin of one, and where the inner corners are: on the lines between pixels.
struct DrawnBoard {
  cv::Mat picture;
  std::vector<cv::Point2d> corners;
};

DrawnBoard Draw(const BoardPattern& pattern) {
  DrawnBoard board;
  const cv::Size squares(pattern.columns + 1, pattern.rows + 1);
  if (pattern.markers) {
    const auto charuco = cv::aruco::CharucoBoard::create(
        squares.width, squares.height, static_cast<float>(kSquare_m),
        static_cast<float>(pattern.markers->side_m),
        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100));
    cv::Mat inside;
    charuco->draw(squares * kSquare_px, inside);
    cv::copyMakeBorder(inside, board.picture, kSquare_px, kSquare_px, kSquare_px, kSquare_px,
                       cv::BORDER_CONSTANT, 255);
  } else {
    board.picture = cv::Mat((squares.height + 2) * kSquare_px, (squares.width + 2) * kSquare_px,
                            CV_8U, cv::Scalar(255));
    for (int row = 0; row < squares.height; ++row) {
      for (int column = row % 2; column < squares.width; column += 2) {
        board.picture(cv::Rect((column + 1) * kSquare_px, (row + 1) * kSquare_px, kSquare_px,
                               kSquare_px)) = 20;
      }
    }
  }
  for (int row = 0; row < pattern.rows; ++row) {
    for (int column = 0; column < pattern.columns; ++column) {
      board.corners.emplace_back((column + 2) * kSquare_px - 0.5, (row + 2) * kSquare_px - 0.5);
    }
  }
  return board;
}

// As a camera that looks at it aslant sees it, slightly blurred.
DrawnBoard Aslant(const DrawnBoard& board) {
  const cv::Matx33d homography(0.62, 0.11, 60.0, -0.06, 0.6, 110.0, -1.2e-4, 2e-4, 1.0);
  DrawnBoard seen;
  cv::Mat soft;
  cv::GaussianBlur(board.picture, soft, cv::Size(9, 9), 1.5);
  cv::warpPerspective(soft, seen.picture, homography, cv::Size(640, 480), cv::INTER_LINEAR,
                      cv::BORDER_CONSTANT, 200);
  cv::perspectiveTransform(board.corners, seen.corners, homography);
  return seen;
}

GrayImage ImageOf(const cv::Mat& picture) {
  return {picture.data, picture.cols, picture.rows, static_cast<std::ptrdiff_t>(picture.step)};
}

TEST(BoardDetection, FindsAllCornersOfAChessboardWhereTheyAre) {
  const BoardPattern pattern = Pattern(9, 6);
  const DrawnBoard seen = Aslant(Draw(pattern));
  const auto view = FindBoard(ImageOf(seen.picture), pattern);
  ASSERT_TRUE(view.has_value());
  ASSERT_EQ(view->corners.size(), 54u);
  // The board may be read from its other end.
  const bool is_turned = std::abs(view->corners.front().pixel.x() - seen.corners.front().x) > 100.0;
  double worst_px = 0.0;
  for (std::size_t i = 0; i < 54; ++i) {
    const cv::Point2d& truth = seen.corners[is_turned ? 53 - i : i];
    worst_px =
        std::max(worst_px, (view->corners[i].pixel - Eigen::Vector2d(truth.x, truth.y)).norm());
  }
  EXPECT_LT(worst_px, 0.15);
  EXPECT_NEAR(view->corners[10].board_m.x(), kSquare_m, 1e-12);
  EXPECT_NEAR(view->corners[10].board_m.y(), kSquare_m, 1e-12);
}

TEST(BoardDetection, FindsTheBoardInALargePhotograph) {
  const BoardPattern pattern = Pattern(7, 5);
  DrawnBoard seen = Aslant(Draw(pattern));
  cv::resize(seen.picture, seen.picture, {}, 5.0, 5.0, cv::INTER_CUBIC);
  const auto view = FindBoard(ImageOf(seen.picture), pattern);
  ASSERT_TRUE(view.has_value());
  const bool is_turned =
      std::abs(view->corners.front().pixel.x() - 5.0 * seen.corners.front().x) > 300.0;
  const cv::Point2d& truth = seen.corners[is_turned ? 34 : 0];
  EXPECT_NEAR(view->corners[0].pixel.x(), 5.0 * (truth.x + 0.5) - 0.5, 0.6);
  EXPECT_NEAR(view->corners[0].pixel.y(), 5.0 * (truth.y + 0.5) - 0.5, 0.6);
}

TEST(BoardDetection, ReadsAMarkedBoardOfWhichOnlyAPartIsSeen) {
  const BoardPattern pattern = MarkedPattern(9, 6);
  const DrawnBoard seen = Aslant(Draw(pattern));
  const auto whole = FindBoard(ImageOf(seen.picture), pattern);
  ASSERT_TRUE(whole.has_value());
  EXPECT_GE(whole->corners.size(), 50u);

  const cv::Mat left_part = seen.picture(cv::Rect(0, 0, 330, 480));
  const auto part = FindBoard(ImageOf(left_part), pattern);
  ASSERT_TRUE(part.has_value());
  EXPECT_LT(part->corners.size(), 54u);
  for (const BoardCorner& corner : part->corners) {
    const auto column = static_cast<std::size_t>(std::lround(corner.board_m.x() / kSquare_m));
    const auto row = static_cast<std::size_t>(std::lround(corner.board_m.y() / kSquare_m));
    const cv::Point2d& truth = seen.corners[row * 9 + column];
    EXPECT_NEAR(corner.pixel.x(), truth.x, 0.3);
    EXPECT_NEAR(corner.pixel.y(), truth.y, 0.3);
  }
}

// A board that a known camera photographs from all sides, partly outside the image.
TEST(BoardDetection, ReadsMarkedBoardsWellEnoughToCalibrate) {
  constexpr double kFocal_px = 900.0;
  const Eigen::Vector2d axis(655.0, 470.0);
  const BoardPattern pattern = MarkedPattern(test::kSceneColumns, test::kSceneRows);
  const DrawnBoard board = Draw(pattern);
  cv::Mat soft;
  cv::GaussianBlur(board.picture, soft, cv::Size(9, 9), 1.5);
  // From pixels of the drawing to metres from the first inner corner.
  const double metres = kSquare_m / kSquare_px;
  const cv::Matx33d board_from_drawing(metres, 0.0, -metres * board.corners.front().x, 0.0, metres,
                                       -metres * board.corners.front().y, 0.0, 0.0, 1.0);
  Random random(4);
  std::vector<BoardView> views;
  for (int i = 0; i < 14; ++i) {
    const Rigid3 pose = test::RandomBoardPose(0.35, &random);
    const Eigen::Matrix3d rotation = pose.rotation().toRotationMatrix();
    cv::Matx33d image_from_board;
    for (int column = 0; column < 3; ++column) {
      const Eigen::Vector3d from =
          column < 2 ? Eigen::Vector3d(rotation.col(column)) : pose.translation();
      image_from_board(0, column) = kFocal_px * from.x() + axis.x() * from.z();
      image_from_board(1, column) = kFocal_px * from.y() + axis.y() * from.z();
      image_from_board(2, column) = from.z();
    }
    cv::Mat photograph;
    cv::warpPerspective(soft, photograph, image_from_board * board_from_drawing,
                        cv::Size(1280, 960), cv::INTER_LINEAR, cv::BORDER_CONSTANT, 200);
    const auto view = FindBoard(ImageOf(photograph), pattern);
    if (view) views.push_back(*view);
  }
  EXPECT_GE(views.size(), 12u);
  EXPECT_TRUE(std::any_of(views.begin(), views.end(),
                          [](const BoardView& view) { return view.corners.size() < 54; }));
  const auto calibration = Calibrate(1280, 960, views);
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  RecordProperty("rms_px", std::to_string(calibration->rms_px));
  EXPECT_LT(calibration->rms_px, 0.3);
  EXPECT_NEAR(calibration->lens.fx_px, kFocal_px, 2.0);
  EXPECT_NEAR(calibration->lens.fy_px, kFocal_px, 2.0);
  EXPECT_NEAR(calibration->lens.cx_px, axis.x(), 2.0);
  EXPECT_NEAR(calibration->lens.cy_px, axis.y(), 2.0);
}

TEST(BoardDetection, DoesNotFindWhatIsNotThere) {
  const DrawnBoard seen = Aslant(Draw(Pattern(9, 6)));
  EXPECT_FALSE(FindBoard(ImageOf(seen.picture), Pattern(8, 6)).has_value());
  EXPECT_FALSE(FindBoard(ImageOf(seen.picture), MarkedPattern(9, 6)).has_value());
  const cv::Mat part = seen.picture(cv::Rect(0, 0, 300, 480));
  EXPECT_FALSE(FindBoard(ImageOf(part), Pattern(9, 6)).has_value());
  const cv::Mat black(480, 640, CV_8U, cv::Scalar(0));
  EXPECT_FALSE(FindBoard(ImageOf(black), Pattern(9, 6)).has_value());
  EXPECT_FALSE(FindBoard(ImageOf(black), MarkedPattern(9, 6)).has_value());
  const std::uint8_t one = 7;
  EXPECT_FALSE(FindBoard({&one, 1, 1, 1}, Pattern(9, 6)).has_value());
  EXPECT_FALSE(FindBoard({&one, 1, 1, 1}, MarkedPattern(9, 6)).has_value());
  EXPECT_FALSE(FindBoard({nullptr, 0, 0, 0}, Pattern(9, 6)).has_value());
}

TEST(BoardDetection, RefusesPatternsThatCannotBe) {
  EXPECT_TRUE(CheckPattern(Pattern(9, 6)).ok());
  EXPECT_TRUE(CheckPattern(MarkedPattern(9, 6)).ok());
  EXPECT_FALSE(CheckPattern(Pattern(2, 6)).ok());
  EXPECT_FALSE(CheckPattern(Pattern(9, 1000)).ok());
  EXPECT_FALSE(CheckPattern({9, 6, 0.0, {}}).ok());
  EXPECT_FALSE(CheckPattern({9, 6, kSquare_m, BoardMarkers{"5x5_100", 0.03}}).ok());
  EXPECT_FALSE(CheckPattern({9, 6, kSquare_m, BoardMarkers{"no such", 0.018}}).ok());
  EXPECT_FALSE(CheckPattern({30, 30, kSquare_m, BoardMarkers{"4x4_50", 0.018}}).ok());
}

}  // namespace
}  // namespace lodemark
