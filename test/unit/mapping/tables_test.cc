#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/units.h"
#include "test/unit/mapping/scratch_folder.h"
#include "tools/mapping/landmark_table.h"
#include "tools/mapping/map_frame.h"
#include "tools/mapping/poses_table.h"
#include "tools/mapping/survey_table.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

TEST(LandmarkTable, ReadsPlacesInEveryForm) {
  const test::ScratchFolder folder;
  const Geodetic place{34.4 * kRadiansPerDegree, -119.88 * kRadiansPerDegree, 12.5};
  const Eigen::Vector3d in_ecef = EcefFromGeodetic(place);
  const auto grid = GridByName("11N");
  const Eigen::Vector3d in_grid = GridFromGeodetic(*grid, place);
  char row[200];
  const auto read = [&](const std::string& header, const std::string& values,
                        const PlaceOptions& options) {
    const std::string path =
        folder.Write("landmarks.csv", "landmark_id," + header + "\n7," + values + "\n");
    return ReadLandmarkTable(path, options);
  };
  const auto geodetic = read("h_ell_m,lat_deg,lon_deg", "12.5,34.4,-119.88", {});
  ASSERT_TRUE(geodetic.ok()) << geodetic.error().message;
  EXPECT_LT((geodetic->front().place.point_m - in_ecef).norm(), 1e-6);
  std::snprintf(row, sizeof row, "%.6f,%.6f,%.6f", in_ecef.x(), in_ecef.y(), in_ecef.z());
  const auto ecef = read("ecef_x_m,ecef_y_m,ecef_z_m", row, {});
  ASSERT_TRUE(ecef.ok());
  EXPECT_LT((ecef->front().place.point_m - in_ecef).norm(), 1e-5);
  std::snprintf(row, sizeof row, "%.6f,%.6f,12.5,0.1,0.3", in_grid.x(), in_grid.y());
  const std::string projected = "easting_m,northing_m,height_m,sigma_horizontal_m,sigma_up_m";
  PlaceOptions with_grid;
  with_grid.grid = grid;
  const auto in_utm = read(projected, row, with_grid);
  ASSERT_TRUE(in_utm.ok());
  EXPECT_LT((in_utm->front().place.point_m - in_ecef).norm(), 1e-5);
  EXPECT_EQ(in_utm->front().place.sigma_enu_m, Eigen::Vector3d(0.1, 0.1, 0.3));
  const auto no_grid = read(projected, row, {});
  ASSERT_FALSE(no_grid.ok());
  EXPECT_THAT(no_grid.error().message, HasSubstr("--grid"));
  const auto local = read("east_m,north_m,up_m,sigma_m", "1,2,3,0.5", {});
  ASSERT_TRUE(local.ok());
  EXPECT_TRUE(local->front().place.is_local);
  EXPECT_EQ(local->front().place.sigma_enu_m, Eigen::Vector3d(0.5, 0.5, 0.5));
  const auto nothing = read("colour", "red", {});
  ASSERT_FALSE(nothing.ok());
  EXPECT_THAT(nothing.error().message, HasSubstr("lacks a place"));
}

TEST(LandmarkTable, NamesLineAndColumnOfAFault) {
  const test::ScratchFolder folder;
  const auto fault = [&](const std::string& rows) {
    const std::string path = folder.Write("t.csv", "landmark_id,lat_deg,lon_deg,h_ell_m\n" + rows);
    const auto table = ReadLandmarkTable(path, {});
    return table.ok() ? std::string("none") : table.error().message.substr(folder.path().size());
  };
  EXPECT_EQ(fault("1,10,20,30\n"), "none");
  EXPECT_THAT(fault("1,10,20,30\n2,95,20,30\n"), HasSubstr("/t.csv:3:3: latitude_deg '95'"));
  EXPECT_THAT(fault("1,10,20,30\n# note\n2,10,,30\n"), HasSubstr("t.csv:4:6: longitude_deg"));
  EXPECT_THAT(fault("1,10,20\n"), HasSubstr("3 of 4 columns"));
  EXPECT_THAT(fault("-1,10,20,30\n"), HasSubstr("landmark_id '-1'"));
  EXPECT_THAT(fault("1,10,20,30\n1,11,20,30\n"), HasSubstr("landmark 1 is there twice"));
  EXPECT_THAT(fault(""), HasSubstr("holds no landmark"));
}

TEST(LandmarkDescriptors, MustBelongToLandmarksAndBeWhole) {
  const test::ScratchFolder folder;
  std::vector<TableLandmark> landmarks(2);
  landmarks[0].id = 3;
  landmarks[1].id = 9;
  const auto read = [&](const std::string& ids, std::size_t bytes) {
    return ReadLandmarkDescriptors(folder.Write("d.bin", std::string(bytes, 'x')),
                                   folder.Write("i.bin", ids), DescriptorKind::kOrb, landmarks);
  };
  const std::string good("\x09\0\0\0\x03\0\0\0", 8);
  const auto read_well = read(good, 64);
  ASSERT_TRUE(read_well.ok()) << read_well.error().message;
  EXPECT_THAT(read_well->landmark_ids, testing::ElementsAre(9U, 3U));
  const auto stranger = read(std::string("\x04\0\0\0", 4), 32);
  ASSERT_FALSE(stranger.ok());
  EXPECT_THAT(stranger.error().message, HasSubstr("belongs to landmark 4"));
  EXPECT_FALSE(read(good, 63).ok());
  EXPECT_FALSE(read(good.substr(1), 64).ok());
}

TEST(PosesTable, ChecksThatTheCentreAgrees) {
  const std::string header = "name,qw,qx,qy,qz,tx,ty,tz,cx,cy,cz\n";
  const test::ScratchFolder folder;
  const auto fault = [&](const std::string& row) {
    const auto poses = ReadPosesTable(folder.Write("poses.csv", header + row + "\n"));
    return poses.ok() ? std::string("none") : poses.error().message;
  };
  EXPECT_EQ(fault("a.jpg,0.70710678,0,0.70710678,0,1,2,3,3,-2,-1"), "none");
  EXPECT_THAT(fault("a.jpg,0.70710678,0,0.70710678,0,1,2,3,1,2,3"), HasSubstr("world to camera?"));
  EXPECT_THAT(fault("a.jpg,0.7,0,0,0,1,2,3,1,2,3"), HasSubstr("no unit quaternion"));
  EXPECT_THAT(fault("a.jpg,1,0,0,0,0,0,0,0,0,0\na.jpg,1,0,0,0,0,0,0,0,0,0"), HasSubstr("twice"));
}

TEST(SurveyTable, ReadsPointsAndMarksFromOneFile) {
  const test::ScratchFolder folder;
  const std::string path = folder.Write("gcp.csv",
                                        "point,image,x_px,y_px,east_m,north_m,up_m\n"
                                        "gate,a.jpg,10.5,20,1,2,3\n"
                                        "gate,b.jpg,11,21,1,2,3\n"
                                        "door,a.jpg,5,6,4,5,6\n");
  const auto points = ReadSurveyTable(path, {});
  ASSERT_TRUE(points.ok()) << points.error().message;
  ASSERT_EQ(points->size(), 2U);
  EXPECT_EQ((*points)[1].name, "door");
  const auto marks = ReadImageMarks(path);
  ASSERT_TRUE(marks.ok());
  ASSERT_EQ(marks->size(), 3U);
  EXPECT_EQ((*marks)[1].image, "b.jpg");
  EXPECT_EQ((*marks)[0].x_px, 10.5);
  folder.Write("gcp.csv", "point,east_m,north_m,up_m\ngate,1,2,3\ngate,1,2,4\n");
  const auto twice = ReadSurveyTable(path, {});
  ASSERT_FALSE(twice.ok());
  EXPECT_THAT(twice.error().message, HasSubstr("at different places"));
}

TEST(MapFrame, IsWhereItIsToldOrInTheMiddleOfThePlaces) {
  const Geodetic origin{0.5, 1.0, 100.0};
  const EnuFrame frame(origin);
  std::vector<TablePlace> places(2);
  places[0].point_m = frame.ToEcef({10.0, 0.0, 0.0});
  places[1].point_m = frame.ToEcef({-10.0, 0.0, 0.0});
  const auto middle = MapFrame::Choose({}, places);
  ASSERT_TRUE(middle.ok());
  EXPECT_LT((middle->InEnu(places[0]) - Eigen::Vector3d(10.0, 0.0, 0.0)).norm(), 1e-3);
  FrameOptions told;
  told.origin = origin;
  EXPECT_LT((MapFrame::Choose(told, places)->InEnu(places[1]) - Eigen::Vector3d(-10, 0, 0)).norm(),
            1e-8);
  places[0].is_local = places[1].is_local = true;
  EXPECT_FALSE(MapFrame::Choose({}, places).ok());
  FrameOptions local;
  local.local = true;
  EXPECT_TRUE(MapFrame::Choose(local, places).ok());
  EXPECT_TRUE(ParseGeodetic("48.5, 8.25,-3").has_value());
  for (const char* const text : {"", "1,2", "1,2,3,4", "91,0,0", "a,b,c", "1,2,nan"}) {
    EXPECT_FALSE(ParseGeodetic(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace lodemark
