// Every observation file among the recordings, against a reader that goes another way: text cut
// into fields and strtod, with sums in place of structures.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/logs/rinex_observation.h"
#include "core/logs/rinex_observation_writer.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

struct Sums {
  std::int64_t epochs = 0;
  std::int64_t satellites = 0;
  std::array<std::int64_t, 4> count = {};        // of C, L, D, S
  std::array<std::int64_t, 4> thousandths = {};  // sum

  bool operator==(const Sums&) const = default;
};

void PrintTo(const Sums& sums, std::ostream* out) {
  *out << sums.epochs << " epochs, " << sums.satellites << " satellites";
  for (std::size_t i = 0; i < 4; ++i) {
    *out << ", " << "CLDS"[i] << " " << sums.count[i] << " " << sums.thousandths[i];
  }
}

Sums SumsOfReader(RinexObservationReader* reader) {
  Sums sums;
  ObservationEpoch epoch;
  while (reader->Next(&epoch)) {
    ++sums.epochs;
    for (const SignalObservation& signal : epoch.signals) {
      const auto add = [&](std::size_t i, std::uint32_t field, double value) {
        if (!signal.Has(field)) return;
        ++sums.count[i];
        sums.thousandths[i] += std::llround(value * 1000.0);
      };
      add(0, kHasPseudorange, signal.pseudorange_m);
      add(1, kHasCarrierPhase, signal.carrier_phase_cycles);
      add(2, kHasDoppler, signal.doppler_hz);
      add(3, kHasCn0, signal.cn0_dbhz);
    }
  }
  sums.satellites = reader->report().rows_read;
  return sums;
}

// Version 3 without events and without Hatanaka's compression.
Sums SumsOfText(const std::string& path) {
  Sums sums;
  std::map<char, std::vector<std::string>> types;
  char system = ' ';
  bool header = true;
  auto lines = LineReader::Open(path);
  EXPECT_TRUE(lines.ok());
  std::string_view view;
  while (lines.ok() && lines->Next(&view)) {
    const std::string line(view);
    if (header) {
      header = line.find("END OF HEADER") == std::string::npos;
      if (line.find("SYS / # / OBS TYPES") == std::string::npos) continue;
      if (line[0] != ' ') system = line[0];
      std::istringstream words(line.substr(6, 54));
      for (std::string type; words >> type;) types[system].push_back(type);
    } else if (line[0] == '>') {
      ++sums.epochs;
    } else {
      ++sums.satellites;
      const auto& columns = types[line[0]];
      for (std::size_t i = 0; i < columns.size() && 3 + 16 * i < line.size(); ++i) {
        const std::size_t quantity = std::string("CLDS").find(columns[i][0]);
        const double value = std::strtod(line.substr(3 + 16 * i, 14).c_str(), nullptr);
        if (quantity > 3 || value == 0.0) continue;
        ++sums.count[quantity];
        sums.thousandths[quantity] += std::llround(value * 1000.0);
      }
    }
  }
  return sums;
}

class RecordedRinexObservation : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedRinexObservation, LosesNoRowAndNoDigit) {
  LODEMARK_NEEDS_RECORDING(GetParam());
  const std::string path = test::RecordingPath(GetParam());
  auto reader = RinexObservationReader::Open(path);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ(SumsOfReader(&*reader), SumsOfText(path));
  EXPECT_TRUE(reader->status().ok());
  EXPECT_EQ(reader->report().values_dropped, 0);
  // The simulator's NavIC satellites were counted into six epochs whose lines lack them.
  const bool short_epochs = path.find("spirent_static") != std::string::npos;
  EXPECT_EQ(reader->report().rows_skipped, short_epochs ? 6 : 0);
}

INSTANTIATE_TEST_SUITE_P(
    Version3, RecordedRinexObservation,
    ::testing::Values("drive/hk_tst_20190428/COM3_190428_124409.obs.gz",
                      "gnss/pixel5_mtv_20210428/Pixel5_GnssLog_first1000.21o.gz",
                      "gnss/pixel7_stanford_20231107/pixel6.23o",
                      "gnss/rtk_nagoya_20240624/base.obs.gz",
                      "gnss/rtk_nagoya_20240624/rover.obs.gz",
                      "gnss/spirent_rtk_20230108/base-static.obs.gz",
                      "gnss/spirent_rtk_20230108/rover-dynamic.obs.gz",
                      "gnss/spirent_rtk_20230108/rover-static-2km-east.obs.gz",
                      "gnss/spirent_static_20230108/iono-klob_tropo-saastamoinen.obs.gz",
                      "gnss/spirent_static_20230108/iono-none_tropo-none.obs.gz",
                      "gnss/ublox_coldstart_20250425/16dBatt_no_interference_coldstart.obs.gz"));

// Lines of a version 2 file that bear a date at their head.
std::int64_t DatedLines(const std::string& path) {
  std::int64_t count = 0;
  bool header = true;
  auto lines = LineReader::Open(path);
  EXPECT_TRUE(lines.ok());
  std::string_view line;
  while (lines.ok() && lines->Next(&line)) {
    if (!header) count += line.size() > 18 && line[18] == '.' && line[26] == ' ' ? 1 : 0;
    if (line.find("END OF HEADER") != std::string_view::npos) header = false;
  }
  return count;
}

class RecordedRinexObservation2 : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedRinexObservation2, LosesNoRow) {
  LODEMARK_NEEDS_RECORDING(GetParam());
  const std::string path = test::RecordingPath(GetParam());
  auto reader = RinexObservationReader::Open(path);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ(SumsOfReader(&*reader).epochs, DatedLines(path));
  EXPECT_EQ(reader->report().values_dropped, 0);
  EXPECT_EQ(reader->report().rows_skipped, 0);
}

INSTANTIATE_TEST_SUITE_P(Version2, RecordedRinexObservation2,
                         ::testing::Values("drive/berlin_potsdamer_20160606/"
                                           "Berlin_Potsdamer_Platz.obs.gz",
                                           "gnss/rtk_geonet_20050402/07590920.05o",
                                           "gnss/rtk_geonet_20050402/30400920.05o"));

TEST(RecordedCrinex, GivesEveryEpochOfTheDay) {
  const std::string name = "gnss/igs_esbjerg_20200625/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz";
  LODEMARK_NEEDS_RECORDING(name);
  auto reader = RinexObservationReader::Open(test::RecordingPath(name));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ(SumsOfReader(&*reader).epochs, 24 * 120);
  EXPECT_EQ(reader->report().rows_skipped, 0);
  EXPECT_EQ(reader->report().values_dropped, 0);
}

void Rewrite(const std::string& from, const std::string& to) {
  RinexObservationContents contents;
  ObservationEpoch epoch;
  auto first = RinexObservationReader::Open(from);
  ASSERT_TRUE(first.ok());
  while (first->Next(&epoch)) contents.Add(epoch);
  RinexObservationHeader header = first->header();
  header.types = contents.types;
  std::ofstream file(to);
  RinexObservationWriter writer(header, {"lodemark", {}, {}},
                                [&](std::string_view text) { file << text; });
  auto second = RinexObservationReader::Open(from);
  while (second->Next(&epoch)) writer.Write(epoch);
  EXPECT_EQ(writer.values_left_out(), 0);
}

// The lines of a solution file that hold positions.
std::vector<std::string> Positions(const std::string& path) {
  std::vector<std::string> positions;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '%') positions.push_back(line);
  }
  return positions;
}

TEST(RecordedRinexObservationWriter, GivesRnx2rtkpTheSamePositions) {
  const std::string folder = "gnss/pixel5_mtv_20210428/";
  LODEMARK_NEEDS_RECORDING(folder);
  if (std::system("command -v rnx2rtkp > /dev/null") != 0) GTEST_SKIP() << "no rnx2rtkp";
  const std::string scratch = ::testing::TempDir() + "rinex_writer_";
  const std::string original = scratch + "original.obs";
  {
    auto lines = LineReader::Open(test::RecordingPath(folder + "Pixel5_GnssLog_first1000.21o.gz"));
    ASSERT_TRUE(lines.ok());
    std::ofstream file(original);
    std::string_view line;
    while (lines->Next(&line)) file << line << '\n';
  }
  Rewrite(original, scratch + "rewritten.obs");
  for (const char* name : {"original", "rewritten"}) {
    const std::string command = "rnx2rtkp -p 0 -e -o " + scratch + name + ".pos " + scratch + name +
                                ".obs " + test::RecordingPath(folder + "hour1180.21n") +
                                " 2> /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  const auto positions = Positions(scratch + "original.pos");
  EXPECT_GT(positions.size(), 800u);
  EXPECT_EQ(Positions(scratch + "rewritten.pos"), positions);  // to the printed 0.1 mm
  for (const char* name : {"original", "rewritten"}) {
    std::filesystem::remove(scratch + name + ".obs");
    std::filesystem::remove(scratch + name + ".pos");
  }
}

}  // namespace
}  // namespace lodemark
