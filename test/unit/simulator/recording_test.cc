#include "tools/simulator/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/logs/gnss_logger.h"
#include "core/logs/rinex_navigation.h"

namespace lodemark {
namespace {

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

}  // namespace
}  // namespace lodemark
