#include "core/camera/calibration_start.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lodemark {
namespace {

constexpr std::size_t kLeastCorners = 4;
constexpr std::size_t kLeastViews = 3;
constexpr int kStartIterations = 12;

// Focal lengths to try, in sides of the image: 130 to 15 degrees of it for a plane image, 360 to 60
// for an equidistant one.
constexpr std::array kPlaneFocals = {0.25, 0.4, 0.6, 0.9, 1.4, 2.2, 4.0};
constexpr std::array kEquidistantFocals = {0.16, 0.22, 0.3, 0.42, 0.6, 0.9};

// Second smallest eigenvalue of the equations for a homography, relative to the largest, below
// which more than one fits: corners in one line.
constexpr double kLeastSpread = 1e-9;

LensParameters Plain(LensModel model, int width_px, int height_px, double f_px) {
  LensParameters lens;
  lens.model = model;
  lens.width_px = width_px;
  lens.height_px = height_px;
  lens.fx_px = f_px;
  lens.fy_px = f_px;
  lens.cx_px = 0.5 * (width_px - 1);
  lens.cy_px = 0.5 * (height_px - 1);
  return lens;
}

// Takes a point of the board, shifted and scaled to the order of one, to the direction it is seen
// in, up to a factor that is positive for the corners.
struct Homography {
  Eigen::Matrix3d direction_from_unit;
  Eigen::Matrix3d unit_from_board;
};

std::optional<Homography> HomographyOf(const BoardView& view,
                                       std::span<const Eigen::Vector3d> directions) {
  if (view.corners.size() < kLeastCorners) return std::nullopt;
  const auto count = static_cast<double>(view.corners.size());
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const BoardCorner& corner : view.corners) middle += corner.board_m / count;
  double spread = 0.0;
  for (const BoardCorner& corner : view.corners) spread += (corner.board_m - middle).norm() / count;
  if (!(spread > 0.0)) return std::nullopt;
  Homography h;
  h.unit_from_board << 1.0 / spread, 0.0, -middle.x() / spread, 0.0, 1.0 / spread,
      -middle.y() / spread, 0.0, 0.0, 1.0;

  // direction x (H point) = 0
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3d point = h.unit_from_board * view.corners[i].board_m.homogeneous();
    const Eigen::Vector3d& d = directions[i];
    Eigen::Matrix3d cross;
    cross << 0.0, -d.z(), d.y(), d.z(), 0.0, -d.x(), -d.y(), d.x(), 0.0;
    Eigen::Matrix<double, 3, 9> rows;
    rows << point.x() * cross, point.y() * cross, cross;
    normal += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(normal);
  if (eigen.info() != Eigen::Success ||
      !(eigen.eigenvalues()[1] > kLeastSpread * eigen.eigenvalues()[8])) {
    return std::nullopt;
  }
  const Eigen::Matrix<double, 9, 1> solution = eigen.eigenvectors().col(0);
  h.direction_from_unit = Eigen::Map<const Eigen::Matrix3d>(solution.data());
  double forwards = 0.0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3d point = h.unit_from_board * view.corners[i].board_m.homogeneous();
    forwards += directions[i].dot(h.direction_from_unit * point);
  }
  if (forwards < 0.0) h.direction_from_unit = -h.direction_from_unit;
  return h;
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The views that have a pose through the lens, refined together with it.
std::optional<CalibrationStart> TryStart(std::span<const BoardView* const> views,
                                         const LensParameters& first) {
  const Result<Lens> lens = Lens::Create(first);
  if (!lens) return std::nullopt;
  CalibrationStart start;
  LensAndBoards state = {first, {}};
  std::vector<const BoardView*> used;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::optional<Rigid3> pose = BoardPose(*views[i], *lens);
    if (!pose) continue;
    const bool is_imaged = std::all_of(
        views[i]->corners.begin(), views[i]->corners.end(), [&](const BoardCorner& corner) {
          return lens->Project(*pose * Eigen::Vector3d(corner.board_m.x(), corner.board_m.y(), 0.0))
              .has_value();
        });
    if (!is_imaged) continue;
    start.used.push_back(i);
    used.push_back(views[i]);
    state.camera_from_board.push_back(*pose);
  }
  if (used.size() < kLeastViews) return std::nullopt;
  BoardAdjustmentOptions options;
  options.most_iterations = kStartIterations;
  const auto adjusted = AdjustBoards(std::move(state), used, {first.model, 1u}, options);
  if (!adjusted) return std::nullopt;
  start.estimate = adjusted->estimate;
  std::vector<double> rms_px;
  for (const auto& residuals : adjusted->residuals_px) rms_px.push_back(RmsOf(residuals));
  start.median_rms_px = MedianOf(std::move(rms_px));
  return start;
}

}  // namespace

std::optional<LensParameters> ZhangLens(std::span<const BoardView* const> views, int width_px,
                                        int height_px) {
  // Zhang, "A flexible new technique for camera calibration" (2000), equations 3 and 4 with a known
  // principal point and no skew: the columns of K^-1 H are orthogonal and of one length, which is
  // linear in 1/fx^2 and 1/fy^2. In units of the image's side for conditioning.
  const double side_px = std::max(width_px, height_px);
  const LensParameters unit = Plain(LensModel::kPinhole, width_px, height_px, side_px);
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const BoardView* view : views) {
    std::vector<Eigen::Vector3d> directions;
    for (const BoardCorner& corner : view->corners) {
      directions.emplace_back((corner.pixel.x() - unit.cx_px) / side_px,
                              (corner.pixel.y() - unit.cy_px) / side_px, 1.0);
    }
    const std::optional<Homography> homography = HomographyOf(*view, directions);
    if (!homography) continue;
    Eigen::Matrix3d h = homography->direction_from_unit;
    h /= h.leftCols<2>().norm();
    Eigen::Matrix2d rows;
    rows << h(0, 0) * h(0, 1), h(1, 0) * h(1, 1),  //
        h(0, 0) * h(0, 0) - h(0, 1) * h(0, 1), h(1, 0) * h(1, 0) - h(1, 1) * h(1, 1);
    const Eigen::Vector2d goal(-h(2, 0) * h(2, 1), h(2, 1) * h(2, 1) - h(2, 0) * h(2, 0));
    normal += rows.transpose() * rows;
    right += rows.transpose() * goal;
  }
  const Eigen::Vector2d inverse_squares = normal.ldlt().solve(right);
  // 178 to 1 degrees of image
  const auto is_plausible = [](double v) { return v > 1e-4 && v < 1e4; };
  if (!is_plausible(inverse_squares.x()) || !is_plausible(inverse_squares.y())) {
    return std::nullopt;
  }
  LensParameters lens = unit;
  lens.fx_px = side_px / std::sqrt(inverse_squares.x());
  lens.fy_px = side_px / std::sqrt(inverse_squares.y());
  return lens;
}

std::optional<Rigid3> BoardPose(const BoardView& view, const Lens& lens) {
  std::vector<Eigen::Vector3d> directions;
  for (const BoardCorner& corner : view.corners) {
    const auto direction = lens.Unproject(corner.pixel);
    if (!direction) return std::nullopt;
    directions.push_back(*direction);
  }
  const std::optional<Homography> homography = HomographyOf(view, directions);
  if (!homography) return std::nullopt;
  // [r1 r2 t], up to a positive factor
  const Eigen::Matrix3d columns = homography->direction_from_unit * homography->unit_from_board;
  const double scale = 2.0 / (columns.col(0).norm() + columns.col(1).norm());
  if (!std::isfinite(scale)) return std::nullopt;
  Eigen::Matrix3d rough;
  rough.leftCols<2>() = scale * columns.leftCols<2>();
  rough.col(2) = rough.col(0).cross(rough.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rough, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  const Eigen::Vector3d translation = scale * columns.col(2);
  if (!rotation.allFinite() || !translation.allFinite() || !(rotation.determinant() > 0.0)) {
    return std::nullopt;
  }
  return Rigid3(Eigen::Quaterniond(rotation), translation);
}

std::optional<CalibrationStart> StartCalibration(std::span<const BoardView* const> views,
                                                 LensModel model, int width_px, int height_px) {
  std::vector<LensParameters> lenses;
  const double side_px = std::max(width_px, height_px);
  if (model == LensModel::kFisheye) {
    for (const double f : kEquidistantFocals) {
      lenses.push_back(Plain(model, width_px, height_px, f * side_px));
    }
  } else {
    if (const auto zhang = ZhangLens(views, width_px, height_px)) lenses.push_back(*zhang);
    for (const double f : kPlaneFocals) {
      lenses.push_back(Plain(model, width_px, height_px, f * side_px));
    }
  }
  std::vector<CalibrationStart> starts;
  std::size_t most_used = 0;
  for (LensParameters& lens : lenses) {
    lens.model = model;
    std::optional<CalibrationStart> start = TryStart(views, lens);
    if (!start) continue;
    most_used = std::max(most_used, start->used.size());
    starts.push_back(std::move(*start));
  }
  // A lens that shows few of the boards fits those few easily.
  std::optional<CalibrationStart> best;
  for (CalibrationStart& start : starts) {
    if (4 * start.used.size() < 3 * most_used) continue;
    if (!best || start.median_rms_px < best->median_rms_px) best = std::move(start);
  }
  return best;
}

}  // namespace lodemark
