#include "core/logs/ubx.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/logs/recording.h"
#include "core/logs/ubx_frames.h"
#include "test/unit/logs/ubx_bytes_of.h"

namespace lodemark {
namespace {

using test::Rawx;
using test::RawxPayload;
using test::RawxSignal;
using test::Sfrbx;
using test::UbxMessage;

// Published messages: the poll of MON-VER and a CFG-RATE of the u-blox protocol, the NMEA sentence
// and the RTCM 1005 that their standards have as examples.
const std::string kMonVer("\xB5\x62\x0A\x04\x00\x00\x0E\x34", 8);
const std::string kCfgRate("\xB5\x62\x06\x08\x06\x00\xC8\x00\x01\x00\x01\x00\xDE\x6A", 14);
const std::string kNmea = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n";
const std::string kRtcm(
    "\xD3\x00\x13\x3E\xD7\xD3\x02\x02\x98\x0E\xDE\xEF\x34\xB4\xBD\x62\xAC\x09\x41\x98\x6F\x33\x36"
    "\x0B\x98",
    25);

struct Frames {
  std::vector<std::int64_t> offsets;
  std::vector<int> ids;
  std::int64_t nmea = 0;
  std::int64_t rtcm = 0;
  ReadReport report;
};

Frames Cut(const std::string& bytes) {
  UbxFrameReader reader = UbxFrameReader::FromSource(TextSource::FromMemory("x.ubx", bytes));
  Frames frames;
  for (UbxFrame frame; reader.Next(&frame);) {
    frames.offsets.push_back(frame.offset);
    frames.ids.push_back(frame.message_class << 8 | frame.message_id);
  }
  frames.nmea = reader.nmea_sentences();
  frames.rtcm = reader.rtcm_messages();
  frames.report = reader.report();
  return frames;
}

struct Read {
  std::vector<ObservationEpoch> epochs;
  std::vector<LoggedNavigationMessage> messages;
  ReadReport report;
  std::int64_t without_time = 0;
};

Read ReadAll(const std::string& bytes) {
  UbxReader reader = UbxReader::FromSource(TextSource::FromMemory("x.ubx", bytes));
  Read read;
  for (UbxRecord record; reader.Next(&record);) {
    if (const auto* epoch = std::get_if<ObservationEpoch>(&record)) read.epochs.push_back(*epoch);
    if (const auto* message = std::get_if<LoggedNavigationMessage>(&record)) {
      read.messages.push_back(*message);
    }
  }
  read.report = reader.report();
  read.without_time = reader.epochs_without_time();
  return read;
}

TEST(UbxFrames, AreCutOutBetweenOtherProtocols) {
  const Frames frames = Cut(kMonVer + kNmea + kCfgRate + kRtcm + kNmea + kMonVer);
  EXPECT_EQ(frames.ids, (std::vector<int>{0x0A04, 0x0608, 0x0A04}));
  EXPECT_EQ(frames.nmea, 2);
  EXPECT_EQ(frames.rtcm, 1);
  EXPECT_EQ(frames.report.rows_skipped, 0);
  EXPECT_EQ(frames.offsets[1], static_cast<std::int64_t>(kMonVer.size() + kNmea.size()));
}

TEST(UbxFrames, ADamagedOneIsToldByItsPlaceAndTheNextIsFound) {
  std::string damaged = kCfgRate;
  damaged[8] = '\x55';
  const Frames frames = Cut(kMonVer + damaged + kMonVer);
  EXPECT_EQ(frames.ids, (std::vector<int>{0x0A04, 0x0A04}));
  ASSERT_EQ(frames.report.problems.size(), 1u);
  EXPECT_EQ(FormatProblem("x.ubx", frames.report.problems[0]),
            "x.ubx: byte 8: message 0x06 0x08 of 6 bytes whose checksum is wrong");
}

TEST(UbxFrames, ADamagedLengthDoesNotSwallowWhatFollows) {
  std::string damaged = kCfgRate;
  damaged[5] = '\x7F';  // 32,518 bytes
  const Frames frames = Cut(damaged + kMonVer + kCfgRate);
  EXPECT_EQ(frames.ids, (std::vector<int>{0x0A04, 0x0608}));
  EXPECT_EQ(frames.report.rows_skipped, 1);
}

TEST(UbxFrames, AFileMayBeginAndEndInTheMiddleOfOne) {
  const Frames frames = Cut(kCfgRate.substr(5) + kMonVer + kCfgRate.substr(0, 9));
  EXPECT_EQ(frames.ids, (std::vector<int>{0x0A04}));
  ASSERT_EQ(frames.report.problems.size(), 2u);
  EXPECT_EQ(frames.report.problems[0].message, "byte 0: 9 bytes that are no message");
  EXPECT_EQ(frames.report.problems[1].message,
            "byte 17: message 0x06 0x08 of 6 bytes cut short by the end of the file");
}

TEST(UbxFrames, LongMessagesCrossTheBuffer) {
  std::string bytes;
  for (int i = 0; i < 20; ++i) {
    bytes += UbxMessage(0x01, i, std::string(65'535, static_cast<char>(0xB5 + i)));
  }
  const Frames frames = Cut(bytes);
  ASSERT_EQ(frames.ids.size(), 20u);
  EXPECT_EQ(frames.ids[19], 0x0113);
  EXPECT_EQ(frames.report.rows_skipped, 0);
}

// Every sixth byte begins what says of itself to be as long as a message can be.
TEST(UbxFrames, FalseBeginningsCostNoMoreTimeThanOtherBytes) {
  std::string bytes;
  while (bytes.size() < 3'000'000) bytes += "\xB5\x62\x02\x15\xFF\xFF";
  const Frames frames = Cut(bytes + kMonVer);
  EXPECT_EQ(frames.ids, (std::vector<int>{0x0A04}));
  EXPECT_EQ(frames.report.rows_skipped, 1);
}

TEST(UbxReader, GivesMeasurementsInRinexTerms) {
  RawxSignal gps;
  RawxSignal glonass;
  glonass.gnss_id = 6;
  glonass.sv_id = 9;
  glonass.sig_id = 2;
  glonass.freq_id = 5;  // channel -2
  RawxSignal sbas;
  sbas.gnss_id = 1;
  sbas.sv_id = 133;
  sbas.tracking = 1;  // no phase
  const Read read = ReadAll(Rawx(408'639.748, {gps, glonass, sbas}));
  ASSERT_EQ(read.epochs.size(), 1u);
  const ObservationEpoch& epoch = read.epochs[0];
  EXPECT_EQ(epoch.time_gps_ns, 2381 * kWeek_ns + 408'639'748'000'000);
  EXPECT_FALSE(epoch.clock_discontinuity);
  ASSERT_EQ(epoch.signals.size(), 3u);

  const SignalObservation& g = epoch.signals[0];
  EXPECT_EQ(g.satellite, (SatelliteId{System::kGps, 7}));
  EXPECT_EQ(g.signal, (SignalCode{'1', 'C'}));
  EXPECT_EQ(g.pseudorange_m, 22e6);
  EXPECT_EQ(g.carrier_phase_cycles, 115e6);
  EXPECT_EQ(g.doppler_hz, -1234.5);
  EXPECT_EQ(g.cn0_dbhz, 45.0);
  EXPECT_DOUBLE_EQ(g.pseudorange_sigma_m, 0.16);
  EXPECT_DOUBLE_EQ(g.carrier_phase_sigma_m, 0.008 * kSpeedOfLight_mps / 1575.42e6);
  EXPECT_DOUBLE_EQ(g.range_rate_sigma_mps, 0.064 * kSpeedOfLight_mps / 1575.42e6);
  EXPECT_EQ(g.flags, 0u);

  const SignalObservation& r = epoch.signals[1];
  EXPECT_EQ(r.satellite, (SatelliteId{System::kGlonass, 9}));
  EXPECT_EQ(r.signal, (SignalCode{'2', 'C'}));
  EXPECT_EQ(r.glonass_channel, -2);
  EXPECT_DOUBLE_EQ(r.frequency_hz, 1246e6 - 2 * 0.4375e6);

  const SignalObservation& s = epoch.signals[2];
  EXPECT_EQ(s.satellite, (SatelliteId{System::kSbas, 33}));
  EXPECT_FALSE(s.Has(kHasCarrierPhase));
  EXPECT_TRUE(s.Has(kHasPseudorange | kHasDoppler));
}

TEST(UbxReader, TellsWhenThePhaseMayHaveSlipped) {
  struct Step {
    double second;
    unsigned lock_ms, tracking;
    std::uint32_t flags;
  };
  const Step steps[] = {
      {100.0, 500, 7, 0},                                   // first seen, and locked for a while
      {101.0, 1500, 7, 0},                                  // went on
      {102.0, 900, 7, kLossOfLock},                         // fell
      {105.0, 1700, 7, kLossOfLock},                        // grew, but by less than the time
      {106.0, 64'500, 7, 0},                                // at its end
      {107.0, 64'500, 15, kLossOfLock},                     // half a cycle taken off
      {108.0, 64'500, 15, 0},                               // and still off
      {109.0, 0, 15, kLossOfLock},                          // just locked
      {110.0, 1000, 11, kHalfCycleAmbiguous},               // which half is not known
      {111.0, 1000, 3, kLossOfLock | kHalfCycleAmbiguous},  // stands still
  };
  std::string bytes;
  for (const Step& step : steps) {
    RawxSignal signal;
    signal.lock_ms = step.lock_ms;
    signal.tracking = step.tracking;
    bytes += Rawx(step.second, {signal});
  }
  const Read read = ReadAll(bytes);
  ASSERT_EQ(read.epochs.size(), std::size(steps));
  for (std::size_t i = 0; i < std::size(steps); ++i) {
    EXPECT_EQ(read.epochs[i].signals[0].flags, steps[i].flags) << "at " << steps[i].second;
  }
}

TEST(UbxReader, SaysThatTheClockWasReset) {
  const Read read = ReadAll(Rawx(1.0, {RawxSignal()}, 3) + Rawx(2.0, {RawxSignal()}));
  ASSERT_EQ(read.epochs.size(), 2u);
  EXPECT_TRUE(read.epochs[0].clock_discontinuity);
  EXPECT_FALSE(read.epochs[1].clock_discontinuity);
}

TEST(UbxReader, LeavesOutWhatNoSatelliteCanGive) {
  RawxSignal impossible;
  impossible.pseudorange_m = std::numeric_limits<double>::quiet_NaN();
  impossible.phase_cycles = 1e300;
  impossible.doppler_hz = std::numeric_limits<float>::infinity();
  impossible.cn0_dbhz = 0;
  RawxSignal unknown;
  unknown.gnss_id = 4;
  RawxSignal twin;
  const Read read = ReadAll(Rawx(1.0, {impossible, unknown, twin, twin}));
  ASSERT_EQ(read.epochs.size(), 1u);
  EXPECT_EQ(read.epochs[0].signals.size(), 1u);
  EXPECT_EQ(read.report.values_dropped, 4);
}

TEST(UbxReader, SkipsEpochsThatAreNotWhatTheySay) {
  const std::string good = RawxPayload(1.0, 2381, {RawxSignal()});
  std::string newer = good;
  newer[13] = 2;
  std::string fewer = good;
  fewer[11] = 2;
  const std::string late = RawxPayload(604'800.0, 2381, {RawxSignal()});
  std::string bytes;
  for (const std::string& payload : {newer, fewer, late, good.substr(0, 9)}) {
    bytes += UbxMessage(0x02, 0x15, payload);
  }
  const Read read = ReadAll(bytes + UbxMessage(0x02, 0x15, good));
  EXPECT_EQ(read.epochs.size(), 1u);
  EXPECT_EQ(read.report.rows_skipped, 4);
  EXPECT_EQ(read.report.problems[0].message, "byte 0: RXM-RAWX of version 2 is not known");
}

TEST(UbxReader, WaitsForTheWeek) {
  const Read read = ReadAll(UbxMessage(0x02, 0x15, RawxPayload(1.0, 0, {RawxSignal()})) +
                            Rawx(2.0, {RawxSignal()}));
  EXPECT_EQ(read.without_time, 1);
  EXPECT_EQ(read.epochs.size(), 1u);
}

TEST(UbxReader, GivesBroadcastWordsAsAndroidDoes) {
  const Read read =
      ReadAll(Sfrbx(0, 7, 0, 0, {0x22C000C3, 2, 3, 4, 5, 6, 7, 8, 9, 0x01020304}) +
              Sfrbx(5, 2, 0, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) +
              Sfrbx(3, 21, 4, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) +
              Sfrbx(6, 9, 0, 5, {0x11223344, 0x55667788, 0x99AABBCC, 0xDDEEFF00}) +
              Sfrbx(6, 255, 0, 5, {1, 2, 3, 4}) +
              // Half pages of ones, of which tail and padding are set, too, and of zeros.
              Sfrbx(2, 26, 1, 0, {~0u, ~0u, ~0u, ~0u, 0, 0, 0, 0}));
  ASSERT_EQ(read.messages.size(), 6u);
  const auto& gps = read.messages[0];
  EXPECT_EQ(gps.type, 0x0101);
  EXPECT_EQ(gps.svid, 7);
  ASSERT_EQ(gps.bytes.size(), 40u);
  EXPECT_EQ(gps.bytes[0], 0x22);
  EXPECT_EQ(gps.bytes[3], 0xC3);
  EXPECT_EQ(gps.bytes[39], 0x04);
  EXPECT_EQ(read.messages[1].type, 0x0401);
  EXPECT_EQ(read.messages[1].svid, 194);
  EXPECT_EQ(read.messages[2].type, 0x0501);
  EXPECT_EQ(read.messages[2].svid, 21);
  EXPECT_EQ(read.messages[3].type, 0x0301);
  EXPECT_EQ(read.messages[3].svid, 9);
  EXPECT_EQ(read.messages[3].bytes, (std::vector<std::uint8_t>{0x11, 0x22, 0x33, 0x44, 0x55, 0x66,
                                                               0x77, 0x88, 0x99, 0xAA, 0xBB}));
  EXPECT_EQ(read.messages[4].svid, 98);  // channel -2 while the slot is not known
  const auto& galileo = read.messages[5];
  EXPECT_EQ(galileo.type, 0x0601);
  ASSERT_EQ(galileo.bytes.size(), 29u);
  for (std::size_t bit = 0; bit < 232; ++bit) {
    EXPECT_EQ(galileo.bytes[bit / 8] >> (7 - bit % 8) & 1, bit < 114 ? 1 : 0) << bit;
  }
}

TEST(UbxReader, FilesAreToldFromOthers) {
  const std::string path = ::testing::TempDir() + "lodemark_sniffed.bin";
  const auto kind_of = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    const Result<FileKind> kind = SniffFile(path);
    return kind ? *kind : FileKind::kTrajectory;
  };
  EXPECT_EQ(kind_of(kMonVer), FileKind::kUbx);
  EXPECT_EQ(kind_of(kNmea + kNmea + "\x15\x62" + Rawx(1.0, {RawxSignal()})), FileKind::kUbx);
  EXPECT_EQ(kind_of(kNmea + kNmea), FileKind::kUnknown);
  EXPECT_EQ(kind_of("\xC2\xB5"
                    "big text"),
            FileKind::kUnknown);
}

TEST(UbxReader, PassesOverMessagesThatNobodyDecodes) {
  const Read read =
      ReadAll(Sfrbx(0, 7, 4, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) +  // CNAV
              Sfrbx(2, 7, 3, 0, {1, 2, 3, 4, 5, 6, 7, 8}) +         // F/NAV
              Sfrbx(1, 133, 0, 0, {1, 2, 3, 4, 5, 6, 7, 8}) +       // SBAS
              Sfrbx(0, 99, 0, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) + Sfrbx(0, 7, 0, 0, {1, 2, 3}));
  EXPECT_TRUE(read.messages.empty());
  EXPECT_EQ(read.report.rows_skipped, 1);
  EXPECT_EQ(read.report.rows_read, 4);
}

}  // namespace
}  // namespace lodemark
