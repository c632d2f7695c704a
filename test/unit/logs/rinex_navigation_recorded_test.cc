// Every navigation file among the recordings, against counts and values found by a simpler reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/rinex_navigation.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

struct File {
  const char* path;
  int explained_skips;  // see below
};

// brdc1580.16n holds one record of a QZSS satellite, root of the axis 6493, under the name of
// GPS 14.
constexpr File kFiles[] = {
    {"drive/berlin_potsdamer_20160606/BRDC00WRD_U_20161580000_01D_MN.rnx.gz", 0},
    {"drive/berlin_potsdamer_20160606/REDU00BEL_R_20161580000_01D_SN.rnx.gz", 0},
    {"drive/berlin_potsdamer_20160606/brdc1580.16g.gz", 0},
    {"drive/berlin_potsdamer_20160606/brdc1580.16n", 1},
    {"drive/hk_tst_20190428/hksc1180.19b", 0},
    {"drive/hk_tst_20190428/hksc1180.19n", 0},
    {"gnss/google_demo_20160822/hour2350.16n", 0},
    {"gnss/igs_esbjerg_20200625/ESBC00DNK_R_20201770000_01D_MN.rnx.gz", 0},
    {"gnss/pixel4_mtv_20200514/hour1350.20n", 0},
    {"gnss/pixel4_sjc_20210428/brdc1180.21n", 0},
    {"gnss/pixel5_mtv_20210428/hour1180.21n", 0},
    {"gnss/pixel_mtv_20210429/brdc1190.21n", 0},
    {"gnss/rinex4_nav_20230312/BRD400DLR_S_20230710000_01D_MN.rnx.gz", 0},
    {"gnss/rtk_geonet_20050402/07590920.05n", 0},
    {"gnss/rtk_geonet_20050402/30400920.05n", 0},
    {"gnss/rtk_nagoya_20240624/base.nav.gz", 0},
    {"gnss/s8_perth_20171005/PERT00AUS_R_20172780000_01D_MN.rnx.gz", 0},
    {"gnss/spirent_rtk_20230108/RINEX_EN_Spirent.23L", 0},
    {"gnss/spirent_rtk_20230108/RINEX_GN_Spirent.23N", 0},
    {"gnss/spirent_static_20230108/Spirent_RINEX_CN.23C", 0},
    {"gnss/spirent_static_20230108/Spirent_RINEX_EN.23L", 0},
    {"gnss/spirent_static_20230108/Spirent_RINEX_GN.23N", 0},
    {"gnss/spirent_static_20230108/Spirent_RINEX_IN.23I", 0},
    {"gnss/spirent_static_20230108/Spirent_RINEX_JN.23J", 0},
    {"gnss/spirent_static_20230108/Spirent_RINEX_RN.23G", 0},
    {"gnss/ublox_coldstart_20250425/16dBatt_no_interference_coldstart.nav.gz", 0},
};

// One record as plain text: the name of the satellite, the calendar and every number in the order
// of the file, found by splitting at fixed widths with strtod.
struct PlainRecord {
  std::string kind;  // "EPH G LNAV" in RINEX 4, else the satellite's letter
  std::string satellite;
  std::string calendar;
  std::vector<double> numbers;
};

double PlainNumber(std::string text) {
  std::replace(text.begin(), text.end(), 'D', 'E');
  return std::strtod(text.c_str(), nullptr);
}

void AppendNumbers(const std::string& line, std::size_t first, std::vector<double>* numbers) {
  for (std::size_t column = first; column < first + 4 * 19 && column < 80; column += 19) {
    numbers->push_back(column < line.size() ? PlainNumber(line.substr(column, 19)) : 0.0);
  }
}

std::vector<PlainRecord> PlainRecords(const std::string& path) {
  std::vector<PlainRecord> records;
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return records;
  std::string_view view;
  char version = 0;
  char letter = 0;
  bool in_header = true;
  while (lines->Next(&view)) {
    const std::string line(view);
    if (in_header) {
      if (version == 0) {
        version = line[5];
        letter = line[20] == 'N' ? 'G' : line[20] == 'G' ? 'R' : line[20];
      }
      in_header = line.find("END OF HEADER") == std::string::npos;
    } else if (version == '4' && line[0] == '>') {
      records.emplace_back();
      records.back().kind = line.substr(2, 5) + line.substr(9, 5);
      records.back().satellite = line.substr(6, 3);
    } else if (version == '4') {
      const bool first = records.back().calendar.empty();
      if (first) records.back().calendar = line.substr(4, 19);
      AppendNumbers(line, first ? 23 : 4, &records.back().numbers);
    } else if (line[0] != ' ' || line[1] != ' ') {
      records.emplace_back();
      records.back().kind = version == '2' ? std::string(1, letter) : line.substr(0, 1);
      records.back().satellite =
          version == '2' ? std::string(1, letter) + line.substr(0, 2) : line.substr(0, 3);
      records.back().calendar = version == '2' ? "20" + line.substr(3, 17) : line.substr(4, 19);
      AppendNumbers(line, version == '2' ? 22 : 23, &records.back().numbers);
      records.back().numbers.resize(3);
    } else {
      AppendNumbers(line, version == '2' ? 3 : 4, &records.back().numbers);
    }
  }
  for (PlainRecord& record : records) record.numbers.resize(44);
  return records;
}

std::string SatelliteOf(const NavigationRecord& record) {
  if (const auto* e = std::get_if<KeplerEphemeris>(&record)) return SatelliteName(e->satellite);
  if (const auto* e = std::get_if<StateEphemeris>(&record)) return SatelliteName(e->satellite);
  return {};
}

class RecordedRinexNavigation : public testing::TestWithParam<File> {
 protected:
  std::string path() const { return test::RecordingPath(GetParam().path); }

  // Records after the header's parameters.
  std::vector<NavigationRecord> Read(ReadReport* report) const {
    std::vector<NavigationRecord> records;
    const Status status = ReadRinexNavigation(
        path(), [&](const NavigationRecord& record) { records.push_back(record); }, report);
    EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
    records.erase(records.begin(), records.end() - report->rows_read);
    return records;
  }
};

TEST_P(RecordedRinexNavigation, TakesEveryRecordInOrder) {
  LODEMARK_NEEDS_RECORDING(GetParam().path);
  ReadReport report;
  const std::vector<NavigationRecord> records = Read(&report);
  const std::vector<PlainRecord> plain = PlainRecords(path());
  EXPECT_EQ(report.rows_unknown, 0);
  EXPECT_EQ(report.rows_skipped, GetParam().explained_skips);
  EXPECT_EQ(report.rows_read + report.rows_skipped, static_cast<std::int64_t>(plain.size()));
  std::map<std::string, int> counts;
  std::map<std::string, int> plain_counts;
  for (const NavigationRecord& record : records) ++counts[SatelliteOf(record)];
  for (const PlainRecord& record : plain) {
    const bool state_or_orbit = record.kind.size() == 1 || record.kind.substr(0, 3) == "EPH";
    std::string name = state_or_orbit ? record.satellite : "";
    if (name.size() == 3 && name[1] == ' ') name[1] = '0';
    ++plain_counts[name];
  }
  if (GetParam().explained_skips > 0) plain_counts["G14"] -= GetParam().explained_skips;
  EXPECT_EQ(counts, plain_counts);
}

// Calendar reading in the system's own scale, with no help from the reader's code.
double SecondsFromCalendar(const std::string& calendar) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  double second = 0.0;
  std::sscanf(calendar.c_str(), "%d %d %d %d %d %lf", &year, &month, &day, &hour, &minute, &second);
  const auto time = *NanosecondsFromCalendar({year, month, day, hour, minute, second});
  return 1e-9 * static_cast<double>(time);
}

double ScaleOffset(char letter) { return letter == 'C' ? 14.0 : 0.0; }

TEST_P(RecordedRinexNavigation, TakesEveryNumberAsItStands) {
  LODEMARK_NEEDS_RECORDING(GetParam().path);
  ReadReport report;
  const std::vector<NavigationRecord> records = Read(&report);
  std::vector<PlainRecord> plain = PlainRecords(path());
  std::erase_if(plain, [](const PlainRecord& record) {
    return record.kind == "G" && record.numbers[10] > 6000.0;  // the explained skip
  });
  ASSERT_EQ(records.size(), plain.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::vector<double>& n = plain[i].numbers;
    const double epoch_s = SecondsFromCalendar(plain[i].calendar);
    if (const auto* e = std::get_if<KeplerEphemeris>(&records[i])) {
      SCOPED_TRACE(plain[i].satellite + " " + plain[i].calendar);
      const double offset_s = ScaleOffset(plain[i].satellite[0]);
      ASSERT_EQ(1e-9 * static_cast<double>(e->toc_gps_ns), epoch_s + offset_s);
      ASSERT_EQ(e->clock_bias_s, n[0]);
      ASSERT_EQ(e->clock_drift_sps, n[1]);
      ASSERT_EQ(e->clock_drift_rate_sps2, n[2]);
      ASSERT_EQ(e->crs_m, n[4]);
      ASSERT_EQ(e->mean_motion_difference_radps, n[5]);
      ASSERT_EQ(e->mean_anomaly_rad, n[6]);
      ASSERT_EQ(e->cuc_rad, n[7]);
      ASSERT_EQ(e->eccentricity, n[8]);
      ASSERT_EQ(e->cus_rad, n[9]);
      ASSERT_EQ(e->semi_major_axis_m, n[10] * n[10]);
      ASSERT_EQ(e->cic_rad, n[12]);
      ASSERT_EQ(e->ascending_node_rad, n[13]);
      ASSERT_EQ(e->cis_rad, n[14]);
      ASSERT_EQ(e->inclination_rad, n[15]);
      ASSERT_EQ(e->crc_m, n[16]);
      ASSERT_EQ(e->argument_of_perigee_rad, n[17]);
      ASSERT_EQ(e->ascending_node_rate_radps, n[18]);
      ASSERT_EQ(e->inclination_rate_radps, n[19]);
      const bool refers_to_clock = e->type == MessageType::kCnav || e->type == MessageType::kCnav2;
      const double toe_s = 1e-9 * static_cast<double>(e->toe_gps_ns) - offset_s;
      if (refers_to_clock) {
        ASSERT_EQ(e->toe_gps_ns, e->toc_gps_ns);
      } else {
        ASSERT_EQ(std::fmod(toe_s, 604'800.0), std::fmod(n[11], 604'800.0));
      }
      ASSERT_LE(std::abs(toe_s - epoch_s), 7200.0);
      const bool issue_first = !refers_to_clock && e->type != MessageType::kCnav1 &&
                               e->type != MessageType::kCnav2Beidou;
      if (issue_first) {
        // The week stands beside toe, but for the systems that refer both to BeiDou time.
        const bool beidou = plain[i].satellite[0] == 'C';
        const double week = n[21] + (beidou ? 1356.0 : 0.0);
        ASSERT_EQ(std::floor(toe_s / 604'800.0), week + std::floor(n[11] / 604'800.0));
        ASSERT_EQ(e->issue_of_data, n[3]);
        ASSERT_EQ(e->accuracy_m, n[23]);
        ASSERT_EQ(e->health, n[24]);
      }
    } else if (const auto* state = std::get_if<StateEphemeris>(&records[i])) {
      SCOPED_TRACE(plain[i].satellite + " " + plain[i].calendar);
      // The leap seconds in force, from Bulletin C.
      const bool glonass = state->satellite.system == System::kGlonass;
      const double leap_s = !glonass ? 0.0 : plain[i].calendar < "2017" ? 17.0 : 18.0;
      ASSERT_EQ(1e-9 * static_cast<double>(state->toe_gps_ns), epoch_s + leap_s);
      ASSERT_EQ(state->clock_bias_s, n[0]);
      ASSERT_EQ(state->frequency_bias, n[1]);
      for (int axis = 0; axis < 3; ++axis) {
        const auto row = 3 + 4 * static_cast<std::size_t>(axis);
        ASSERT_DOUBLE_EQ(state->position_in_ecef[axis], 1000 * n[row]);
        ASSERT_DOUBLE_EQ(state->velocity_in_ecef[axis], 1000 * n[row + 1]);
        ASSERT_DOUBLE_EQ(state->acceleration_in_ecef[axis], 1000 * n[row + 2]);
      }
      if (glonass) {
        ASSERT_EQ(state->glonass_channel, n[10]);
      }
      // Sent within the half day around the time it refers to.
      ASSERT_LE(std::abs(state->transmitted_gps_ns - state->toe_gps_ns), kDay_ns / 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RecordedRinexNavigation, testing::ValuesIn(kFiles),
                         [](const auto& instance) {
                           std::string name(instance.param.path);
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

// Messages of the RINEX 4 file, counted by their headings.
TEST(RecordedRinex4Navigation, CountsEveryMessageAsItsHeadingSays) {
  const std::string name = "gnss/rinex4_nav_20230312/BRD400DLR_S_20230710000_01D_MN.rnx.gz";
  LODEMARK_NEEDS_RECORDING(name);
  const std::string path = test::RecordingPath(name);
  std::map<std::string, int> headings;
  for (const PlainRecord& record : PlainRecords(path)) ++headings[record.kind];

  std::map<System, int> ionospheres;
  int offsets = 0;
  int orientations = 0;
  std::map<std::pair<System, MessageType>, int> counts;
  ReadReport report;
  const Status status = ReadRinexNavigation(
      path,
      [&](const NavigationRecord& record) {
        if (const auto* e = std::get_if<KeplerEphemeris>(&record)) {
          ++counts[{e->satellite.system, e->type}];
        } else if (const auto* s = std::get_if<StateEphemeris>(&record)) {
          ++counts[{s->satellite.system, s->type}];
        } else if (const auto* i = std::get_if<IonosphereMessage>(&record)) {
          ++ionospheres[i->satellite.system];
        } else if (std::holds_alternative<TimeOffsetMessage>(record)) {
          ++offsets;
        } else if (std::holds_alternative<EarthOrientationMessage>(record)) {
          ++orientations;
        }
      },
      &report);
  ASSERT_TRUE(status.ok());
  EXPECT_EQ((counts[{System::kGps, MessageType::kLnav}]), headings["EPH G LNAV"]);
  EXPECT_EQ((counts[{System::kGps, MessageType::kCnav}]), headings["EPH G CNAV"]);
  EXPECT_EQ((counts[{System::kGalileo, MessageType::kInav}]), headings["EPH E INAV"]);
  EXPECT_EQ((counts[{System::kGalileo, MessageType::kFnav}]), headings["EPH E FNAV"]);
  EXPECT_EQ((counts[{System::kBeidou, MessageType::kD1}]), headings["EPH C D1  "]);
  EXPECT_EQ((counts[{System::kBeidou, MessageType::kD2}]), headings["EPH C D2  "]);
  EXPECT_EQ((counts[{System::kBeidou, MessageType::kCnav1}]), headings["EPH C CNV1"]);
  EXPECT_EQ((counts[{System::kBeidou, MessageType::kCnav2Beidou}]), headings["EPH C CNV2"]);
  EXPECT_EQ((counts[{System::kQzss, MessageType::kLnav}]), headings["EPH J LNAV"]);
  EXPECT_EQ((counts[{System::kQzss, MessageType::kCnav}]), headings["EPH J CNAV"]);
  EXPECT_EQ((counts[{System::kQzss, MessageType::kCnav2}]), headings["EPH J CNV2"]);
  EXPECT_EQ((counts[{System::kNavic, MessageType::kLnav}]), headings["EPH I LNAV"]);
  EXPECT_EQ((counts[{System::kGlonass, MessageType::kFdma}]), headings["EPH R FDMA"]);
  EXPECT_EQ((counts[{System::kSbas, MessageType::kSbas}]), headings["EPH S SBAS"]);
  std::map<std::string, int> kinds;
  for (const auto& [heading, count] : headings) kinds[heading.substr(0, 3)] += count;
  EXPECT_EQ(offsets, kinds["STO"]);
  EXPECT_EQ(orientations, kinds["EOP"]);
  EXPECT_EQ(ionospheres[System::kQzss], headings["ION J LNAV"] + headings["ION J CNVX"]);
  EXPECT_EQ(ionospheres[System::kBeidou], headings["ION C D1D2"] + headings["ION C CNVX"]);
  EXPECT_GT(counts[(std::pair{System::kGps, MessageType::kLnav})], 400);
}

}  // namespace
}  // namespace lodemark
