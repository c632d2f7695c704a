// GPS and QZSS legacy navigation messages (LNAV), IS-GPS-200N section 20.3.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/navigation_message.h"

namespace lodemark {

// The 24 data bits of each word of a subframe, parity checked and removed.
using LnavSubframe = std::array<std::uint32_t, 10>;

// From ten words of 30 bits, each right-aligned in four bytes. Accepted are words as broadcast,
// words whose data the receiver has freed from the inversion by the bit before them, and words
// that it has inverted back together with their parity (Samsung's Galaxy S8 does). Empty if the
// parity fits none of these.
std::optional<LnavSubframe> CheckLnavSubframe(std::span<const std::uint8_t> bytes);

// One satellite's subframes on their way to a set.
class LnavAssembly {
 public:
  MessageVerdict Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                      std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

 private:
  void GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                     std::vector<NavigationRecord>* records);
  void GiveIonosphereAndUtc(SatelliteId satellite, const LnavSubframe& subframe,
                            std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

  std::array<std::optional<LnavSubframe>, 3> subframes_;
  std::array<LnavSubframe, 3> given_ = {};  // the set given last, without its time
  LnavSubframe given_page_ = {};
};

}  // namespace lodemark
