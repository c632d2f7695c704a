#include "tools/lodemark/report_landmarks.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/units.h"
#include "tools/report/scene_data.h"

namespace lodemark {
namespace {

constexpr std::int64_t kStart_ns = 1'400'000'000'000'000'000;
constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

RunLandmark Row(double time_s, std::int64_t id, bool used, std::string_view reason) {
  RunLandmark row;
  row.time_gps_ns = kStart_ns + static_cast<std::int64_t>(1e9 * time_s);
  row.landmark_id = id;
  row.used = used;
  row.reason = reason;
  row.x_px = 100.0 * static_cast<double>(id);
  row.residual_x_px = 3.0;
  row.residual_y_px = 4.0;
  row.latitude_deg = 30.0;
  row.longitude_deg = 114.0;
  row.height_m = 20.0;
  return row;
}

std::vector<std::int64_t> PhotosAt(std::initializer_list<double> times_s) {
  std::vector<std::int64_t> times_ns;
  for (const double time_s : times_s) {
    times_ns.push_back(kStart_ns + static_cast<std::int64_t>(1e9 * time_s));
  }
  return times_ns;
}

struct Drawn {
  ReportScene scene;
  std::vector<ReportRun> runs;
};

Drawn Draw(RunLandmarks landmarks) {
  landmarks.Finish();
  Drawn drawn;
  drawn.runs.resize(1);
  ReportLandmarks joined;
  joined.Add(landmarks);
  joined.Finish(EnuFrame({30.0 * kRadiansPerDegree, 114.0 * kRadiansPerDegree, 0.0}), &drawn.scene,
                &drawn.runs);
  return drawn;
}

TEST(ReportLandmarks, GivesAPhotographTheEstimateNearestToIt) {
  RunLandmarks landmarks(PhotosAt({2.0, 10.0}));
  landmarks.Add(Row(1.5, 1, false, "outlier"));
  landmarks.Add(Row(2.1, 1, true, "used"));
  landmarks.Add(Row(2.1, 2, true, "down_weighted"));
  landmarks.Add(Row(3.0, 1, false, "outlier"));
  landmarks.Add(Row(6.0, 7, true, "used"));
  const Drawn drawn = Draw(std::move(landmarks));
  ASSERT_EQ(drawn.runs[0].sights.size(), 1u);
  const ReportSights& sights = drawn.runs[0].sights[0];
  EXPECT_EQ(sights.photo, 0u);
  EXPECT_EQ(sights.counts, (std::array<std::int64_t, 5>{0, 0, 1, 1, 0}));
  ASSERT_EQ(sights.sights.size(), 2u);
  EXPECT_EQ(sights.sights[1].x_px, 200.0);
  EXPECT_DOUBLE_EQ(*sights.median_px, 5.0);
}

TEST(ReportLandmarks, KnowsWhatMostlyBecameOfALandmarkAndWhereItIs) {
  RunLandmarks landmarks({});
  landmarks.Add(Row(1.0, 4, true, "used"));
  landmarks.Add(Row(2.0, 4, false, "outlier"));
  landmarks.Add(Row(3.0, 4, false, "outlier"));
  landmarks.Add(Row(1.0, 9, false, "photo_not_used"));
  const Drawn drawn = Draw(std::move(landmarks));
  ASSERT_EQ(drawn.scene.landmarks.size(), 2u);
  EXPECT_NEAR(drawn.scene.landmarks[0][2], 20.0, 1e-6);
  EXPECT_EQ(drawn.runs[0].landmarks[0], ReportSignalState::kRejected);
  EXPECT_EQ(drawn.runs[0].landmarks[1], ReportSignalState::kUnusable);
  EXPECT_TRUE(drawn.runs[0].sights.empty());
}

TEST(ReportLandmarks, LeavesALandmarkWithoutAPlaceOffTheMapOnly) {
  RunLandmarks landmarks(PhotosAt({2.0}));
  for (const std::optional<double> latitude_deg : {std::optional<double>(), {kNowhere}, {1e9}}) {
    RunLandmark row = Row(2.0, 5, true, "used");
    row.latitude_deg = latitude_deg;
    row.residual_x_px = std::nullopt;
    landmarks.Add(row);
  }
  const Drawn drawn = Draw(std::move(landmarks));
  EXPECT_TRUE(drawn.scene.landmarks.empty());
  ASSERT_EQ(drawn.runs[0].sights.size(), 1u);
  EXPECT_EQ(drawn.runs[0].sights[0].sights.size(), 3u);
  EXPECT_FALSE(drawn.runs[0].sights[0].median_px.has_value());
}

TEST(ReportLandmarks, StaysSmallWhateverTheFileHolds) {
  RunLandmarks landmarks(PhotosAt({2.0}));
  for (std::int64_t id = 0; id < 20'000; ++id) landmarks.Add(Row(2.0, id, true, "used"));
  const Drawn drawn = Draw(std::move(landmarks));
  EXPECT_LE(drawn.scene.landmarks.size(), 6000u);
  EXPECT_LE(drawn.runs[0].sights[0].sights.size(), 600u);
}

// The vectors of RFC 4648 section 10.
TEST(Base64, AgreesWithTheStandard) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace lodemark
