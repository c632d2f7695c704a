#include "core/gnss/android_signal.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "core/base/units.h"
#include "core/gnss/android_signal_time.h"

namespace lodemark {
namespace {

AndroidMeasurement Measurement(std::int32_t constellation, std::int32_t svid) {
  AndroidMeasurement raw;
  raw.constellation_type = constellation;
  raw.svid = svid;
  return raw;
}

std::string NameOf(const AndroidMeasurement& raw, const GlonassChannels& channels = {}) {
  AndroidSignal signal;
  const RawVerdict verdict = IdentifySignal(raw, channels, &signal);
  if (verdict == RawVerdict::kUnknownConstellation) return "constellation?";
  if (verdict == RawVerdict::kUnknownSatellite) return "satellite?";
  if (verdict == RawVerdict::kUnknownSignal) return "signal?";
  return SatelliteName(signal.satellite) + " " + signal.signal.band + signal.signal.attribute;
}

AndroidMeasurement OnCarrier(AndroidMeasurement raw, double frequency_hz,
                             std::string_view code = "") {
  raw.carrier_frequency_hz = frequency_hz;
  raw.present |= kMeasurementHasCarrierFrequency;
  if (!code.empty()) {
    code.copy(raw.code_type, sizeof(raw.code_type) - 1);
    raw.present |= kMeasurementHasCodeType;
  }
  return raw;
}

TEST(IdentifySignal, NumbersSatellitesAsRinexDoes) {
  EXPECT_EQ(NameOf(Measurement(1, 32)), "G32 1C");
  EXPECT_EQ(NameOf(Measurement(2, 133)), "S33 1C");
  EXPECT_EQ(NameOf(Measurement(2, 46)), "S33 1C");  // NMEA's number for PRN 133
  EXPECT_EQ(NameOf(Measurement(3, 24)), "R24 1C");
  EXPECT_EQ(NameOf(Measurement(4, 193)), "J01 1C");
  EXPECT_EQ(NameOf(Measurement(5, 63)), "C63 2I");
  EXPECT_EQ(NameOf(Measurement(6, 36)), "E36 1C");
  EXPECT_EQ(NameOf(Measurement(7, 14)), "I14 5A");
}

TEST(IdentifySignal, RefusesWhatNoSystemHas) {
  EXPECT_EQ(NameOf(Measurement(0, 1)), "constellation?");
  EXPECT_EQ(NameOf(Measurement(8, 1)), "constellation?");
  EXPECT_EQ(NameOf(Measurement(1, 0)), "satellite?");
  EXPECT_EQ(NameOf(Measurement(1, 33)), "satellite?");
  EXPECT_EQ(NameOf(Measurement(2, 1)), "satellite?");
  EXPECT_EQ(NameOf(Measurement(4, 183)), "satellite?");
  EXPECT_EQ(NameOf(Measurement(3, 92)), "satellite?");
  EXPECT_EQ(NameOf(Measurement(3, 107)), "satellite?");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(1, 1), 1.45e9)), "signal?");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(1, 1), -1e300)), "signal?");
}

TEST(IdentifySignal, TakesBandFromCarrierAndAttributeFromCodeType) {
  EXPECT_EQ(NameOf(OnCarrier(Measurement(1, 1), 1'176'450'050.0)), "G01 5Q");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(1, 1), 1'176'450'050.0, "X")), "G01 5X");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(5, 30), 1.57542e9, "P")), "C30 1P");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(5, 30), 1.561098e9)), "C30 2I");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(6, 30), 1.57542e9, "B")), "E30 1B");
}

TEST(IdentifySignal, KeepsTheUsualAttributeWhereTheCodeTypeIsNone) {
  EXPECT_EQ(NameOf(OnCarrier(Measurement(1, 1), 1.57542e9, "UNKNOWN")), "G01 1C");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(6, 1), 1.57542e9, "Q")), "E01 1C");
  EXPECT_EQ(NameOf(OnCarrier(Measurement(6, 1), 1.57542e9, "?")), "E01 1C");
}

TEST(IdentifySignal, ReadsTheGlonassChannelFromTheCarrier) {
  AndroidSignal signal;
  IdentifySignal(OnCarrier(Measurement(3, 2), 1'599'750'020.0), {}, &signal);
  EXPECT_EQ(signal.glonass_channel, -4);
  EXPECT_DOUBLE_EQ(signal.frequency_hz, 1599.75e6);
}

TEST(IdentifySignal, AsksTheTableForTheSlotOfAChannel) {
  GlonassChannels channels;
  EXPECT_EQ(NameOf(Measurement(3, 105), channels), "satellite?");
  channels.SetChannel(3, 5);
  EXPECT_EQ(NameOf(Measurement(3, 105), channels), "R03 1C");
  channels.SetChannel(7, 5);  // the antipode
  EXPECT_EQ(NameOf(Measurement(3, 105), channels), "satellite?");
  channels.SetVisibleSlot(5, 7);
  EXPECT_EQ(NameOf(Measurement(3, 105), channels), "R07 1C");
}

TEST(IdentifySignal, AsksTheTableForTheChannelOfASlot) {
  GlonassChannels channels;
  channels.SetChannel(3, 5);
  AndroidSignal signal;
  IdentifySignal(Measurement(3, 3), channels, &signal);
  EXPECT_EQ(signal.glonass_channel, 5);
  EXPECT_DOUBLE_EQ(signal.frequency_hz, 1602e6 + 5 * 0.5625e6);
}

TEST(GlonassChannels, IgnoresWhatIsNoSlotOrChannel) {
  GlonassChannels channels;
  channels.SetChannel(0, 1);
  channels.SetChannel(28, 1);
  channels.SetChannel(1, 7);
  channels.SetVisibleSlot(-8, 1);
  channels.SetVisibleSlot(1, 28);
  EXPECT_EQ(channels.ChannelOf(1), kUnknownGlonassChannel);
  EXPECT_EQ(channels.ChannelOf(99), kUnknownGlonassChannel);
  EXPECT_EQ(channels.SlotOf(1), 0);
  EXPECT_EQ(channels.SlotOf(kUnknownGlonassChannel), 0);
}

// GnssMeasurement.getReceivedSvTimeNanos, the table of ranges by state.
TEST(AmbiguityPeriod, FollowsTheDocumentedTable) {
  struct Case {
    std::int32_t state;
    System system;
    SignalCode signal;
    std::int64_t period_ns;
  };
  const SignalCode l1 = {'1', 'C'};
  const SignalCode l5 = {'5', 'Q'};
  const Case cases[] = {
      {kStateCodeLock, System::kGps, l1, kMillisecond_ns},
      {kStateCodeLock | kStateBitSync, System::kGps, l1, 20 * kMillisecond_ns},
      {kStateCodeLock | kStateSubframeSync, System::kGps, l1, 6 * kSecond_ns},
      {kStateCodeLock | kStateTowDecoded, System::kGps, l1, kWeek_ns},
      {kStateCodeLock | kStateTowKnown, System::kGps, l1, kWeek_ns},
      {kStateCodeLock | kStateSecondaryCodeLock, System::kGps, l5, 20 * kMillisecond_ns},
      {kStateCodeLock | kStateTowDecoded | kStateMillisecondAmbiguous, System::kGps, l1,
       kMillisecond_ns},
      {kStateCodeLock | kStateSymbolSync, System::kGlonass, l1, 10 * kMillisecond_ns},
      {kStateCodeLock | kStateBitSync, System::kGlonass, l1, 20 * kMillisecond_ns},
      {kStateCodeLock | kStateGlonassStringSync, System::kGlonass, l1, 2 * kSecond_ns},
      {kStateCodeLock | kStateGlonassTodKnown, System::kGlonass, l1, kDay_ns},
      {kStateGalileoE1bcCodeLock, System::kGalileo, l1, 4 * kMillisecond_ns},
      {kStateGalileoE1cSecondaryCodeLock, System::kGalileo, l1, 100 * kMillisecond_ns},
      {kStateCodeLock | kStateGalileoE1bPageSync, System::kGalileo, l1, 2 * kSecond_ns},
      {kStateCodeLock | kStateSecondaryCodeLock, System::kGalileo, l5, 100 * kMillisecond_ns},
      {kStateCodeLock | kStateBeidouD2BitSync, System::kBeidou, {'2', 'I'}, 2 * kMillisecond_ns},
      {kStateCodeLock | kStateBeidouD2SubframeSync,
       System::kBeidou,
       {'2', 'I'},
       600 * kMillisecond_ns},
      {kStateCodeLock | kStateSbasSync, System::kSbas, l1, kSecond_ns},
      {kStateCodeLock | kStateSymbolSync, System::kSbas, l1, 2 * kMillisecond_ns},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(AmbiguityPeriodNanoseconds(c.state, c.system, c.signal), c.period_ns)
        << c.state << " of " << SystemLetter(c.system);
  }
}

}  // namespace
}  // namespace lodemark
