// The adjustment against OpenCV's iterative solver, which shares nothing with ours, on simulated
// and on real sights.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "core/resection/collinearity.h"
#include "core/resection/refinement.h"
#include "core/resection/resection.h"
#include "test/recordings.h"
#include "test/unit/resection/resection_scene.h"

namespace lodemark {
namespace {

Rigid3 SolvedByOpenCv(const std::vector<LandmarkSight>& sights, const Lens& lens,
                      const Rigid3& start) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const LandmarkSight& sight : sights) {
    points.emplace_back(sight.landmark_in_enu_m.x(), sight.landmark_in_enu_m.y(),
                        sight.landmark_in_enu_m.z());
    pixels.emplace_back(sight.pixel.x(), sight.pixel.y());
  }
  const LensParameters& p = lens.parameters();
  const cv::Matx33d camera(p.fx_px, 0, p.cx_px, 0, p.fy_px, p.cy_px, 0, 0, 1);
  const std::vector<double> distortion(p.coefficients.begin(), p.coefficients.begin() + 5);
  const Eigen::AngleAxisd turn(start.rotation());
  const Eigen::Vector3d r = turn.angle() * turn.axis();
  const Eigen::Vector3d& t = start.translation();
  cv::Mat rotation = (cv::Mat_<double>(3, 1) << r.x(), r.y(), r.z());
  cv::Mat translation = (cv::Mat_<double>(3, 1) << t.x(), t.y(), t.z());
  cv::solvePnPRefineLM(
      points, pixels, camera, distortion, rotation, translation,
      cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-15));
  const Eigen::Vector3d solved(rotation.at<double>(0), rotation.at<double>(1),
                               rotation.at<double>(2));
  return {Eigen::Quaterniond(Eigen::AngleAxisd(solved.norm(), solved.normalized())),
          Eigen::Vector3d(translation.at<double>(0), translation.at<double>(1),
                          translation.at<double>(2))};
}

TEST(RefinePose, EndsWhereOpenCvDoes) {
  SceneOptions options;
  options.outlier_share = 0.0;
  options.sights = 25;
  for (options.seed = 1; options.seed <= 20; ++options.seed) {
    ResectionScene scene = MakeResectionScene(options);
    LensParameters parameters = scene.lens.parameters();
    parameters.model = LensModel::kBrown;
    parameters.coefficients = {-0.02, 0.01, 0.0005, -0.0003, 0.002};
    scene.lens = *Lens::Create(parameters);
    const RefinedPose refined =
        RefinePose(scene.camera_from_enu, scene.sights, {}, scene.lens, {}, {1.0, 0.0, 50});
    const Rigid3 theirs = SolvedByOpenCv(scene.sights, scene.lens, scene.camera_from_enu);
    EXPECT_LT(
        (CameraPose(refined.camera_from_enu).centre_in_enu_m - CameraPose(theirs).centre_in_enu_m)
            .norm(),
        1e-6);
    EXPECT_LT(refined.camera_from_enu.rotation().angularDistance(theirs.rotation()), 1e-7);
  }
}

std::vector<double> NumbersOf(std::string line) {
  for (char& letter : line) {
    if (letter == ',') letter = ' ';
  }
  std::istringstream stream(line);
  std::vector<double> numbers;
  for (double number = 0.0; stream >> number;) numbers.push_back(number);
  return numbers;
}

// Median over the sets of the root mean square per sight.
TEST(RecordedResection, FitsRealSetsOfTwelvePointsAsPoseLibAndOpenCvDo) {
  LODEMARK_NEEDS_RECORDING("vision/uzh_board_corners");
  const std::string folder = test::RecordingPath("vision/uzh_board_corners");
  std::string line;
  std::ifstream of_camera(folder + "/K.txt");
  std::vector<double> k;
  while (std::getline(of_camera, line)) {
    for (const double number : NumbersOf(line)) k.push_back(number);
  }
  ASSERT_EQ(k.size(), 9u);
  LensParameters parameters;
  parameters.width_px = 752;
  parameters.height_px = 480;
  parameters.fx_px = k[0];
  parameters.fy_px = k[4];
  parameters.cx_px = k[2];
  parameters.cy_px = k[5];
  const Lens lens = *Lens::Create(parameters);
  std::vector<Eigen::Vector3d> points;
  std::ifstream of_points(folder + "/p_W_corners.txt");
  while (std::getline(of_points, line)) {
    const std::vector<double> numbers = NumbersOf(line);
    if (numbers.size() == 3) points.emplace_back(numbers[0], numbers[1], numbers[2]);
  }
  ASSERT_EQ(points.size(), 12u);

  std::vector<double> rms_px;
  int sets = 0;
  int poses = 0;
  std::ifstream of_corners(folder + "/detected_corners.txt");
  while (std::getline(of_corners, line)) {
    const std::vector<double> numbers = NumbersOf(line);
    if (numbers.size() != 24) continue;
    std::vector<LandmarkSight> sights(12);
    for (std::size_t i = 0; i < 12; ++i) {
      sights[i].pixel = {numbers[2 * i], numbers[2 * i + 1]};
      sights[i].landmark_in_enu_m = 0.01 * points[i];  // given in centimetres
    }
    const Result<ResectedPose> found = Resect(sights, lens, {}, {});
    ASSERT_TRUE(found.ok());
    ++sets;
    if (found->verdict != PoseVerdict::kPose) continue;
    ++poses;
    const RefinedPose refined =
        RefinePose(found->camera_from_enu, sights, {}, lens, {}, {1.0, 0.0, 50});
    rms_px.push_back(std::sqrt(2.0 * refined.cost / 12.0));
    const Rigid3 theirs = SolvedByOpenCv(sights, lens, found->camera_from_enu);
    EXPECT_LT((refined.camera_from_enu.translation() - theirs.translation()).norm(), 1e-6);
  }
  ASSERT_GT(sets, 100);
  EXPECT_EQ(poses, sets);
  std::sort(rms_px.begin(), rms_px.end());
  EXPECT_NEAR(0.5 * (rms_px[(rms_px.size() - 1) / 2] + rms_px[rms_px.size() / 2]), 0.762, 0.0005);
}

}  // namespace
}  // namespace lodemark
