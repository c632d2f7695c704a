// BeiDou D1 navigation messages, BDS-SIS-ICD-B1I version 3.0 section 5.2.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/navigation_message.h"

namespace lodemark {

// The 300 bits of a subframe, parity included, whose fields the ICD numbers from 1.
using BeidouSubframe = std::array<std::uint8_t, 38>;

// From ten words of 30 bits, each right-aligned in four bytes. Empty if the BCH code of any word
// finds an error.
std::optional<BeidouSubframe> CheckBeidouSubframe(std::span<const std::uint8_t> bytes);

// One satellite's subframes on their way to a set.
class D1Assembly {
 public:
  MessageVerdict Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                      std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

 private:
  void GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                     std::vector<NavigationRecord>* records);

  std::array<std::optional<BeidouSubframe>, 3> subframes_;
  std::int64_t given_toe_gps_ns_ = 0;
  std::int64_t given_toc_gps_ns_ = 0;
  std::int32_t given_health_ = -1;
};

}  // namespace lodemark
