#include "tools/mapping/colmap_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/random.h"
#include "core/base/units.h"
#include "test/unit/mapping/colmap_files.h"
#include "test/unit/mapping/scratch_folder.h"
#include "tools/mapping/colmap_database.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

// A square before six cameras, reconstructed in a frame of its own, with a table of surveyed marks.
class ColmapProject {
 public:
  ColmapProject() {
    model_from_enu_.scale = 0.2;
    model_from_enu_.rotation = Eigen::Quaterniond(0.4, 0.6, -0.2, 0.5).normalized();
    model_from_enu_.translation = {3.0, -1.0, 2.0};
    LensParameters parameters;
    parameters.width_px = 1000;
    parameters.height_px = 800;
    parameters.fx_px = parameters.fy_px = 900.0;
    parameters.cx_px = 499.5;  // COLMAP's 500
    parameters.cy_px = 399.5;
    lens_ = *Lens::Create(parameters);
    Random random(5);
    for (int i = 0; i < 60; ++i) {
      // In front of a facade to the north.
      points_.emplace_back(random.Uniform(-6, 6), 20.0 + random.Uniform(-2, 2),
                           random.Uniform(0, 8));
    }
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector3d centre(-5.0 + 2.0 * i, 0.5 * (i % 2), 1.5 + 0.2 * i);
      Eigen::Matrix3d camera_axes;  // x east, y down, z north
      camera_axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
      const Eigen::Quaterniond turn(camera_axes);
      poses_.emplace_back(turn, -(turn * centre));
    }
    Write();
  }

  ColmapMapInput Input() const {
    ColmapMapInput input;
    input.model = folder_.path();
    input.database = folder_.File("database.db");
    input.frame.origin = origin_;
    return input;
  }

  const test::ScratchFolder& folder() const { return folder_; }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  const std::vector<Rigid3>& poses() const { return poses_; }
  const Geodetic& origin() const { return origin_; }

 private:
  static std::string Numbers(const std::vector<double>& values) {
    std::string text;
    char number[40];
    for (const double value : values) {
      std::snprintf(number, sizeof number, "%.12g ", value);
      text += number;
    }
    return text;
  }

  void Write() {
    folder_.Write("cameras.txt", "1 PINHOLE 1000 800 900 900 500 400\n");
    test::ColmapDatabaseWriter database(folder_.File("database.db"));
    std::string images;
    std::string gcp = "point,image,x_px,y_px,east_m,north_m,up_m\n";
    std::vector<std::string> tracks(points_.size());
    Random random(6);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const std::string name = "im" + std::to_string(i) + ".jpg";
      const std::string id = std::to_string(i + 1);
      const Rigid3 pose = CameraFromTarget(poses_[i], model_from_enu_);
      const Eigen::Quaterniond& q = pose.rotation();
      const Eigen::Vector3d& t = pose.translation();
      images += id + " " + Numbers({q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) + "1 " +
                name + "\n";
      std::vector<float> keypoints;
      std::vector<std::uint8_t> descriptors;
      for (std::size_t p = 0; p < points_.size(); ++p) {
        const Eigen::Vector2d pixel = *lens_.Project(poses_[i] * points_[p]);
        const Eigen::Vector2d seen =
            pixel + 0.1 * Eigen::Vector2d(random.Gaussian(), random.Gaussian());
        images += Numbers({seen.x() + 0.5, seen.y() + 0.5}) + std::to_string(p + 1) + " ";
        keypoints.insert(keypoints.end(), {static_cast<float>(seen.x() + 0.5),
                                           static_cast<float>(seen.y() + 0.5), 1.5F, 0.0F});
        descriptors.insert(descriptors.end(), 128, static_cast<std::uint8_t>(p));
        tracks[p] += " " + id + " " + std::to_string(p);
        if (p < 5) {
          char row[200];
          std::snprintf(row, sizeof row, "p%zu,%s,%.4f,%.4f,%.4f,%.4f,%.4f\n", p, name.c_str(),
                        pixel.x(), pixel.y(), points_[p].x(), points_[p].y(), points_[p].z());
          gcp += row;
        }
      }
      images += "\n";
      database.AddImage(static_cast<int>(i) + 11, name);
      database.AddBlock("keypoints", static_cast<int>(i) + 11, 4, keypoints);
      database.AddBlock("descriptors", static_cast<int>(i) + 11, 128, descriptors);
    }
    folder_.Write("images.txt", images);
    std::string text;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const Eigen::Vector3d in_model = model_from_enu_ * points_[p];
      text += std::to_string(p + 1) + " " + Numbers({in_model.x(), in_model.y(), in_model.z()}) +
              "0 0 0 0.1" + tracks[p] + "\n";
    }
    folder_.Write("points3D.txt", text);
    folder_.Write("gcp.csv", gcp);
  }

  test::ScratchFolder folder_;
  Geodetic origin_{48.0 * kRadiansPerDegree, 8.0 * kRadiansPerDegree, 120.0};
  Similarity3 model_from_enu_;
  Lens lens_ = *Lens::Create({LensModel::kPinhole, 2, 2, 1.0, 1.0, 0.5, 0.5, {}});
  std::vector<Eigen::Vector3d> points_;
  std::vector<Rigid3> poses_;
};

void Quiet(const char*, double) {}

TEST(ImportColmap, LaysAModelOnTheEarthByControlPoints) {
  const ColmapProject project;
  ColmapMapInput input = project.Input();
  input.control_points = project.folder().File("gcp.csv");
  const Result<BuiltMap> built = ImportColmap(input, Quiet);
  ASSERT_TRUE(built.ok()) << built.error().message;
  ASSERT_TRUE(built->registration.has_value());
  EXPECT_EQ(built->registration->used, 5);
  EXPECT_NEAR(built->registration->enu_from_model.scale, 5.0, 1e-3);
  ASSERT_EQ(built->content.landmarks.size(), 60U);
  for (std::size_t p = 0; p < 60; ++p) {
    EXPECT_LT((built->content.landmarks[p].position_in_enu_m - project.points()[p]).norm(), 0.01);
  }
  // 0.1 px of noise on features whose scale is 1.5 px.
  const double relative_px = RelativeSigma_px(DescriptorKind::kRootSift, {0, 0, 3.0F, 0, 0});
  EXPECT_NEAR(built->noise_px, 0.1 / relative_px, 0.1);
  ASSERT_EQ(built->content.images.size(), 6U);
  EXPECT_EQ(built->content.images[2].name, "im2.jpg");
  EXPECT_LT(
      (built->content.images[2].position_in_enu_m - project.poses()[2].Inverse().translation())
          .norm(),
      0.02);
  ASSERT_EQ(built->content.origins.size(), 360U);
  EXPECT_EQ(built->content.descriptors[128 * 6 * 17], 17);
  const DescriptorOrigin& origin = built->content.origins[6 * 17 + 3];
  EXPECT_EQ(origin.landmark_id, 18U);
  EXPECT_EQ(origin.image_id, 4U);
  const Eigen::Vector3d seen_from =
      project.points()[17] +
      static_cast<double>(origin.distance_m) * origin.direction_to_camera.cast<double>();
  EXPECT_LT((seen_from - project.poses()[3].Inverse().translation()).norm(), 0.05);
}

TEST(ImportColmap, LaysAModelOnTheEarthByCameraPositions) {
  const ColmapProject project;
  const EnuFrame frame(project.origin());
  std::string csv = "name,ecef_x_m,ecef_y_m,ecef_z_m,sigma_m\n";
  for (std::size_t i = 0; i < project.poses().size(); ++i) {
    const Eigen::Vector3d at = frame.ToEcef(project.poses()[i].Inverse().translation());
    char row[200];
    std::snprintf(row, sizeof row, "im%zu.jpg,%.5f,%.5f,%.5f,0.01\n", i, at.x(), at.y(), at.z());
    csv += row;
  }
  ColmapMapInput input = project.Input();
  input.camera_positions = project.folder().Write("cameras.csv", csv);
  const Result<BuiltMap> built = ImportColmap(input, Quiet);
  ASSERT_TRUE(built.ok()) << built.error().message;
  for (std::size_t p = 0; p < 60; ++p) {
    EXPECT_LT((built->content.landmarks[p].position_in_enu_m - project.points()[p]).norm(), 0.02);
  }
}

TEST(ImportColmap, SaysWhatIsMissing) {
  const ColmapProject project;
  const auto fault = [](const ColmapMapInput& input) {
    const Result<BuiltMap> built = ImportColmap(input, Quiet);
    return built.ok() ? std::string("none") : built.error().message;
  };
  ColmapMapInput input = project.Input();
  EXPECT_EQ(fault(input), "none");
  input.frame.origin.reset();
  EXPECT_THAT(fault(input), HasSubstr("--gcp, --image-gps or --camera-positions"));
  input.frame.local = true;
  EXPECT_EQ(fault(input), "none");
  input.image_gps = project.folder().path();
  EXPECT_THAT(fault(input), HasSubstr("none of the model's photographs"));
  input.image_gps.clear();
  input.database = project.folder().File("cameras.txt");
  EXPECT_THAT(fault(input), HasSubstr("cameras.txt: is no database of COLMAP's"));
  input.database = project.folder().File("nothing.db");
  EXPECT_THAT(fault(input), HasSubstr("nothing.db"));
}

TEST(ColmapDatabase, RefusesWhatDoesNotBelongToTheModel) {
  const test::ScratchFolder folder;
  const std::string path = folder.File("database.db");
  {
    test::ColmapDatabaseWriter writer(path);
    writer.AddImage(1, "whole.jpg");
    writer.AddBlock("descriptors", 1, 128, std::vector<std::uint8_t>(256, 7));
    writer.AddBlock("keypoints", 1, 6, std::vector<float>{1, 2, 3, 0, 0, 3, 4, 5, 0, 2, -2, 0});
    writer.AddImage(2, "short.jpg");
    writer.AddBlock("descriptors", 2, 128, std::vector<std::uint8_t>(200, 7));
    writer.AddImage(3, "float.jpg");
    writer.AddBlock("descriptors", 3, 256, std::vector<std::uint8_t>(512, 7));
    writer.AddImage(4, "none.jpg");
    writer.Run("INSERT INTO descriptors VALUES (5, -3, 1099511627776, 'text')");
    writer.AddImage(5, "absurd.jpg");
  }
  auto database = ColmapDatabase::Open(path);
  ASSERT_TRUE(database.ok()) << database.error().message;
  const auto fault = [&](const char* name, std::size_t features) {
    ColmapImage image;
    image.name = name;
    image.features.resize(features);
    const auto read = (*database)->Features(image);
    return read.ok() ? std::string("none") : read.error().message;
  };
  EXPECT_EQ(fault("whole.jpg", 2), "none");
  EXPECT_THAT(fault("whole.jpg", 3), HasSubstr("a database of another model?"));
  EXPECT_THAT(fault("short.jpg", 1), HasSubstr("hold 200 bytes instead of 128"));
  EXPECT_THAT(fault("float.jpg", 2), HasSubstr("have 256 bytes each, not SIFT's 128"));
  EXPECT_EQ(fault("none.jpg", 0), "none");
  EXPECT_THAT(fault("none.jpg", 1), HasSubstr("are 0"));
  EXPECT_THAT(fault("absurd.jpg", 1), HasSubstr("absurd size"));
  EXPECT_THAT(fault("stranger.jpg", 1), HasSubstr("has no image 'stranger.jpg'"));
  ColmapImage image;
  image.name = "whole.jpg";
  image.features.resize(2);
  const auto features = (*database)->Features(image);
  ASSERT_TRUE(features.ok());
  // The scale of an affine shape is the root of its determinant.
  EXPECT_THAT(features->scale_px, testing::ElementsAre(3.0F, 2.0F));
}

}  // namespace
}  // namespace lodemark
