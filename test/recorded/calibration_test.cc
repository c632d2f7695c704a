// Boards that were photographed, against OpenCV's calibrations of the same corners.
#include "core/camera/calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/persistence.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/camera/board_detection.h"
#include "test/recordings.h"
#include "test/unit/camera/board_scene.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;
using test::IntrinsicsOf;

// The boards of the photographs whose names begin so, every nth.
struct Photographs {
  std::vector<BoardView> views;
  cv::Size size;
  int count = 0;
};

Photographs ReadBoards(const std::string& set, const std::string& beginning,
                       const BoardPattern& pattern, std::size_t every = 1) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(test::RecordingPath(set) + "/images")) {
    if (entry.path().filename().string().starts_with(beginning)) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  Photographs photographs;
  for (std::size_t i = 0; i < paths.size(); i += every) {
    const cv::Mat image = cv::imread(paths[i].string(), cv::IMREAD_GRAYSCALE);
    photographs.size = image.size();
    ++photographs.count;
    auto view = FindBoard(
        {image.data, image.cols, image.rows, static_cast<std::ptrdiff_t>(image.step)}, pattern);
    if (!view) continue;
    view->name = paths[i].filename().string();
    photographs.views.push_back(std::move(*view));
  }
  return photographs;
}

// The views that were used, as OpenCV takes them.
struct CvViews {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> corners;
};

CvViews ForOpenCv(const std::vector<BoardView>& views, const Calibration& calibration) {
  CvViews converted;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!calibration.views[i].is_used) continue;
    auto& board = converted.boards.emplace_back();
    auto& corners = converted.corners.emplace_back();
    for (const BoardCorner& corner : views[i].corners) {
      board.emplace_back(static_cast<float>(corner.board_m.x()),
                         static_cast<float>(corner.board_m.y()), 0.0f);
      corners.emplace_back(static_cast<float>(corner.pixel.x()),
                           static_cast<float>(corner.pixel.y()));
    }
  }
  return converted;
}

// OpenCV weighs all corners alike, so the same is asked of Lodemark, for the model it chose.
BoardAdjustment WithoutKernel(const std::vector<BoardView>& views, const Calibration& calibration) {
  LensAndBoards start = {calibration.lens, {}};
  std::vector<const BoardView*> used;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!calibration.views[i].is_used) continue;
    used.push_back(&views[i]);
    start.camera_from_board.push_back(calibration.views[i].camera_from_board);
  }
  BoardAdjustmentOptions options;
  options.kernel_sigmas = 1e6;
  return *AdjustBoards(start, used, calibration.form, options);
}

// To a hundredth of a sigma.
void ExpectSame(const BoardAdjustment& adjusted, const cv::Mat& matrix,
                const cv::Mat& coefficients) {
  const LensParameters& lens = adjusted.estimate.lens;
  std::vector<double> values = {lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px};
  std::vector<double> expected = {matrix.at<double>(0, 0), matrix.at<double>(1, 1),
                                  matrix.at<double>(0, 2), matrix.at<double>(1, 2)};
  for (int i = 0; i < static_cast<int>(coefficients.total()); ++i) {
    values.push_back(lens.coefficients[static_cast<std::size_t>(i)]);
    expected.push_back(coefficients.at<double>(i));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(values[i], expected[i], 0.01 * std::sqrt(adjusted.covariance(index, index)) + 1e-9)
        << i;
  }
}

void ExpectAsOpenCv(const std::vector<BoardView>& views, const Calibration& calibration) {
  const CvViews given = ForOpenCv(views, calibration);
  const cv::Size size(calibration.lens.width_px, calibration.lens.height_px);
  cv::Mat matrix;
  cv::Mat coefficients;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  double rms_px = 0.0;
  if (calibration.lens.model == LensModel::kFisheye) {
    int flags = cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW |
                cv::fisheye::CALIB_USE_INTRINSIC_GUESS;
    const int fixed[] = {cv::fisheye::CALIB_FIX_K1, cv::fisheye::CALIB_FIX_K2,
                         cv::fisheye::CALIB_FIX_K3, cv::fisheye::CALIB_FIX_K4};
    for (int i = 0; i < 4; ++i) {
      if (!IsFree(calibration.form, i)) flags |= fixed[i];
    }
    // It does not come to rest from its own start.
    const LensParameters& lens = calibration.lens;
    matrix = (cv::Mat_<double>(3, 3) << 1.03 * lens.fx_px, 0, lens.cx_px + 5.0, 0,
              1.03 * lens.fy_px, lens.cy_px - 5.0, 0, 0, 1);
    coefficients = cv::Mat::zeros(4, 1, CV_64F);
    rms_px = cv::fisheye::calibrate(
        given.boards, given.corners, size, matrix, coefficients, rotations, translations, flags,
        cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-10));
  } else {
    ASSERT_EQ(calibration.lens.model, LensModel::kBrown);
    int flags = 0;
    if (!IsFree(calibration.form, 1)) flags |= cv::CALIB_FIX_K2;
    if (!IsFree(calibration.form, 2)) flags |= cv::CALIB_ZERO_TANGENT_DIST;
    if (!IsFree(calibration.form, 4)) flags |= cv::CALIB_FIX_K3;
    ASSERT_FALSE(IsFree(calibration.form, 5));
    rms_px = cv::calibrateCamera(
        given.boards, given.corners, size, matrix, coefficients, rotations, translations, flags,
        cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-12));
  }
  const BoardAdjustment adjusted = WithoutKernel(views, calibration);
  EXPECT_NEAR(adjusted.rms_px, rms_px, 1e-5 * rms_px);
  ExpectSame(adjusted, matrix, coefficients);
}

int CountFree(const LensForm& form) {
  int count = 0;
  for (int i = 0; i < kMostLensCoefficients; ++i) count += IsFree(form, i) ? 1 : 0;
  return count;
}

struct BoardSet {
  std::string folder;
  std::string beginning;
  int columns;
  int rows;
  double square_m;
  double other_rms_px;  // what OpenCV's programs reach with their own corners
  int least_used;
  int most_coefficients;
};

class CalibrationRecorded : public testing::TestWithParam<BoardSet> {};

TEST_P(CalibrationRecorded, FitsAsWellAsOpenCvWithoutOverfitting) {
  const BoardSet& set = GetParam();
  LODEMARK_NEEDS_RECORDING(set.folder);
  const Photographs boards =
      ReadBoards(set.folder, set.beginning, {set.columns, set.rows, set.square_m, {}});
  const auto calibration = Calibrate(boards.size.width, boards.size.height, boards.views);
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  RecordProperty("used", calibration->views_used);
  RecordProperty("rms_px", std::to_string(calibration->rms_px));
  EXPECT_GE(calibration->views_used, set.least_used);
  EXPECT_LE(calibration->rms_px, 1.02 * set.other_rms_px);
  EXPECT_LE(CountFree(calibration->form), set.most_coefficients) << NameOf(calibration->form);
  EXPECT_EQ(UnseenShare(calibration->lens), 0.0);
  ExpectAsOpenCv(boards.views, *calibration);
}

// Each half of the photographs with the model that all of them choose.
TEST_P(CalibrationRecorded, AgreesBetweenHalvesOfThePhotographs) {
  const BoardSet& set = GetParam();
  LODEMARK_NEEDS_RECORDING(set.folder);
  const Photographs boards =
      ReadBoards(set.folder, set.beginning, {set.columns, set.rows, set.square_m, {}});
  const auto calibration = Calibrate(boards.size.width, boards.size.height, boards.views);
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  BoardAdjustment halves[2];
  for (std::size_t half = 0; half < 2; ++half) {
    LensAndBoards start = {calibration->lens, {}};
    std::vector<const BoardView*> used;
    for (std::size_t i = half; i < boards.views.size(); i += 2) {
      if (!calibration->views[i].is_used) continue;
      used.push_back(&boards.views[i]);
      start.camera_from_board.push_back(calibration->views[i].camera_from_board);
    }
    halves[half] = *AdjustBoards(start, used, calibration->form, {});
  }
  const Eigen::MatrixXd covariance = halves[0].covariance + halves[1].covariance;
  const Eigen::VectorXd difference =
      IntrinsicsOf(halves[0].estimate.lens) - IntrinsicsOf(halves[1].estimate.lens);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    if (covariance(i, i) > 0.0) free.push_back(i);
  }
  const Eigen::VectorXd own = difference(free);
  const Eigen::MatrixXd metric = covariance(free, free);
  const double squares = own.dot(metric.ldlt().solve(own)) / static_cast<double>(free.size());
  RecordProperty("squares_per_unknown", std::to_string(squares));
  RecordProperty("view_scatter", std::to_string(calibration->view_scatter));
  EXPECT_LT(squares, 4.0);
}

INSTANTIATE_TEST_SUITE_P(
    All, CalibrationRecorded,
    testing::Values(BoardSet{"vision/board_opencv_stereo", "left", 9, 6, 0.025, 0.230, 13, 4},
                    BoardSet{"vision/board_opencv_stereo", "right", 9, 6, 0.025, 0.244, 13, 4},
                    BoardSet{"vision/board_gopro_20161114", "", 8, 6, 0.025, 0.447, 34, 3},
                    BoardSet{"vision/board_fisheye_20160627", "", 15, 9, 0.026, 0.371, 20, 3}),
    [](const auto& set) {
      return set.param.folder.substr(set.param.folder.find('_') + 1, 5) + set.param.beginning;
    });

// The same corners that a well-known program found and could not calibrate (rms 190 px).
TEST(CalibrationRecorded, CalibratesCornersThatAnotherProgramCouldNot) {
  LODEMARK_NEEDS_RECORDING("vision/board_fisheye_20160627");
  const cv::FileStorage file(
      test::RecordingPath("vision/board_fisheye_20160627/out_camera_fisheye_data.xml"),
      cv::FileStorage::READ);
  cv::Mat points;
  file["image_points"] >> points;
  ASSERT_EQ(points.cols, 135);
  std::vector<BoardView> views(static_cast<std::size_t>(points.rows));
  for (int row = 0; row < points.rows; ++row) {
    BoardView& view = views[static_cast<std::size_t>(row)];
    view.name = std::to_string(row);
    for (int i = 0; i < 135; ++i) {
      const auto& pixel = points.at<cv::Vec2f>(row, i);
      view.corners.push_back({{0.026 * (i % 15), 0.026 * (i / 15)}, {pixel[0], pixel[1]}});
    }
  }
  const auto calibration = Calibrate(1000, 750, views);
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  RecordProperty("rms_px", std::to_string(calibration->rms_px));
  EXPECT_EQ(calibration->lens.model, LensModel::kFisheye);
  // In four of the photographs a tenth to a half of the corners are off by up to 11 px.
  EXPECT_GE(calibration->views_used, 17);
  EXPECT_LE(calibration->rms_px, 1.02 * 0.371);
  ExpectAsOpenCv(views, *calibration);
}

// Published with the recording: its matrix, and k1 k2 of a pinhole in pixels.
TEST(CalibrationRecorded, AgreesWithThePublishedLensOfAHandHeldCamera) {
  LODEMARK_NEEDS_RECORDING("vision/uzh_board_handheld");
  const Photographs boards = ReadBoards("vision/uzh_board_handheld", "", {9, 6, 0.04, {}}, 6);
  const auto calibration = Calibrate(boards.size.width, boards.size.height, boards.views);
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  RecordProperty("used", calibration->views_used);
  RecordProperty("rms_px", std::to_string(calibration->rms_px));
  RecordProperty("fx_px", std::to_string(calibration->lens.fx_px));
  EXPECT_NEAR(calibration->lens.fx_px, 420.506712, 4.0);
  EXPECT_NEAR(calibration->lens.fy_px, 420.610940, 4.0);
  EXPECT_NEAR(calibration->lens.cx_px, 355.208298, 4.0);
  EXPECT_NEAR(calibration->lens.cy_px, 250.336787, 4.0);
}

}  // namespace
}  // namespace lodemark
