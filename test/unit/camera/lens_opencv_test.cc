// OpenCV's own projections, and COLMAP's published equations, as independent answers.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "core/camera/lens.h"
#include "test/unit/camera/lenses.h"

namespace lodemark {
namespace {

using test::Lens1000;
using test::ManyLenses;

cv::Matx33d CameraMatrix(const LensParameters& p) {
  return {p.fx_px, 0.0, p.cx_px, 0.0, p.fy_px, p.cy_px, 0.0, 0.0, 1.0};
}

std::vector<cv::Point3d> PointsInFront() {
  std::vector<cv::Point3d> points;
  for (double x = -2.5; x <= 2.5; x += 0.25) {
    for (double y = -2.0; y <= 2.0; y += 0.25) points.emplace_back(x, y, 3.0);
  }
  return points;
}

TEST(LensOpenCv, ProjectsAsProjectPointsDoes) {
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  const std::vector<cv::Point3d> points = PointsInFront();
  for (const auto& [name, p] : ManyLenses()) {
    if (p.model != LensModel::kBrown && p.model != LensModel::kPinhole) continue;
    const std::vector<double> coefficients(p.coefficients.begin(), p.coefficients.end());
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, zero, zero, CameraMatrix(p), coefficients, expected);
    const Result<Lens> lens = Lens::Create(p);
    int compared = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto pixel = lens->Project({points[i].x, points[i].y, points[i].z});
      if (!pixel) continue;
      ++compared;
      EXPECT_NEAR(pixel->x(), expected[i].x, 1e-9) << name;
      EXPECT_NEAR(pixel->y(), expected[i].y, 1e-9) << name;
    }
    EXPECT_GT(compared, 200) << name;
  }
}

TEST(LensOpenCv, ProjectsAsTheFisheyeDoes) {
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  const std::vector<cv::Point3d> points = PointsInFront();
  for (const auto& [name, p] : ManyLenses()) {
    if (p.model != LensModel::kFisheye) continue;
    const cv::Vec4d coefficients(p.coefficients.data());
    std::vector<cv::Point2d> expected;
    cv::fisheye::projectPoints(points, expected, zero, zero, CameraMatrix(p), coefficients);
    const Result<Lens> lens = Lens::Create(p);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto pixel = lens->Project({points[i].x, points[i].y, points[i].z});
      ASSERT_TRUE(pixel.has_value()) << name;
      EXPECT_NEAR(pixel->x(), expected[i].x, 1e-9) << name;
      EXPECT_NEAR(pixel->y(), expected[i].y, 1e-9) << name;
    }
  }
}

// OpenCV's derivatives by the intrinsics are its own analytic ones.
TEST(LensOpenCv, DerivesAsProjectPointsDoes) {
  const LensParameters p = Lens1000(
      LensModel::kBrown, 700.0,
      {-0.1, 0.05, 1e-3, 2e-3, 0.02, 0.01, -0.02, 0.03, 1e-3, 1e-3, 2e-3, 1e-3, 0.12, -0.2});
  const std::vector<double> coefficients(p.coefficients.begin(), p.coefficients.end());
  const std::vector<cv::Point3d> points = PointsInFront();
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  std::vector<cv::Point2d> pixels;
  cv::Mat expected;
  cv::projectPoints(points, zero, zero, CameraMatrix(p), coefficients, pixels, expected);
  const Result<Lens> lens = Lens::Create(p);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ProjectionJacobian jacobian;
    ASSERT_TRUE(lens->Project({points[i].x, points[i].y, points[i].z}, &jacobian).has_value());
    for (int row = 0; row < 2; ++row) {
      // Its columns: rotation, translation, fx fy cx cy, coefficients.
      for (int column = 0; column < 3; ++column) {
        EXPECT_NEAR(jacobian.by_point(row, column),
                    expected.at<double>(2 * static_cast<int>(i) + row, 3 + column), 1e-9);
      }
      for (int column = 0; column < kMostIntrinsics; ++column) {
        EXPECT_NEAR(jacobian.by_intrinsics(row, column),
                    expected.at<double>(2 * static_cast<int>(i) + row, 6 + column), 1e-8)
            << column;
      }
    }
  }
}

// COLMAP's ThinPrismFisheyeCameraModel, written out: u, v equidistant; du = u radial + 2 p1 u v +
// p2 (r2 + 2 u^2) + sx1 r2, dv = v radial + 2 p2 u v + p1 (r2 + 2 v^2) + sy1 r2.
TEST(LensColmap, ProjectsAsTheThinPrismFisheyeDoes) {
  const LensParameters p = Lens1000(LensModel::kThinPrismFisheye, 300.0,
                                    {-0.02, 0.005, 1e-3, -2e-3, 1e-3, -2e-4, 3e-3, -1e-3});
  const auto& k = p.coefficients;
  const Result<Lens> lens = Lens::Create(p);
  for (const cv::Point3d& point : PointsInFront()) {
    if (point.x == 0.0 && point.y == 0.0) continue;
    const double across = std::hypot(point.x, point.y);
    const double theta = std::atan2(across, point.z);
    const double u = theta * point.x / across;
    const double v = theta * point.y / across;
    const double r2 = u * u + v * v;
    const double radial =
        k[0] * r2 + k[1] * r2 * r2 + k[4] * r2 * r2 * r2 + k[5] * r2 * r2 * r2 * r2;
    const double du = u * radial + 2.0 * k[2] * u * v + k[3] * (r2 + 2.0 * u * u) + k[6] * r2;
    const double dv = v * radial + 2.0 * k[3] * u * v + k[2] * (r2 + 2.0 * v * v) + k[7] * r2;
    const auto pixel = lens->Project({point.x, point.y, point.z});
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->x(), 505.0 + 300.0 * (u + du), 1e-9);
    EXPECT_NEAR(pixel->y(), 340.0 + 303.0 * (v + dv), 1e-9);
  }
}

}  // namespace
}  // namespace lodemark
