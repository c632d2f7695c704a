#include "core/gnss/signal.h"

#include <array>
#include <charconv>
#include <cmath>

namespace lodemark {
namespace {

constexpr double kMegahertz = 1e6;
constexpr double kGlonassL1_hz = 1602.0 * kMegahertz;
constexpr double kGlonassL1Step_hz = 0.5625 * kMegahertz;
constexpr double kGlonassL2_hz = 1246.0 * kMegahertz;
constexpr double kGlonassL2Step_hz = 0.4375 * kMegahertz;

struct Band {
  System system;
  char band;
  double frequency_mhz;
  char usual_attribute;
};

// RINEX 4.00 tables 9 to 16. FDMA bands stand with their centre.
constexpr std::array<Band, 28> kBands = {{
    {System::kGps, '1', 1575.42, 'C'},      {System::kGps, '2', 1227.60, 'L'},
    {System::kGps, '5', 1176.45, 'Q'},      {System::kGlonass, '1', 1602.0, 'C'},
    {System::kGlonass, '2', 1246.0, 'C'},   {System::kGlonass, '3', 1202.025, 'Q'},
    {System::kGlonass, '4', 1600.995, 'A'}, {System::kGlonass, '6', 1248.06, 'A'},
    {System::kGalileo, '1', 1575.42, 'C'},  {System::kGalileo, '5', 1176.45, 'Q'},
    {System::kGalileo, '7', 1207.14, 'Q'},  {System::kGalileo, '8', 1191.795, 'Q'},
    {System::kGalileo, '6', 1278.75, 'C'},  {System::kBeidou, '1', 1575.42, 'P'},
    {System::kBeidou, '2', 1561.098, 'I'},  {System::kBeidou, '5', 1176.45, 'P'},
    {System::kBeidou, '6', 1268.52, 'I'},   {System::kBeidou, '7', 1207.14, 'I'},
    {System::kBeidou, '8', 1191.795, 'P'},  {System::kQzss, '1', 1575.42, 'C'},
    {System::kQzss, '2', 1227.60, 'L'},     {System::kQzss, '5', 1176.45, 'Q'},
    {System::kQzss, '6', 1278.75, 'L'},     {System::kNavic, '1', 1575.42, 'P'},
    {System::kNavic, '5', 1176.45, 'A'},    {System::kNavic, '9', 2492.028, 'A'},
    {System::kSbas, '1', 1575.42, 'C'},     {System::kSbas, '5', 1176.45, 'I'},
}};

bool IsFdma(System system, char band) {
  return system == System::kGlonass && (band == '1' || band == '2');
}

}  // namespace

char SystemLetter(System system) {
  constexpr std::array<char, kSystemCount> kLetters = {'G', 'R', 'E', 'C', 'J', 'I', 'S'};
  return kLetters[static_cast<std::size_t>(system)];
}

std::optional<System> SystemFromLetter(char letter) {
  switch (letter) {
    case 'G':
      return System::kGps;
    case 'R':
      return System::kGlonass;
    case 'E':
      return System::kGalileo;
    case 'C':
      return System::kBeidou;
    case 'J':
      return System::kQzss;
    case 'I':
      return System::kNavic;
    case 'S':
      return System::kSbas;
    default:
      return std::nullopt;
  }
}

int LargestSatelliteNumber(System system) {
  constexpr std::array<int, kSystemCount> kLargest = {32, 27, 36, 63, 10, 14, 58};
  return kLargest[static_cast<std::size_t>(system)];
}

std::string SatelliteName(SatelliteId satellite) {
  std::string name(3, SystemLetter(satellite.system));
  name[1] = static_cast<char>('0' + satellite.number / 10 % 10);
  name[2] = static_cast<char>('0' + satellite.number % 10);
  return name;
}

std::optional<SatelliteId> SatelliteFromName(std::string_view name) {
  if (name.size() != 3) return std::nullopt;
  const std::optional<System> system = SystemFromLetter(name[0]);
  if (!system) return std::nullopt;
  const char* first = name[1] == ' ' ? name.data() + 2 : name.data() + 1;
  int number = 0;
  const auto [end, error] = std::from_chars(first, name.data() + 3, number);
  if (error != std::errc() || end != name.data() + 3) return std::nullopt;
  if (number < 1 || number > LargestSatelliteNumber(*system)) return std::nullopt;
  return SatelliteId{*system, static_cast<std::uint8_t>(number)};
}

std::optional<double> CarrierFrequency(System system, char band, std::int8_t glonass_channel) {
  if (IsFdma(system, band)) {
    if (glonass_channel == kUnknownGlonassChannel) return std::nullopt;
    return band == '1' ? kGlonassL1_hz + glonass_channel * kGlonassL1Step_hz
                       : kGlonassL2_hz + glonass_channel * kGlonassL2Step_hz;
  }
  for (const Band& entry : kBands) {
    if (entry.system == system && entry.band == band) return entry.frequency_mhz * kMegahertz;
  }
  return std::nullopt;
}

std::optional<SignalCode> SignalFromCarrier(System system, double frequency_hz) {
  for (const Band& entry : kBands) {
    if (entry.system != system) continue;
    const double tolerance_hz = IsFdma(system, entry.band) ? 8 * kMegahertz : kMegahertz;
    if (std::abs(frequency_hz - entry.frequency_mhz * kMegahertz) <= tolerance_hz) {
      return SignalCode{entry.band, entry.usual_attribute};
    }
  }
  return std::nullopt;
}

std::int8_t GlonassChannelFromCarrier(double frequency_hz) {
  const bool upper = frequency_hz > 1.4e9;
  const double channel = upper ? (frequency_hz - kGlonassL1_hz) / kGlonassL1Step_hz
                               : (frequency_hz - kGlonassL2_hz) / kGlonassL2Step_hz;
  const double rounded = std::round(channel);
  if (!(rounded >= -7.0 && rounded <= 6.0)) return kUnknownGlonassChannel;
  return static_cast<std::int8_t>(rounded);
}

}  // namespace lodemark
