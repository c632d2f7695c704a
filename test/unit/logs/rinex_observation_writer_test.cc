#include "core/logs/rinex_observation_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kStart_ns = 2086 * kWeek_ns + 3 * kDay_ns;  // 2020-01-01
constexpr std::uint32_t kEverything = kHasPseudorange | kHasCarrierPhase | kHasDoppler | kHasCn0;

SignalObservation Signal(SatelliteId satellite, SignalCode code) {
  SignalObservation signal;
  signal.satellite = satellite;
  signal.signal = code;
  if (satellite.system == System::kGlonass) signal.glonass_channel = -4;
  signal.frequency_hz =
      CarrierFrequency(satellite.system, code.band, signal.glonass_channel).value_or(0.0);
  signal.present = kEverything;
  signal.pseudorange_m = 20'000'000.123;
  signal.carrier_phase_cycles = -105'000'000.456;
  signal.doppler_hz = -1234.567;
  signal.cn0_dbhz = 43.2;
  return signal;
}

ObservationEpoch Epoch(std::int64_t time_gps_ns, std::vector<SignalObservation> signals) {
  ObservationEpoch epoch;
  epoch.time_gps_ns = time_gps_ns;
  epoch.signals = std::move(signals);
  return epoch;
}

RinexObservationHeader HeaderFor(const std::vector<ObservationEpoch>& epochs) {
  RinexObservationContents contents;
  for (const ObservationEpoch& epoch : epochs) contents.Add(epoch);
  RinexObservationHeader header;
  header.types = contents.types;
  header.glonass_channels = contents.glonass_channels;
  return header;
}

std::string Written(const RinexObservationHeader& header,
                    const std::vector<ObservationEpoch>& epochs, std::int64_t* left_out = nullptr) {
  std::string text;
  RinexObservationWriter writer(header, {"test", {}, {}},
                                [&](std::string_view piece) { text += piece; });
  for (const ObservationEpoch& epoch : epochs) writer.Write(epoch);
  writer.Finish();
  if (left_out != nullptr) *left_out = writer.values_left_out();
  return text;
}

std::string Written(const std::vector<ObservationEpoch>& epochs) {
  return Written(HeaderFor(epochs), epochs);
}

std::vector<ObservationEpoch> ReadBack(const std::string& text) {
  auto reader = RinexObservationReader::FromLines(LineReader::FromMemory("written.obs", text));
  EXPECT_TRUE(reader.ok()) << reader.error().message;
  std::vector<ObservationEpoch> epochs;
  ObservationEpoch epoch;
  while (reader->Next(&epoch)) epochs.push_back(epoch);
  EXPECT_EQ(reader->report().rows_skipped, 0);
  EXPECT_EQ(reader->report().values_dropped, 0);
  return epochs;
}

// Epochs 100 ns off the second, of every system, with gaps and flags.
std::vector<ObservationEpoch> RandomEpochs() {
  constexpr std::pair<System, SignalCode> kSignals[] = {
      {System::kGps, {'1', 'C'}},    {System::kGps, {'5', 'Q'}},     {System::kGlonass, {'1', 'C'}},
      {System::kBeidou, {'2', 'I'}}, {System::kGalileo, {'5', 'Q'}}, {System::kQzss, {'1', 'C'}},
      {System::kNavic, {'5', 'A'}},  {System::kSbas, {'1', 'C'}}};
  Random random(5);
  std::vector<ObservationEpoch> epochs;
  for (int n = 0; n < 20; ++n) {
    ObservationEpoch& epoch = epochs.emplace_back();
    epoch.time_gps_ns = kStart_ns + n * std::int64_t{999'999'900};
    epoch.clock_discontinuity = n % 7 == 3;
    for (const auto& [system, code] : kSignals) {
      for (std::uint8_t number = 1; number <= 9; number += 4) {
        SignalObservation signal = Signal({system, number}, code);
        signal.pseudorange_m = std::round(random.Uniform(18e9, 42e9)) / 1000.0;
        signal.carrier_phase_cycles = std::round(random.Uniform(-9e11, 9e12)) / 1000.0;
        signal.doppler_hz = std::round(random.Uniform(-5e6, 5e6)) / 1000.0;
        signal.cn0_dbhz = std::round(random.Uniform(10e3, 60e3)) / 1000.0;
        signal.present = (random.NextBits() & kEverything) | kHasDoppler;
        signal.flags = random.NextBits() & (kLossOfLock | kHalfCycleAmbiguous);
        epoch.signals.push_back(signal);
      }
    }
  }
  return epochs;
}

TEST(RinexObservationWriter, WritesWhatTheReaderReadsBack) {
  const auto epochs = RandomEpochs();
  const auto back = ReadBack(Written(epochs));
  ASSERT_EQ(back.size(), epochs.size());
  for (std::size_t n = 0; n < epochs.size(); ++n) {
    EXPECT_EQ(back[n].time_gps_ns, epochs[n].time_gps_ns);
    EXPECT_EQ(back[n].clock_discontinuity, epochs[n].clock_discontinuity);
    ASSERT_EQ(back[n].signals.size(), epochs[n].signals.size());
    for (const SignalObservation& signal : epochs[n].signals) {
      const auto same = [&](const SignalObservation& other) {
        return other.satellite == signal.satellite && other.signal == signal.signal;
      };
      const auto found = std::find_if(back[n].signals.begin(), back[n].signals.end(), same);
      ASSERT_NE(found, back[n].signals.end());
      EXPECT_EQ(found->present, signal.present);
      EXPECT_EQ(found->flags, signal.flags);
      EXPECT_EQ(found->glonass_channel, signal.glonass_channel);
      EXPECT_EQ(found->frequency_hz, signal.frequency_hz);
      EXPECT_EQ(found->doppler_hz, signal.doppler_hz);
      // What is absent is zero in both.
      const auto kept = [&](std::uint32_t field, double value) {
        return signal.Has(field) ? value : 0.0;
      };
      EXPECT_EQ(found->pseudorange_m, kept(kHasPseudorange, signal.pseudorange_m));
      EXPECT_EQ(found->carrier_phase_cycles, kept(kHasCarrierPhase, signal.carrier_phase_cycles));
      EXPECT_EQ(found->cn0_dbhz, kept(kHasCn0, signal.cn0_dbhz));
    }
  }
}

TEST(RinexObservationWriter, LaysOutColumnsAsTheFormatSays) {
  const std::string text =
      Written({Epoch(kStart_ns + 429'910'200, {Signal({System::kGps, 7}, {'1', 'C'})})});
  EXPECT_THAT(text, HasSubstr("\nG    4 C1C L1C D1C S1C                                      "
                              "SYS / # / OBS TYPES\n"));
  EXPECT_THAT(text, HasSubstr("\n  2020     1     1     0     0    0.4299102     GPS         "
                              "TIME OF FIRST OBS\n"));
  EXPECT_THAT(text,
              HasSubstr("\n> 2020 01 01 00 00  0.4299102  0  1\n"
                        "G07  20000000.123 7-105000000.456 7     -1234.567          43.200\n"));
}

// The receiver's reading is t; P = c (t - t_sent). Under any tag T the written code must give the
// same t_sent, and code and phase must move together.
TEST(RinexObservationWriter, MovesWhatTheTagCannotHoldIntoCodeAndPhase) {
  for (const auto& [odd_ns, fraction_ns] : {std::pair<std::int64_t, double>{0, 0.0},
                                            {37, 0.25},
                                            {50, -0.01},
                                            {99, 0.9},
                                            {3, -0.5},
                                            {0, -12.5},
                                            {0, 260.0}}) {
    ObservationEpoch epoch = Epoch(kStart_ns + odd_ns, {Signal({System::kGps, 7}, {'1', 'C'}),
                                                        Signal({System::kGlonass, 2}, {'1', 'C'})});
    epoch.time_fraction_ns = fraction_ns;
    const auto back = ReadBack(Written({epoch}));
    ASSERT_EQ(back.size(), 1u);
    const double moved_ns =
        static_cast<double>(back[0].time_gps_ns - epoch.time_gps_ns) - fraction_ns;
    EXPECT_EQ(back[0].time_gps_ns % 100, 0);
    EXPECT_LE(std::abs(moved_ns), 50.0);
    for (std::size_t i = 0; i < 2; ++i) {
      const SignalObservation& before = epoch.signals[i];
      const SignalObservation& after = back[0].signals.at(i);
      const double moved_m = after.pseudorange_m - before.pseudorange_m;
      EXPECT_NEAR(moved_m, 0.299792458 * moved_ns, 0.0006) << odd_ns << " + " << fraction_ns;
      EXPECT_NEAR(after.carrier_phase_cycles - before.carrier_phase_cycles,
                  1e-9 * moved_ns * before.frequency_hz, 0.0006);
      EXPECT_EQ(after.doppler_hz, before.doppler_hz);
    }
  }
}

TEST(RinexObservationWriter, LeavesOutAPhaseItCannotMove) {
  SignalObservation signal = Signal({System::kGlonass, 2}, {'1', 'C'});
  signal.glonass_channel = kUnknownGlonassChannel;
  signal.frequency_hz = 0.0;
  const auto back = ReadBack(Written({Epoch(kStart_ns, {signal}), Epoch(kStart_ns + 1, {signal})}));
  EXPECT_TRUE(back.at(0).signals.at(0).Has(kHasCarrierPhase));
  EXPECT_FALSE(back.at(1).signals.at(0).Has(kHasCarrierPhase));
  EXPECT_TRUE(back.at(1).signals.at(0).Has(kHasPseudorange));
}

TEST(RinexObservationWriter, LeavesOutAndCountsWhatTheFormatHasNoRoomFor) {
  SignalObservation wide = Signal({System::kGps, 1}, {'1', 'C'});
  wide.carrier_phase_cycles = -1e9;
  const SignalObservation undeclared = Signal({System::kGalileo, 1}, {'1', 'C'});
  const auto header = HeaderFor({Epoch(kStart_ns, {wide})});
  std::int64_t left_out = 0;
  const auto back = ReadBack(Written(header, {Epoch(kStart_ns, {wide, undeclared})}, &left_out));
  ASSERT_EQ(back.at(0).signals.size(), 1u);
  EXPECT_EQ(back[0].signals[0].present, kEverything & ~kHasCarrierPhase);
  EXPECT_EQ(left_out, 2);
}

TEST(RinexObservationWriter, NamesSignalsOfUnknownAttributeAsPhonesTrackThem) {
  RinexObservationContents contents;
  contents.Add(Epoch(kStart_ns, {Signal({System::kGps, 1}, {'5', ' '})}));
  EXPECT_THAT(contents.types.at(System::kGps), ElementsAre("C5Q", "L5Q", "D5Q", "S5Q"));
}

TEST(RinexObservationWriter, KeepsTextOutOfOtherColumns) {
  RinexObservationHeader header = HeaderFor(RandomEpochs());
  header.marker_name = std::string(100, 'm') + "\n";
  header.receiver = "a\nb";
  const std::string text = Written(header, {});
  EXPECT_THAT(text, HasSubstr("\n" + std::string(60, 'm') + "MARKER NAME\n"));
  EXPECT_THAT(text, HasSubstr("a b"));
  EXPECT_THAT(text, Not(HasSubstr("a\nb")));
  EXPECT_TRUE(ReadBack(text).empty());
}

}  // namespace
}  // namespace lodemark
