#include "core/gnss/signal.h"

#include <gtest/gtest.h>

#include <limits>

namespace lodemark {
namespace {

struct Carrier {
  System system;
  char band;
  double frequency_mhz;
};

// RINEX 4.00 tables 9 to 16, GLONASS FDMA apart.
constexpr Carrier kCarriers[] = {
    {System::kGps, '1', 1575.42},      {System::kGps, '2', 1227.60},
    {System::kGps, '5', 1176.45},      {System::kGlonass, '4', 1600.995},
    {System::kGlonass, '6', 1248.06},  {System::kGlonass, '3', 1202.025},
    {System::kGalileo, '1', 1575.42},  {System::kGalileo, '5', 1176.45},
    {System::kGalileo, '7', 1207.140}, {System::kGalileo, '8', 1191.795},
    {System::kGalileo, '6', 1278.75},  {System::kSbas, '1', 1575.42},
    {System::kSbas, '5', 1176.45},     {System::kQzss, '1', 1575.42},
    {System::kQzss, '2', 1227.60},     {System::kQzss, '5', 1176.45},
    {System::kQzss, '6', 1278.75},     {System::kBeidou, '2', 1561.098},
    {System::kBeidou, '1', 1575.42},   {System::kBeidou, '5', 1176.45},
    {System::kBeidou, '7', 1207.140},  {System::kBeidou, '8', 1191.795},
    {System::kBeidou, '6', 1268.52},   {System::kNavic, '1', 1575.42},
    {System::kNavic, '5', 1176.45},    {System::kNavic, '9', 2492.028}};

TEST(Signal, CarriersAreThoseOfRinex) {
  for (const Carrier& carrier : kCarriers) {
    const auto frequency_hz =
        CarrierFrequency(carrier.system, carrier.band, kUnknownGlonassChannel);
    ASSERT_TRUE(frequency_hz.has_value()) << SystemLetter(carrier.system) << carrier.band;
    EXPECT_NEAR(*frequency_hz, carrier.frequency_mhz * 1e6, 1e-6);
  }
  EXPECT_FALSE(CarrierFrequency(System::kGps, '7', 0).has_value());
  EXPECT_FALSE(CarrierFrequency(System::kGlonass, '1', kUnknownGlonassChannel).has_value());
  EXPECT_NEAR(*CarrierFrequency(System::kGlonass, '1', -7), 1598.0625e6, 1e-6);
  EXPECT_NEAR(*CarrierFrequency(System::kGlonass, '2', 6), 1248.625e6, 1e-6);
}

TEST(Signal, IsRecognisedByItsCarrier) {
  for (const Carrier& carrier : kCarriers) {
    if (carrier.system == System::kGlonass && carrier.band != '3') continue;  // within FDMA
    const auto signal = SignalFromCarrier(carrier.system, carrier.frequency_mhz * 1e6 + 3e5);
    ASSERT_TRUE(signal.has_value());
    EXPECT_EQ(signal->band, carrier.band) << SystemLetter(carrier.system);
  }
  EXPECT_FALSE(SignalFromCarrier(System::kGps, 1.6e9).has_value());
  EXPECT_FALSE(SignalFromCarrier(System::kGps, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(SignalFromCarrier(System::kGps, std::numeric_limits<double>::infinity()));
}

TEST(Signal, GlonassChannelsReturnFromTheirCarriers) {
  for (int channel = -7; channel <= 6; ++channel) {
    for (const char band : {'1', '2'}) {
      const auto frequency_hz =
          CarrierFrequency(System::kGlonass, band, static_cast<std::int8_t>(channel));
      ASSERT_TRUE(frequency_hz.has_value());
      EXPECT_EQ(GlonassChannelFromCarrier(*frequency_hz), channel);
      EXPECT_EQ(SignalFromCarrier(System::kGlonass, *frequency_hz)->band, band);
    }
  }
  EXPECT_EQ(GlonassChannelFromCarrier(1575.42e6), kUnknownGlonassChannel);
  EXPECT_EQ(GlonassChannelFromCarrier(std::numeric_limits<double>::quiet_NaN()),
            kUnknownGlonassChannel);
  EXPECT_EQ(GlonassChannelFromCarrier(1e300), kUnknownGlonassChannel);
}

TEST(Signal, SatellitesReturnFromTheirNames) {
  for (int system = 0; system < kSystemCount; ++system) {
    const auto kind = static_cast<System>(system);
    EXPECT_EQ(SystemFromLetter(SystemLetter(kind)), kind);
    for (int number = 1; number <= LargestSatelliteNumber(kind); ++number) {
      const SatelliteId satellite{kind, static_cast<std::uint8_t>(number)};
      EXPECT_EQ(SatelliteFromName(SatelliteName(satellite)), satellite);
    }
  }
  EXPECT_EQ(SatelliteName({System::kGps, 7}), "G07");
  EXPECT_EQ(SatelliteFromName("E 5"), (SatelliteId{System::kGalileo, 5}));
}

TEST(Signal, RefusesWhatIsNoName) {
  for (const char* name : {"",     "G",   "G0",  "G00", "G33", "G-1", "G+1", "G1 ", "X01", "g01",
                           "G012", "R28", "E37", "C64", "J11", "I15", "S59", "G 0", "G  ", "   "}) {
    EXPECT_FALSE(SatelliteFromName(name).has_value()) << name;
  }
}

}  // namespace
}  // namespace lodemark
