// How u-blox numbers satellites and signals.
#pragma once

#include <cstdint>
#include <optional>

#include "core/gnss/signal.h"

namespace lodemark {

// gnssId of the u-blox interface description, "GNSS identifiers".
enum class UbxSystem : std::uint8_t {
  kGps = 0,
  kSbas = 1,
  kGalileo = 2,
  kBeidou = 3,
  kQzss = 5,
  kGlonass = 6,
  kNavic = 7,
};

// svId of a GLONASS satellite whose slot the receiver does not know yet.
inline constexpr std::uint8_t kUbxUnknownSlot = 255;

// By gnssId and svId ("Satellite numbering"); empty for one we have no name for.
std::optional<SatelliteId> UbxSatellite(std::uint8_t gnss_id, std::uint8_t sv_id);

// By gnssId and sigId ("Signal identifiers"); empty for one we do not know.
std::optional<SignalCode> UbxSignal(std::uint8_t gnss_id, std::uint8_t sig_id);

// By freqId, which counts from channel -7; unknown if it is none.
std::int8_t UbxGlonassChannel(std::uint8_t freq_id);

}  // namespace lodemark
