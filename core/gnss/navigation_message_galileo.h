// Galileo I/NAV pages, OS SIS ICD issue 2.1 section 4.3.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/navigation_message.h"

namespace lodemark {

// The 128 data bits of a nominal page.
using InavWord = std::array<std::uint8_t, 16>;

// From the 228 bits of an even and an odd half page, without synchronisation and tail, in 29
// bytes. *verdict says why there is no word.
std::optional<InavWord> CheckInavPage(std::span<const std::uint8_t> bytes, MessageVerdict* verdict);

// One satellite's words on their way to a set.
class InavAssembly {
 public:
  MessageVerdict Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                      std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

 private:
  void GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                     std::vector<NavigationRecord>* records);

  std::array<std::optional<InavWord>, 5> words_;  // types 1 to 5
  std::array<InavWord, 5> given_ = {};            // the set given last, without its time
  InavWord given_ionosphere_ = {};
};

}  // namespace lodemark
