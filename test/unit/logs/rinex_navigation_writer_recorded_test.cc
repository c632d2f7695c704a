// Recorded navigation files written anew: read back the same by us, and used to the same solution
// by RTKLIB.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_navigation_writer.h"
#include "test/recordings.h"
#include "test/unit/logs/navigation_record_text.h"

namespace lodemark {
namespace {

std::vector<NavigationRecord> ReadFile(const std::string& path) {
  std::vector<NavigationRecord> records;
  ReadReport report;
  EXPECT_TRUE(ReadRinexNavigation(
                  path, [&](const NavigationRecord& record) { records.push_back(record); }, &report)
                  .ok());
  return records;
}

std::vector<NavigationRecord> ReadText(const std::string& text) {
  std::vector<NavigationRecord> records;
  ReadReport report;
  LineReader lines = LineReader::FromMemory("written", text);
  EXPECT_TRUE(
      ReadRinexNavigation(
          &lines, [&](const NavigationRecord& record) { records.push_back(record); }, &report)
          .ok());
  EXPECT_EQ(report.rows_skipped, 0);
  return records;
}

class RecordedRinexNavigationWriter : public testing::TestWithParam<const char*> {};

TEST_P(RecordedRinexNavigationWriter, ReadsBackTheSame) {
  LODEMARK_NEEDS_RECORDING(GetParam());
  const std::vector<NavigationRecord> records = ReadFile(test::RecordingPath(GetParam()));
  const RinexNavigationFile file = WriteRinexNavigation(records, {});
  EXPECT_EQ(file.records_left_out, 0);
  const std::vector<NavigationRecord> back = ReadText(file.text);
  ASSERT_EQ(back.size(), records.size());
  std::vector<std::string> before;
  std::vector<std::string> after;
  for (std::size_t i = 0; i < records.size(); ++i) {
    before.push_back(test::RecordText(records[i]));
    after.push_back(test::RecordText(back[i]));
  }
  // The header's lines have an order of their own.
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(after[i], before[i]);
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedRinexNavigationWriter,
    testing::Values("drive/berlin_potsdamer_20160606/BRDC00WRD_U_20161580000_01D_MN.rnx.gz",
                    "drive/berlin_potsdamer_20160606/REDU00BEL_R_20161580000_01D_SN.rnx.gz",
                    "drive/berlin_potsdamer_20160606/brdc1580.16g.gz",
                    "drive/berlin_potsdamer_20160606/brdc1580.16n",
                    "drive/hk_tst_20190428/hksc1180.19b", "drive/hk_tst_20190428/hksc1180.19n",
                    "gnss/pixel5_mtv_20210428/hour1180.21n",
                    "gnss/rtk_geonet_20050402/07590920.05n", "gnss/rtk_nagoya_20240624/base.nav.gz",
                    "gnss/s8_perth_20171005/PERT00AUS_R_20172780000_01D_MN.rnx.gz",
                    "gnss/spirent_static_20230108/Spirent_RINEX_CN.23C",
                    "gnss/spirent_static_20230108/Spirent_RINEX_EN.23L",
                    "gnss/spirent_static_20230108/Spirent_RINEX_GN.23N",
                    "gnss/spirent_static_20230108/Spirent_RINEX_IN.23I",
                    "gnss/spirent_static_20230108/Spirent_RINEX_JN.23J",
                    "gnss/spirent_static_20230108/Spirent_RINEX_RN.23G"));

// Solution lines of RTKLIB's rnx2rtkp, without the header that names its input files.
std::string Solve(const std::string& systems, const std::string& observations,
                  const std::string& navigation) {
  const std::string command = "rnx2rtkp -p 0 -sys " + systems + " '" + observations + "' '" +
                              navigation + "' 2>/dev/null | grep -v '^%'";
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  char chunk[4096];
  while (const std::size_t got = std::fread(chunk, 1, sizeof chunk, pipe)) text.append(chunk, got);
  pclose(pipe);
  return text;
}

struct Session {
  const char* systems;
  const char* observations;
  const char* navigation;
};

// Of a case: its systems and recording, in letters, digits and underscores.
std::string Name(const Session& session) {
  std::string name = std::string(session.systems) + "_" + session.observations;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

class RecordedRtklib : public testing::TestWithParam<Session> {};

TEST_P(RecordedRtklib, SolvesTheSameFromTheWrittenFile) {
  const Session& session = GetParam();
  LODEMARK_NEEDS_RECORDING(session.observations);
  if (std::system("command -v rnx2rtkp >/dev/null 2>&1") != 0) GTEST_SKIP() << "no rnx2rtkp";
  const std::string observations = test::RecordingPath(session.observations);
  const std::string navigation = test::RecordingPath(session.navigation);

  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("lodemark_written_" + Name(session));
  std::filesystem::create_directories(folder);
  const std::string plain = (folder / "plain.nav").string();
  const std::string written = (folder / "written.nav").string();
  // RTKLIB unpacks beside the file, where we may not write.
  const std::string plain_observations = (folder / "plain.obs").string();
  ASSERT_EQ(std::system(("gzip -dcf '" + navigation + "' > '" + plain + "'").c_str()), 0);
  ASSERT_EQ(
      std::system(("gzip -dcf '" + observations + "' > '" + plain_observations + "'").c_str()), 0);
  std::ofstream(written) << WriteRinexNavigation(ReadFile(navigation), {}).text;

  const std::string expected = Solve(session.systems, plain_observations, plain);
  EXPECT_GT(expected.size(), 1000u);
  EXPECT_EQ(Solve(session.systems, plain_observations, written), expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedRtklib,
    testing::Values(Session{"G,R,E,J,C", "gnss/rtk_nagoya_20240624/base.obs.gz",
                            "gnss/rtk_nagoya_20240624/base.nav.gz"},
                    Session{"C", "gnss/rtk_nagoya_20240624/base.obs.gz",
                            "gnss/rtk_nagoya_20240624/base.nav.gz"},
                    Session{"R", "gnss/rtk_nagoya_20240624/base.obs.gz",
                            "gnss/rtk_nagoya_20240624/base.nav.gz"},
                    Session{"E", "gnss/rtk_nagoya_20240624/base.obs.gz",
                            "gnss/rtk_nagoya_20240624/base.nav.gz"},
                    Session{"G", "gnss/spirent_static_20230108/iono-klob_tropo-saastamoinen.obs.gz",
                            "gnss/spirent_static_20230108/Spirent_RINEX_GN.23N"},
                    Session{"G", "gnss/pixel5_mtv_20210428/Pixel5_GnssLog_first1000.21o.gz",
                            "gnss/pixel5_mtv_20210428/hour1180.21n"},
                    Session{"G", "drive/hk_tst_20190428/COM3_190428_124409.obs.gz",
                            "drive/hk_tst_20190428/hksc1180.19n"}),
    [](const auto& instance) { return Name(instance.param); });

}  // namespace
}  // namespace lodemark
