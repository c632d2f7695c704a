#include "core/logs/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/logs/recording_manifest.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RecordingFolder : public ::testing::Test {
 protected:
  RecordingFolder() {
    std::string name = (fs::temp_directory_path() / "recording_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  ~RecordingFolder() override { fs::remove_all(folder_); }

  std::string Write(const std::string& name, std::string_view text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  std::string ErrorOfManifest(std::string_view manifest) {
    Write("manifest.json", manifest);
    const auto recording = OpenRecording(folder_.string());
    return recording.ok() ? "none" : recording.error().message;
  }

  fs::path folder_;
};

std::string RinexHeader(std::string_view type) {
  std::string line = "     3.04           " + std::string(type);
  line.resize(60, ' ');
  return line + "RINEX VERSION / TYPE\n";
}

TEST_F(RecordingFolder, FollowsItsManifest) {
  const std::string log = Write("log.txt", "# Raw,\n");
  const std::string gps = Write("nav/gps.23n", "x");
  const std::string glonass = Write("glonass.23g", "x");
  Write("manifest.json",
        R"({"name": "walk_1", "device": "Some Phone", "base_ecef_m": [4157177.5, 671230, 4774767],
            "files": {"gnss_log": "log.txt", "navigation": ["nav/gps.23n", "glonass.23g"]},
            "columns": {"imu": "time_s,accel_x_g", "odometry": 5}})");
  auto recording = OpenRecording(folder_.string());
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_TRUE(recording->has_manifest);
  EXPECT_EQ(recording->name, "walk_1");
  EXPECT_EQ(recording->device, "Some Phone");
  EXPECT_EQ(recording->File("gnss_log"), log);
  EXPECT_THAT(recording->Files("navigation"), ElementsAre(gps, glonass));
  EXPECT_THAT(recording->Files("truth"), IsEmpty());
  EXPECT_EQ(recording->File("truth"), std::nullopt);
  EXPECT_EQ(recording->base_in_ecef, Eigen::Vector3d(4157177.5, 671230.0, 4774767.0));
  EXPECT_EQ(recording->static_in_ecef, std::nullopt);
  EXPECT_THAT(recording->problems, IsEmpty());
  EXPECT_EQ(recording->columns.size(), 1U);
  EXPECT_EQ(recording->columns["imu"], "time_s,accel_x_g");
}

TEST_F(RecordingFolder, ReadsNothingOutsideAndNothingThatIsNotThere) {
  Write("log.txt", "# Raw,\n");
  fs::create_directories(folder_ / "images");
  Write("manifest.json",
        R"({"files": {"gnss_log": "log.txt", "a": "/etc/passwd", "b": "../x", "c": "images/../../x",
            "d": "gone.txt", "e": "images", "f": 7, "g": ["log.txt", null], "h": "..\\x",
            "i": "a\u0000b", "j": ""}, "static_ecef_m": [1, 2, "3"]})");
  const auto recording = OpenRecording(folder_.string());
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->files.size(), 2u);  // gnss_log and g
  EXPECT_EQ(recording->problems.size(), 10u);
  EXPECT_THAT(recording->problems[0], HasSubstr("manifest.json: files: a names '/etc/passwd'"));
  EXPECT_EQ(recording->static_in_ecef, std::nullopt);
  EXPECT_EQ(recording->name, folder_.filename());
}

TEST_F(RecordingFolder, RefusesHostileManifestsWithOneSentence) {
  EXPECT_THAT(ErrorOfManifest("{\"files\": "), HasSubstr("manifest.json: is not a JSON object"));
  EXPECT_THAT(ErrorOfManifest("[1, 2]"), HasSubstr("is not a JSON object"));
  EXPECT_THAT(ErrorOfManifest("{}"), HasSubstr("has no \"files\""));
  EXPECT_THAT(ErrorOfManifest("{\"files\": 3}"), HasSubstr("has no \"files\""));
  EXPECT_THAT(ErrorOfManifest("{\"files\": {}}"), HasSubstr("no file of a known kind"));
  EXPECT_THAT(ErrorOfManifest(std::string(500'000, '[')), HasSubstr("nested too deeply"));
  EXPECT_THAT(ErrorOfManifest(std::string(2'000'000, ' ')), HasSubstr("is larger than"));
  EXPECT_THAT(ErrorOfManifest("{\"files\": \"\xFF\"}"), HasSubstr("is not a JSON object"));
  EXPECT_THAT(ErrorOfManifest(""), HasSubstr("is empty"));
}

TEST_F(RecordingFolder, WithoutManifestIsSortedOutByContent) {
  const std::string log = Write("a.txt", "#\n# Header Description:\n#\n");
  const std::string headless =
      Write("b.txt", "Raw,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22\n");
  const std::string observation = Write("c.obs", RinexHeader("OBSERVATION DATA"));
  std::string crinex = "1.0                 COMPACT RINEX FORMAT";
  crinex.resize(60, ' ');
  const std::string compact = Write("d.crx", crinex + "CRINEX VERS   / TYPE\n");
  const std::string navigation = Write("e.nav", RinexHeader("N: GNSS NAV DATA"));
  const std::string old_navigation = Write("f.16g", RinexHeader("GLONASS NAV DATA"));
  const std::string orbits = Write("g.sp3", "#dP2021  4 28  0  0  0.00000000     288 ORBIT\n");
  const std::string device = Write("h.csv", "MessageType,TimeNanos,Svid,RawPseudorangeMeters\n");
  const std::string derived = Write("i.csv", "collectionName,millisSinceGpsEpoch,rawPrM\n");
  const std::string truth = Write("truth.csv", "time_gps_ns,latitude_deg,longitude_deg\n");
  const std::string run = Write("trajectory.csv", "time_gps_ns,latitude_deg,longitude_deg\n");
  const std::string imu = Write("j.csv",
                                "#timestamp [ns],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],"
                                "a_RS_S_z [m s^-2]\n");
  const std::string car = Write("k.csv", "time_gps_ns,speed_mps,yaw_rate_radps\n");
  Write("l.csv", "time_gps_ns,speed_mps\n");
  Write("notes.md", "Raw, uncut\n");
  Write("picture.jpg", std::string_view("\xFF\xD8\xFF\0\0\0", 6));
  Write("empty", "");
  Write("weather.met", RinexHeader("METEOROLOGICAL DATA"));

  const auto recording = OpenRecording(folder_.string() + "/");
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_FALSE(recording->has_manifest);
  EXPECT_EQ(recording->name, folder_.filename());
  EXPECT_THAT(recording->Files("gnss_log"), ElementsAre(log, headless));
  EXPECT_THAT(recording->Files("observation"), ElementsAre(observation, compact));
  EXPECT_THAT(recording->Files("navigation"), ElementsAre(navigation, old_navigation));
  EXPECT_THAT(recording->Files("precise_orbits"), ElementsAre(orbits));
  EXPECT_THAT(recording->Files("device_gnss"), ElementsAre(device));
  EXPECT_THAT(recording->Files("derived"), ElementsAre(derived));
  EXPECT_THAT(recording->Files("truth"), ElementsAre(truth));
  EXPECT_THAT(recording->Files("trajectory"), ElementsAre(run));
  EXPECT_THAT(recording->Files("imu"), ElementsAre(imu, car));
  EXPECT_EQ(recording->files.size(), 9u);
}

TEST_F(RecordingFolder, MustBeAFolderWithSomethingInIt) {
  const std::string file = Write("notes.md", "nothing\n");
  const auto not_folder = OpenRecording(file);
  ASSERT_FALSE(not_folder.ok());
  EXPECT_THAT(not_folder.error().message, HasSubstr("is not a folder"));
  const auto nothing = OpenRecording(folder_.string());
  ASSERT_FALSE(nothing.ok());
  EXPECT_THAT(nothing.error().message, HasSubstr("has no file of a known kind"));
  const auto missing = OpenRecording((folder_ / "gone").string());
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::kIo);
}

TEST(StaysInFolder, TakesPlainRelativeNamesOnly) {
  for (const char* name : {"a", "a/b", "a.b/c..d", "..a", "a.."}) EXPECT_TRUE(StaysInFolder(name));
  for (const char* name : {"", "/a", "..", "../a", "a/..", "a/../../b", "a\\b", "a\nb"}) {
    EXPECT_FALSE(StaysInFolder(name)) << name;
  }
}

}  // namespace
}  // namespace lodemark
