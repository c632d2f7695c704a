// Broadcast messages as Android's GnssNavigationMessage delivers them, put together to ephemerides.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/gnss/ephemeris.h"

namespace lodemark {

// GnssNavigationMessage.TYPE_*
enum class AndroidMessageType : std::int32_t {
  kGpsL1Ca = 0x0101,
  kGlonassL1Ca = 0x0301,
  kQzssL1Ca = 0x0401,
  kBeidouD1 = 0x0501,
  kBeidouD2 = 0x0502,
  kGalileoInav = 0x0601,
};

// What became of a message.
enum class MessageVerdict : std::uint8_t {
  kTaken,
  kUnknownType,
  kUnknownSatellite,
  kUnknownTime,  // the time of reception is before 1980 or after 2100
  kMalformed,    // too short, or not beginning as the message must
  kBadParity,
  kUnused,  // sound, and of a kind that is not needed here
};

// Holds what every satellite sent until a set is complete. The numbers of message and submessage
// that Android gives beside the bytes differ between phones; the bytes say the same, and are what
// is used.
class NavigationMessageDecoder {
 public:
  NavigationMessageDecoder();
  ~NavigationMessageDecoder();
  NavigationMessageDecoder(NavigationMessageDecoder&&) noexcept;
  NavigationMessageDecoder& operator=(NavigationMessageDecoder&&) noexcept;

  // Appends to *records what the message completed: an ephemeris, ionosphere coefficients, time
  // offsets, leap seconds. A set that was given before is not given again. received_gps_ns settles
  // what the message counts modulo weeks or days; half a day of error is no harm.
  MessageVerdict Push(std::int32_t type, std::int32_t svid, std::span<const std::uint8_t> bytes,
                      std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
