// Every GnssLogger text among the recordings, against rows counted by a simpler reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "core/logs/gnss_logger.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

// Rows per leading word that have as many commas as the last header line of their kind.
std::map<std::string, std::int64_t> CompleteRows(const std::string& path) {
  std::map<std::string, std::ptrdiff_t> commas_of;
  std::map<std::string, std::int64_t> rows;
  Result<LineReader> lines = LineReader::Open(path);
  EXPECT_TRUE(lines.ok());
  std::string_view line;
  while (lines.ok() && lines->Next(&line)) {
    const std::ptrdiff_t commas = std::count(line.begin(), line.end(), ',');
    const bool header = line.starts_with("# ");
    const std::string_view text = header ? line.substr(2) : line;
    const std::string word(text.substr(0, text.find(',')));
    if (word.empty()) continue;
    if (header) {
      commas_of[word] = commas;
    } else if (word == "Nav" || (commas_of.contains(word) && commas == commas_of[word])) {
      ++rows[word];
    }
  }
  return rows;
}

class RecordedGnssLogger : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedGnssLogger, LosesNoValidRow) {
  LODEMARK_NEEDS_RECORDING(GetParam());
  const std::string path = test::RecordingPath(GetParam());
  std::map<std::string, std::int64_t> expected = CompleteRows(path);
  ASSERT_GT(expected["Raw"], 0);

  Result<GnssLoggerReader> reader = GnssLoggerReader::Open(path);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  std::map<std::string, std::int64_t> taken;
  std::int64_t last_time_ns = -1;
  GnssLoggerRecord record;
  while (reader->Next(&record)) {
    if (const auto* epoch = std::get_if<AndroidEpoch>(&record)) {
      taken["Raw"] += static_cast<std::int64_t>(epoch->measurements.size());
      EXPECT_GT(epoch->clock.time_ns, last_time_ns);
      EXPECT_TRUE(epoch->clock.Has(kClockHasFullBias));
      last_time_ns = epoch->clock.time_ns;
    }
    if (std::holds_alternative<LoggedFix>(record)) ++taken["Fix"];
    if (std::holds_alternative<LoggedStatus>(record)) ++taken["Status"];
    if (std::holds_alternative<LoggedNavigationMessage>(record)) ++taken["Nav"];
    if (std::holds_alternative<LoggedAgc>(record)) ++taken["Agc"];
    if (std::holds_alternative<LoggedSensor>(record)) ++taken["sensors"];
  }
  EXPECT_TRUE(reader->status().ok());
  EXPECT_EQ(reader->report().rows_skipped, 0);
  for (const char* word : {"Raw", "Fix", "Status", "Nav", "Agc"}) {
    EXPECT_EQ(taken[word], expected[word]) << word;
    expected.erase(word);
  }
  std::int64_t sensors = 0;
  for (const auto& [word, count] : expected) sensors += count;
  EXPECT_EQ(taken["sensors"], sensors);
}

INSTANTIATE_TEST_SUITE_P(
    Recorded, RecordedGnssLogger,
    ::testing::Values("gnss/android_norway_20161205/gnss_android_raw_data.txt",
                      "gnss/google_demo_20160822/pseudoranges_log_2016_08_22_14_45_50.txt.gz",
                      "gnss/pixel4_mtv_20200514/Pixel4_GnssLog.txt",
                      "gnss/pixel5_format_20211207/gnss_log.txt",
                      "gnss/pixel7_stanford_20231107/pixel6.txt.gz",
                      "gnss/pixel7pro_castrovalley_20230907/gnss_log.txt",
                      "gnss/s8_perth_20171005/SensorLog20171005.txt.gz"));

}  // namespace
}  // namespace lodemark
