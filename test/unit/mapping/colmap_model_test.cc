#include "tools/mapping/colmap_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "test/unit/mapping/colmap_scene.h"
#include "test/unit/mapping/scratch_folder.h"

namespace lodemark {
namespace {

using test::CamerasBinary;
using test::ImagesBinary;
using test::kCamerasText;
using test::kImagesText;
using test::kPointsText;
using test::PointsBinary;
using testing::HasSubstr;

void ExpectTheScene(const ColmapModel& model) {
  ASSERT_EQ(model.cameras.size(), 2U);
  EXPECT_EQ(model.cameras[0].model, "PINHOLE");
  EXPECT_THAT(model.cameras[0].parameters, testing::ElementsAre(500.0, 510.0, 320.5, 240.5));
  EXPECT_EQ(model.cameras[1].id, 7U);
  EXPECT_EQ(model.cameras[1].width_px, 320U);
  ASSERT_EQ(model.images.size(), 2U);
  EXPECT_EQ(model.images[0].name, "a.jpg");
  EXPECT_TRUE(model.images[0].features.empty());
  // A quarter turn about y takes what is in front (z) to the right (x).
  const Eigen::Vector3d turned = model.images[0].camera_from_world * Eigen::Vector3d(0, 0, 1);
  EXPECT_LT((turned - Eigen::Vector3d(2, 2, 3)).norm(), 1e-12);
  const ColmapImage& street = model.images[1];
  EXPECT_EQ(street.name, "street/b 1.jpg");
  ASSERT_EQ(street.features.size(), 3U);
  EXPECT_EQ(street.features[0].x_px, 10.5);
  EXPECT_EQ(street.features[1].point_id, ColmapFeature::kNoPoint);
  EXPECT_EQ(street.features[2].point_id, 9U);
  ASSERT_EQ(model.points.size(), 2U);
  EXPECT_EQ(model.points[0].id, 5U);
  EXPECT_EQ(model.points[1].position, Eigen::Vector3d(0.25, -0.5, 6.5));
  EXPECT_EQ(model.points[1].error_px, 0.75);
  ASSERT_EQ(model.points[1].sights.size(), 1U);
  EXPECT_EQ(model.points[1].sights[0].feature, 2U);
}

TEST(ColmapModel, IsTheSameFromTextAndFromBytes) {
  for (const bool binary : {false, true}) {
    const test::ScratchFolder folder;
    const std::string end = binary ? ".bin" : ".txt";
    folder.Write("sparse/0/cameras" + end, binary ? CamerasBinary() : kCamerasText);
    folder.Write("sparse/0/images" + end, binary ? ImagesBinary() : kImagesText);
    folder.Write("sparse/0/points3D" + end, binary ? PointsBinary() : kPointsText);
    double done = 0.0;
    const auto model = ReadColmapModel(folder.path(), [&](double share) { done = share; });
    ASSERT_TRUE(model.ok()) << model.error().message;
    ExpectTheScene(*model);
    EXPECT_EQ(done, 1.0);
  }
}

TEST(ColmapModel, NamesTheFileAndTheLineOfAFault) {
  const auto fault = [](const std::string& text) {
    const auto images = ParseColmapImagesText("images.txt", text);
    return images.ok() ? std::string("none") : images.error().message;
  };
  EXPECT_EQ(fault(kImagesText), "none");
  EXPECT_THAT(fault("# x\n1 1 0 0 0 0 0 zero 1 a.jpg\n"), HasSubstr("images.txt:2: T 'zero'"));
  EXPECT_THAT(fault("1 0 0 0 0 0 0 0 1 a.jpg\n"), HasSubstr("no quaternion"));
  EXPECT_THAT(fault("1 1 0 0 0 0 0 0 1\n"), HasSubstr("NAME is missing"));
  EXPECT_THAT(fault("1 1 0 0 0 0 0 0 1 a.jpg\n1 2\n"), HasSubstr("images.txt:2: POINTS2D POINT3D"));
  EXPECT_THAT(fault("1 nan 0 0 0 0 0 0 1 a.jpg\n"), HasSubstr("QW is out of range"));
  const auto cameras = ParseColmapCamerasText("cameras.txt", "1 PINHOLE 640 480 500 500 320\n");
  ASSERT_FALSE(cameras.ok());
  EXPECT_THAT(cameras.error().message, HasSubstr("cameras.txt:1: PARAMS is missing"));
  const auto unknown = ParseColmapCamerasText("cameras.txt", "1 MAGIC 640 480 500\n");
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().message, HasSubstr("'MAGIC' is not known"));
}

TEST(ColmapModel, BelievesNoCountThatTheFileCannotHold) {
  std::string bytes = ImagesBinary();
  bytes[0] = bytes[1] = bytes[2] = bytes[6] = '\x7F';
  const auto images = ParseColmapImagesBinary("images.bin", bytes);
  ASSERT_FALSE(images.ok());
  EXPECT_THAT(images.error().message, HasSubstr("more than the file holds"));
}

TEST(ColmapModel, FailsAtEveryLengthItIsCutTo) {
  const std::string cameras = CamerasBinary();
  const std::string images = ImagesBinary();
  const std::string points = PointsBinary();
  for (std::size_t n = 0; n < cameras.size(); ++n) {
    EXPECT_FALSE(ParseColmapCamerasBinary("c", std::string_view(cameras).substr(0, n)).ok()) << n;
  }
  for (std::size_t n = 0; n < images.size(); ++n) {
    EXPECT_FALSE(ParseColmapImagesBinary("i", std::string_view(images).substr(0, n)).ok()) << n;
  }
  for (std::size_t n = 0; n < points.size(); ++n) {
    EXPECT_FALSE(ParseColmapPointsBinary("p", std::string_view(points).substr(0, n)).ok()) << n;
  }
  EXPECT_FALSE(ParseColmapPointsBinary("p", points + "x").ok());
}

TEST(ColmapModel, HoldsTogetherOrIsRefused) {
  const auto join = [](const char* cameras, const char* images, const char* points) {
    const auto model =
        JoinColmapModel(*ParseColmapCamerasText("c", cameras), *ParseColmapImagesText("i", images),
                        *ParseColmapPointsText("p", points));
    return model.ok() ? std::string("none") : model.error().message;
  };
  EXPECT_EQ(join(kCamerasText, kImagesText, kPointsText), "none");
  EXPECT_THAT(join("", kImagesText, ""), HasSubstr("camera 7, which is missing"));
  EXPECT_THAT(join(kCamerasText, "", kPointsText), HasSubstr("feature 0 of image 2"));
  EXPECT_THAT(join(kCamerasText, kImagesText, "5 1 2 3 0 0 0 1 2 3\n"), HasSubstr("feature 3"));
  EXPECT_THAT(join(kCamerasText, kImagesText, "5 1 2 3 0 0 0 1\n5 1 2 3 0 0 0 1\n"),
              HasSubstr("point 5 is there twice"));
}

TEST(ColmapModel, SaysWhatAFolderLacks) {
  const test::ScratchFolder folder;
  const auto none = ReadColmapModel(folder.path(), [](double) {});
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, HasSubstr("neither cameras.bin nor cameras.txt"));
  folder.Write("cameras.txt", kCamerasText);
  const auto cameras_only = ReadColmapModel(folder.path(), [](double) {});
  ASSERT_FALSE(cameras_only.ok());
  EXPECT_THAT(cameras_only.error().message, HasSubstr("images.txt"));
}

}  // namespace
}  // namespace lodemark
