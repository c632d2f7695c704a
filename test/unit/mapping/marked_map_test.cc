#include "tools/mapping/marked_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "test/unit/mapping/scratch_folder.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 480;

// Bright blobs of different shapes on grey: what a detector finds at its middle.
void DrawBlob(double x, double y, int shape, cv::Mat* image) {
  for (int row = 0; row < image->rows; ++row) {
    for (int column = 0; column < image->cols; ++column) {
      const double dx = column - x;
      const double dy = row - y;
      const double near = std::exp(-(dx * dx + dy * dy) / (2.0 * 9.0));
      const double far = std::exp(-((dx - 9.0 * std::cos(shape)) * (dx - 9.0 * std::cos(shape)) +
                                    (dy - 9.0 * std::sin(shape)) * (dy - 9.0 * std::sin(shape))) /
                                  (2.0 * 16.0));
      auto& pixel = image->at<std::uint8_t>(row, column);
      pixel = cv::saturate_cast<std::uint8_t>(pixel + 120.0 * near - 60.0 * far);
    }
  }
}

// Eight surveyed points before a camera at a known place that looks north.
class MarkedScene {
 public:
  MarkedScene() {
    lens_.width_px = kWidth_px;
    lens_.height_px = kHeight_px;
    lens_.fx_px = lens_.fy_px = 600.0;
    lens_.cx_px = 319.5;
    lens_.cy_px = 239.5;
    Eigen::Matrix3d camera_axes;
    camera_axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    const Eigen::Quaterniond turn(camera_axes);
    const Rigid3 pose(turn, -(turn * centre_));
    const Lens lens = *Lens::Create(lens_);
    cv::Mat image(kHeight_px, kWidth_px, CV_8U, cv::Scalar(90));
    std::string survey = "point,east_m,north_m,up_m,sigma_m\n";
    Random random(3);
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d point(-3.0 + 2.0 * (i % 4) + random.Uniform(), 10.0 + 2.0 * (i % 3),
                                  i < 4 ? 0.5 : 3.0);
      const Eigen::Vector2d pixel = *lens.Project(pose * point);
      DrawBlob(pixel.x(), pixel.y(), i, &image);
      char row[200];
      std::snprintf(row, sizeof row, "p%d,%.6f,%.6f,%.6f,0.01\n", i, point.x(), point.y(),
                    point.z());
      survey += row;
      pixels_.push_back(pixel);
    }
    input_.images = folder_.path();
    input_.survey = folder_.Write("survey.csv", survey);
    input_.marks = ShiftedMarks(0.0);
    input_.frame.local = true;
    cv::imwrite(folder_.File("a.png"), image);
  }

  // Marks that all lie so far to the right of their points.
  std::string ShiftedMarks(double shift_px) const {
    std::string marks = "image,point,x_px,y_px\n";
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      char row[200];
      std::snprintf(row, sizeof row, "a.png,p%d,%.3f,%.3f\n", static_cast<int>(i),
                    pixels_[i].x() + shift_px, pixels_[i].y());
      marks += row;
    }
    return folder_.Write("marks.csv", marks);
  }

  const test::ScratchFolder& folder() const { return folder_; }
  const MarkedMapInput& input() const { return input_; }
  const LensParameters& lens() const { return lens_; }
  const Eigen::Vector3d& centre() const { return centre_; }

 private:
  test::ScratchFolder folder_;
  MarkedMapInput input_;
  LensParameters lens_;
  std::vector<Eigen::Vector2d> pixels_;  // of the points
  Eigen::Vector3d centre_{0.5, -1.0, 1.6};
};

void Quiet(const char*, double) {}

TEST(MarkedMap, DescribesSurveyedPointsByWhatIsAtTheirMarks) {
  const MarkedScene scene;
  const Result<BuiltMap> built = BuildMarkedMap(scene.input(), Quiet);
  ASSERT_TRUE(built.ok()) << built.error().message;
  EXPECT_EQ(built->content.landmarks.size(), 8U);
  EXPECT_GE(built->content.origins.size(), 8U);
  EXPECT_EQ(built->content.descriptors.size(), 128 * built->content.origins.size());
  EXPECT_NEAR(built->content.landmarks[0].covariance_m2(1, 1), 1e-4, 1e-12);
  EXPECT_FALSE(built->content.images.front().pose_known);
  EXPECT_EQ(built->content.origins.front().distance_m, 0.0F);
}

TEST(MarkedMap, FindsWherePhotographsWereTakenIfTheLensIsKnown) {
  const MarkedScene scene;
  MarkedMapInput input = scene.input();
  input.lens = scene.lens();
  const Result<BuiltMap> built = BuildMarkedMap(input, Quiet);
  ASSERT_TRUE(built.ok()) << built.error().message;
  const DatabaseImage& image = built->content.images.front();
  ASSERT_TRUE(image.pose_known);
  EXPECT_LT((image.position_in_enu_m - scene.centre()).norm(), 0.01);
  EXPECT_GT(built->content.origins.front().distance_m, 8.0F);
  input.lens->width_px = 641;
  EXPECT_FALSE(BuildMarkedMap(input, Quiet).ok());
}

TEST(MarkedMap, CountsHowFarFeaturesLieFromTheirMarks) {
  // A mark beside the middle of its blob: the feature is not the surveyed point.
  const MarkedScene scene;
  const auto sigma_m = [&](double shift_px) {
    MarkedMapInput input = scene.input();
    input.lens = scene.lens();
    input.marks = scene.ShiftedMarks(shift_px);
    const Result<BuiltMap> built = BuildMarkedMap(input, Quiet);
    if (!built.ok() || !built->content.images.front().pose_known) return -1.0;
    return std::sqrt(built->content.landmarks[0].covariance_m2.trace());
  };
  const double at_marks_m = sigma_m(0.0);
  const double beside_m = sigma_m(1.2);
  EXPECT_GT(at_marks_m, std::sqrt(3e-4));
  EXPECT_LT(at_marks_m, std::sqrt(3e-4) + 0.01);
  // 1.2 px of 600 at 11 m.
  EXPECT_NEAR(beside_m, std::hypot(std::sqrt(3e-4), 1.2 * 11.0 / 600.0), 0.006);
}

TEST(MarkedMap, SaysWhichMarksAreOfNoUse) {
  const MarkedScene scene;
  MarkedMapInput input = scene.input();
  const auto fault = [&](const std::string& rows) {
    input.marks = scene.folder().Write("m.csv", "image,point,x_px,y_px\n" + rows);
    const Result<BuiltMap> built = BuildMarkedMap(input, Quiet);
    return built.ok() ? std::string("none") : built.error().message;
  };
  EXPECT_THAT(fault("a.png,p0,20,450\n"), HasSubstr("no mark lies at anything distinct"));
  EXPECT_THAT(fault("a.png,p9,20,450\n"), HasSubstr("point 'p9' in a.png is not in"));
  EXPECT_THAT(fault("a.png,p1,900,450\n"), HasSubstr("outside the image"));
  EXPECT_THAT(fault("b.png,p1,20,450\n"), HasSubstr("b.png"));
  EXPECT_THAT(fault("a.png,p1,20,450\na.png,p1,21,450\n"), HasSubstr("marked twice"));
}

}  // namespace
}  // namespace lodemark
