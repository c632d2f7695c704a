#include "tools/simulator/photo_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace lodemark {
namespace {

std::string Scene(const std::string& photos) {
  return R"({"duration_s": 20, "systems": "G", "waypoints_m": [[0, 0], [6, 0]], "scene": {
    "buildings": [{"footprint_m": [[-20, 30], [20, 30], [20, 40], [-20, 40]], "height_m": 14,
                   "facade": "shops"}]},
    "camera": {"model": "PINHOLE", "width_px": 96, "height_px": 72, "fx_px": 80, "fy_px": 80,
               "cx_px": 47.5, "cy_px": 35.5, "coefficients": [], "convention": "made up"},
    "days": [{"name": "june", "cloud": 0.4, "seed": 3}],
    "photos": [)" +
         photos + "]}";
}

constexpr char kDatabase[] =
    R"({"folder": "database", "day": "june", "survey": true, "standpoints": [
        {"at_m": [-5, 0, 1.6], "headings_deg": [0, 10]}, {"at_m": [5, 0, 1.6]}]})";
constexpr char kFrames[] =
    R"({"folder": "cam0", "day": "june", "people": 3, "frames": [
        {"first_s": 1, "every_s": 2, "headings_deg": [5, 350]}]})";

RecordingFiles FilesOf(const std::string& text) {
  const Result<Scenario> scenario = ScenarioFromJson("s.json", text);
  EXPECT_TRUE(scenario.ok()) << scenario.error().message;
  Result<RecordingFiles> files = MakePhotos(*scenario, {});
  EXPECT_TRUE(files.ok()) << files.error().message;
  return std::move(files).value();
}

TEST(MakePhotos, GivesTheSameBytesForTheSameSeedOnly) {
  const std::string text = Scene(kFrames);
  const RecordingFiles files = FilesOf(text);
  EXPECT_EQ(files, FilesOf(text));
  std::string other = text;
  other.replace(other.find("\"duration_s\""), 0, "\"seed\": 2, ");
  EXPECT_NE(files.at("cam0/0001.jpg"), FilesOf(other).at("cam0/0001.jpg"));
}

TEST(MakePhotos, MakesWhatTheMapBuilderReads) {
  const RecordingFiles files = FilesOf(Scene(std::string(kDatabase) + "," + kFrames));
  for (const char* name :
       {"database/0001.jpg", "database/0003.jpg", "database/camera.json", "database/poses.csv",
        "database/survey.csv", "database/marks.csv", "cam0/0002.jpg", "cam0/data.csv"}) {
    EXPECT_TRUE(files.contains(name)) << name;
  }
  EXPECT_EQ(files.at("cam0/data.csv"),
            "time_gps_ns,filename\n1399860001000000000,0001.jpg\n1399860003000000000,0002.jpg\n");
  const std::string& poses = files.at("database/poses.csv");
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 4);
}

TEST(MakePhotos, MakesNoneOfAScenarioWithoutPhotos) {
  const auto scenario = ScenarioFromJson("s.json", "{}");
  const auto files = MakePhotos(*scenario, {});
  ASSERT_TRUE(files.ok());
  EXPECT_TRUE(files->empty());
}

struct Wrong {
  const char* from;
  const char* to;
  const char* message;
};

TEST(ScenarioFromJson, NamesWhatIsWrongWithItsPhotos) {
  const Wrong wrongs[] = {
      {"[-20, 30]", "[-20]", "scene.buildings[0].footprint_m has to be a list of 3 to 64"},
      {"[20, 40], [-20, 40]", "[-20, 40], [20, 40]", "footprint_m must not cross itself"},
      {"[20, 40], [-20, 40]", "[-20, 30.01]", "edges of 0.2 to 500 m"},
      {"\"shops\"", "\"velvet\"", "facade has to be brick"},
      {"\"camera\": {", "\"camera\": {\"x\": ", "is not JSON"},
      {"\"width_px\": 96", "\"width_px\": 0", "s.json: camera"},
      {"\"day\": \"june\"", "\"day\": \"may\"", "photos[0].day is not among the days"},
      {"\"cloud\": 0.4", "\"cloud\": 4", "days[0].cloud has to lie between 0 and 1"},
      {"\"cam0\"", "\"../x\"", "folder has to be a name"},
      {"\"frames\"", "\"films\"", "photos[0].standpoints or frames have to be given"},
      {"\"people\"", "\"poeple\"", "photos[0].poeple is not a field"},
      {"\"headings_deg\": [5, 350]", "\"headings_deg\": [5, \"a\"]", "headings_deg has to be"},
  };
  for (const Wrong& wrong : wrongs) {
    std::string text = Scene(kFrames);
    const std::size_t at = text.find(wrong.from);
    ASSERT_NE(at, std::string::npos) << wrong.from;
    text.replace(at, std::string(wrong.from).size(), wrong.to);
    const auto scenario = ScenarioFromJson("s.json", text);
    ASSERT_FALSE(scenario.ok()) << wrong.to;
    EXPECT_NE(scenario.error().message.find(wrong.message), std::string::npos)
        << scenario.error().message;
  }
}

}  // namespace
}  // namespace lodemark
