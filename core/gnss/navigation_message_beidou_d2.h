// BeiDou D2 navigation messages of geostationary satellites, BDS-SIS-ICD-B1I version 3.0 section
// 5.3.
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

// One satellite's pages of subframe 1 on their way to a set.
class D2Assembly {
 public:
  static constexpr std::size_t kPages = 10;
  using Pages = std::array<std::optional<BeidouSubframe>, kPages>;

  MessageVerdict Push(SatelliteId satellite, std::span<const std::uint8_t> bytes,
                      std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

 private:
  // Whether all pages are there and were sent one after the other.
  bool IsComplete() const;
  void GiveEphemeris(SatelliteId satellite, std::int64_t received_gps_ns,
                     std::vector<NavigationRecord>* records);

  Pages pages_;
  BeidouSets sets_;
};

}  // namespace lodemark
