// Names of satellites and of the signals they send, after RINEX 4.00 tables 9 to 18.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lodemark {

enum class System : std::uint8_t { kGps, kGlonass, kGalileo, kBeidou, kQzss, kNavic, kSbas };
inline constexpr int kSystemCount = 7;

// Numbered as RINEX does: GPS, Galileo, BeiDou, NavIC by PRN, GLONASS by slot, QZSS by PRN - 192
// (J01 is 1), SBAS by PRN - 100.
struct SatelliteId {
  System system = System::kGps;
  std::uint8_t number = 0;

  auto operator<=>(const SatelliteId&) const = default;
};

// RINEX letter of a system: G R E C J I S.
char SystemLetter(System system);
std::optional<System> SystemFromLetter(char letter);

// "G07", and back. Accepts a blank in place of the leading zero.
std::string SatelliteName(SatelliteId satellite);
std::optional<SatelliteId> SatelliteFromName(std::string_view name);

// Largest number a satellite of the system can have (GPS 32, GLONASS 27, ...).
int LargestSatelliteNumber(System system);

// Band and attribute of a RINEX 3 and 4 observation code without the type letter: {'1', 'C'} is
// the GPS C/A code. Attribute ' ' is unknown.
struct SignalCode {
  char band = '1';
  char attribute = ' ';

  auto operator<=>(const SignalCode&) const = default;
};

// GLONASS FDMA frequency channel that is not known; -7..6 are channels.
inline constexpr std::int8_t kUnknownGlonassChannel = 127;

// Carrier frequency of a band. Empty for a band the system does not have, and for GLONASS FDMA
// without a channel. BeiDou band 2 is B1I (1561.098 MHz) and band 1 is B1C, as in RINEX 3.03 on.
std::optional<double> CarrierFrequency(System system, char band, std::int8_t glonass_channel);

// The signal nearest to a carrier frequency given in Hz, with the attribute phones usually track
// (1C, 5Q, ...); empty if none lies within 1 MHz (GLONASS: within the FDMA band).
std::optional<SignalCode> SignalFromCarrier(System system, double frequency_hz);

// The GLONASS channel whose L1 or L2 carrier is nearest, or kUnknownGlonassChannel.
std::int8_t GlonassChannelFromCarrier(double frequency_hz);

}  // namespace lodemark
