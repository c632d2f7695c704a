#include "tools/simulator/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "core/logs/gnss_logger.h"
#include "core/logs/rinex_navigation.h"
#include "tools/simulator/simulator.h"

namespace lodemark {
namespace {

std::string TextOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Scenario ShortScenario(const char* preset) {
  Scenario scenario = *PresetScenario(preset);
  scenario.epochs = 10;
  return scenario;
}

TEST(MakeRecording, IsTheSameForTheSameSeedOnly) {
  const RecordingFiles first = MakeRecording(ShortScenario("walk"), {});
  EXPECT_EQ(first, MakeRecording(ShortScenario("walk"), {}));
  Scenario other = ShortScenario("walk");
  ++other.seed;
  EXPECT_NE(first.at("gnss_log.txt"), MakeRecording(other, {}).at("gnss_log.txt"));
}

TEST(MakeRecording, IsReadWithoutALostRow) {
  const RecordingFiles files = MakeRecording(ShortScenario("static"), {});
  auto reader =
      GnssLoggerReader::FromLines(LineReader::FromMemory("log", files.at("gnss_log.txt")));
  ASSERT_TRUE(reader.ok());
  GnssLoggerRecord record;
  int epochs = 0;
  while (reader->Next(&record)) epochs += std::holds_alternative<AndroidEpoch>(record) ? 1 : 0;
  EXPECT_EQ(epochs, 10);
  EXPECT_EQ(reader->report().rows_skipped, 0);
  EXPECT_EQ(reader->report().rows_unknown, 0);

  LineReader lines = LineReader::FromMemory("nav", files.at("navigation.rnx"));
  ReadReport report;
  int sets = 0;
  ASSERT_TRUE(ReadRinexNavigation(
                  &lines,
                  [&](const NavigationRecord& one) {
                    sets += std::holds_alternative<KeplerEphemeris>(one) ||
                                    std::holds_alternative<StateEphemeris>(one)
                                ? 1
                                : 0;
                  },
                  &report)
                  .ok());
  EXPECT_EQ(report.rows_skipped, 0);
  EXPECT_GE(sets, 30 + 24 + 24 + 24);
}

TEST(MakeRecording, SaysThatItIsSimulated) {
  const RecordingFiles files = MakeRecording(ShortScenario("static"), {});
  EXPECT_EQ(nlohmann::json::parse(files.at("manifest.json"))["simulated"], true);
  EXPECT_NE(files.at("gnss_log.txt").find("# Simulated by lodemark"), std::string::npos);
}

TEST(MakeRecording, GivesOneRowOfTruthForAPlaceAtRest) {
  const std::string truth = MakeRecording(ShortScenario("static"), {}).at("truth.csv");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 2);
  EXPECT_NE(truth.find(",30.5287000000,114.3561000000,24.0000,"), std::string::npos);
}

TEST(ScenarioFromJson, TakesWhatIsGivenAndKeepsTheRest) {
  const auto scenario = ScenarioFromJson("s.json", R"({"name": "hill", "systems": "GE",
      "place": {"latitude_deg": 47.1, "height_m": 900}, "start_gps": "2025-01-02T03:04:05",
      "duration_s": 30, "interval_s": 0.5, "waypoints_m": [[0, 0], [10, 20]], "seed": 9})");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_EQ(scenario->name, "hill");
  EXPECT_EQ(scenario->epochs, 60);
  EXPECT_EQ(scenario->seed, 9u);
  EXPECT_EQ(scenario->waypoints_m.size(), 2u);
  EXPECT_NEAR(scenario->place.latitude_rad, 0.822050, 1e-6);
  EXPECT_EQ(scenario->place.longitude_rad, PresetScenario("static")->place.longitude_rad);
}

TEST(ScenarioFromJson, NamesWhatIsWrong) {
  const auto message = [](const char* text) {
    const auto scenario = ScenarioFromJson("s.json", text);
    return scenario.ok() ? std::string() : scenario.error().message;
  };
  EXPECT_EQ(message("{"), "s.json: is not JSON");
  EXPECT_EQ(message("[]"), "s.json: has to hold one JSON object");
  EXPECT_EQ(message(R"({"sped": 1})"), "s.json: sped is not a field of a scenario");
  EXPECT_EQ(message(R"({"place": {"latitude_deg": 95}})"),
            "s.json: place.latitude_deg has to lie between -89.9 and 89.9");
  EXPECT_NE(message(R"({"duration_s": "long"})"), "");
  EXPECT_NE(message(R"({"start_gps": "yesterday"})"), "");
  EXPECT_NE(message(R"({"systems": "GX"})"), "");
  EXPECT_NE(message(R"({"waypoints_m": [[0]]})"), "");
  EXPECT_NE(message(R"({"interval_s": 0.05, "duration_s": 86400})"), "");
}

TEST(ScenarioFromJson, LeadsNobodyThroughWalls) {
  const auto scenario = ScenarioFromJson("s.json", R"({
      "waypoints_m": [[0, 0], [60, 0]], "speed_mps": 2, "pause_s": 0, "phone_height_m": 1.5,
      "scene": {"buildings": [{"footprint_m": [[29, -5], [40, -5], [40, 5], [29, 5]]}]}})");
  ASSERT_FALSE(scenario.ok());
  // 29 m at 2 m/s, and some seconds to get going.
  const std::string& message = scenario.error().message;
  const std::string start = "s.json: waypoints_m leads into a building of the scene after ";
  ASSERT_EQ(message.substr(0, start.size()), start) << message;
  EXPECT_NEAR(std::stod(message.substr(start.size())), 16.0, 1.6);
}

// The recordings beside the scenarios are what these give.
TEST(SampleLogs, AreWhatTheirScenariosGive) {
  for (const std::string name : {"square", "street"}) {
    const std::string folder = LODEMARK_SAMPLE_LOGS;
    const std::string path = folder + "/scenarios/" + name + ".json";
    const auto scenario = ScenarioFromJson(path, TextOf(path));
    ASSERT_TRUE(scenario.ok()) << scenario.error().message;
    for (const auto& [file, text] : MakeRecording(*scenario, {})) {
      const std::string sample = TextOf(folder + "/" + name + "/" + file);
      EXPECT_EQ(sample.size(), text.size()) << name << "/" << file;
      EXPECT_TRUE(sample == text) << name << "/" << file;
    }
  }
}

// In the canyon two satellites are seen and others come off its walls; at its ends the sky is open.
TEST(SampleLogs, TheStreetHasTwoSatellitesForHalfAMinute) {
  const std::string path = std::string(LODEMARK_SAMPLE_LOGS) + "/scenarios/street.json";
  const auto scenario = ScenarioFromJson(path, TextOf(path));
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  Simulator simulator(*scenario);
  SimulatedEpoch epoch;
  int reflections = 0;
  std::vector<int> seen;
  while (simulator.Next(&epoch)) {
    int direct = 0;
    for (const SimulatedEpoch::Path& one : epoch.paths) {
      direct += one.paths.direct > 0.4 ? 1 : 0;
      reflections += one.paths.direct < 0.1 && one.paths.reflected > 0.1 ? 1 : 0;
    }
    seen.push_back(direct);
  }
  ASSERT_EQ(seen.size(), 60u);
  EXPECT_GE(seen.front(), 6);
  EXPECT_GE(seen.back(), 6);
  EXPECT_GE(std::count(seen.begin(), seen.end(), 2), 30);
  EXPECT_EQ(*std::min_element(seen.begin(), seen.end()), 2);
  EXPECT_GT(reflections, 40);
}

}  // namespace
}  // namespace lodemark
