// Every manifest and every truth among the recordings.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/logs/recording.h"
#include "core/logs/trajectory.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> AllFolders() {
  std::vector<std::string> folders;
  for (const char* group : {"gnss", "drive"}) {
    for (const auto& entry : fs::directory_iterator(test::RecordingPath(group))) {
      if (fs::exists(entry.path() / "manifest.json")) folders.push_back(entry.path().string());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

TEST(RecordedRecordings, OpenWithEveryFileOfTheirManifests) {
  LODEMARK_NEEDS_RECORDING("gnss");
  for (const std::string& folder : AllFolders()) {
    const auto recording = OpenRecording(folder);
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->name, fs::path(folder).filename().string());
    EXPECT_FALSE(recording->device.empty());
    for (const std::string& problem : recording->problems) ADD_FAILURE() << problem;
  }
}

TEST(RecordedRecordings, HaveFilesOfTheKindTheirRoleSays) {
  LODEMARK_NEEDS_RECORDING("gnss");
  int sniffed = 0;
  for (const std::string& folder : AllFolders()) {
    const auto recording = OpenRecording(folder);
    ASSERT_TRUE(recording.ok());
    for (const char* role :
         {"gnss_log", "observation", "navigation", "precise_orbits", "device_gnss", "derived"}) {
      for (const std::string& file : recording->Files(role)) {
        const auto kind = SniffFile(file);
        ASSERT_TRUE(kind.ok());
        EXPECT_EQ(RoleOf(*kind), role) << file;
        ++sniffed;
      }
    }
  }
  EXPECT_GT(sniffed, 30);
}

TEST(RecordedRecordings, HaveTruthsWithoutABadRow) {
  LODEMARK_NEEDS_RECORDING("gnss");
  int truths = 0;
  for (const std::string& folder : AllFolders()) {
    const auto recording = OpenRecording(folder);
    ASSERT_TRUE(recording.ok());
    for (const std::string& file : recording->Files("truth")) {
      ReadReport report;
      const auto track = ReadTrajectory(file, &report);
      ASSERT_TRUE(track.ok()) << track.error().message;
      EXPECT_EQ(report.rows_skipped + report.values_dropped, 0) << file;
      EXPECT_EQ(static_cast<std::int64_t>(track->points().size()), report.rows_read) << file;
      ++truths;
    }
  }
  EXPECT_GE(truths, 15);
}

}  // namespace
}  // namespace lodemark
