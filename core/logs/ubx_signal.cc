#include "core/logs/ubx_signal.h"

#include <array>

namespace lodemark {
namespace {

struct Signal {
  UbxSystem system;
  std::uint8_t sig_id;
  SignalCode code;
};

// u-blox interface description, table "Signal identifier"; codes of RINEX 4.00 tables 9 to 16.
constexpr std::array<Signal, 34> kSignals = {{
    {UbxSystem::kGps, 0, {'1', 'C'}},     {UbxSystem::kGps, 3, {'2', 'L'}},
    {UbxSystem::kGps, 4, {'2', 'S'}},     {UbxSystem::kGps, 6, {'5', 'I'}},
    {UbxSystem::kGps, 7, {'5', 'Q'}},     {UbxSystem::kSbas, 0, {'1', 'C'}},
    {UbxSystem::kGalileo, 0, {'1', 'C'}}, {UbxSystem::kGalileo, 1, {'1', 'B'}},
    {UbxSystem::kGalileo, 3, {'5', 'I'}}, {UbxSystem::kGalileo, 4, {'5', 'Q'}},
    {UbxSystem::kGalileo, 5, {'7', 'I'}}, {UbxSystem::kGalileo, 6, {'7', 'Q'}},
    {UbxSystem::kGalileo, 8, {'6', 'B'}}, {UbxSystem::kGalileo, 9, {'6', 'C'}},
    {UbxSystem::kBeidou, 0, {'2', 'I'}},  {UbxSystem::kBeidou, 1, {'2', 'I'}},
    {UbxSystem::kBeidou, 2, {'7', 'I'}},  {UbxSystem::kBeidou, 3, {'7', 'I'}},
    {UbxSystem::kBeidou, 4, {'6', 'I'}},  {UbxSystem::kBeidou, 5, {'1', 'P'}},
    {UbxSystem::kBeidou, 6, {'1', 'D'}},  {UbxSystem::kBeidou, 7, {'5', 'P'}},
    {UbxSystem::kBeidou, 8, {'5', 'D'}},  {UbxSystem::kBeidou, 10, {'6', 'I'}},
    {UbxSystem::kQzss, 0, {'1', 'C'}},    {UbxSystem::kQzss, 1, {'1', 'Z'}},
    {UbxSystem::kQzss, 4, {'2', 'S'}},    {UbxSystem::kQzss, 5, {'2', 'L'}},
    {UbxSystem::kQzss, 8, {'5', 'I'}},    {UbxSystem::kQzss, 9, {'5', 'Q'}},
    {UbxSystem::kQzss, 12, {'1', 'E'}},   {UbxSystem::kGlonass, 0, {'1', 'C'}},
    {UbxSystem::kGlonass, 2, {'2', 'C'}}, {UbxSystem::kNavic, 0, {'5', 'A'}},
}};

std::optional<System> SystemOf(std::uint8_t gnss_id) {
  switch (static_cast<UbxSystem>(gnss_id)) {
    case UbxSystem::kGps:
      return System::kGps;
    case UbxSystem::kSbas:
      return System::kSbas;
    case UbxSystem::kGalileo:
      return System::kGalileo;
    case UbxSystem::kBeidou:
      return System::kBeidou;
    case UbxSystem::kQzss:
      return System::kQzss;
    case UbxSystem::kGlonass:
      return System::kGlonass;
    case UbxSystem::kNavic:
      return System::kNavic;
  }
  return std::nullopt;
}

}  // namespace

std::optional<SatelliteId> UbxSatellite(std::uint8_t gnss_id, std::uint8_t sv_id) {
  const std::optional<System> system = SystemOf(gnss_id);
  if (!system) return std::nullopt;
  const int number = *system == System::kSbas ? sv_id - 100 : sv_id;
  if (number < 1 || number > LargestSatelliteNumber(*system)) return std::nullopt;
  return SatelliteId{*system, static_cast<std::uint8_t>(number)};
}

std::optional<SignalCode> UbxSignal(std::uint8_t gnss_id, std::uint8_t sig_id) {
  for (const Signal& signal : kSignals) {
    if (static_cast<std::uint8_t>(signal.system) == gnss_id && signal.sig_id == sig_id) {
      return signal.code;
    }
  }
  return std::nullopt;
}

std::int8_t UbxGlonassChannel(std::uint8_t freq_id) {
  return freq_id <= 13 ? static_cast<std::int8_t>(freq_id - 7) : kUnknownGlonassChannel;
}

}  // namespace lodemark
