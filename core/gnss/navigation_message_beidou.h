// BeiDou D1 navigation messages, BDS-SIS-ICD-B1I version 3.0 section 5.2.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/navigation_message.h"
#include "core/gnss/navigation_message_beidou_frame.h"

namespace lodemark {

// One satellite's subframes on their way to a set.
class D1Assembly {
 public:
  MessageVerdict Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                      std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

 private:
  void GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                     std::vector<NavigationRecord>* records);

  std::array<std::optional<BeidouSubframe>, 3> subframes_;
  BeidouSets sets_;
};

}  // namespace lodemark
