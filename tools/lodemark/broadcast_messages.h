// Messages between a log's epochs, put together to orbits.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/navigation_message.h"
#include "core/gnss/observation.h"
#include "core/logs/gnss_logger.h"

namespace lodemark {

class BroadcastMessages {
 public:
  // A message is as old as the epoch after it, to a second or two; of too many before the first
  // epoch the later ones are left out.
  void Add(const LoggedNavigationMessage& message);
  void Add(const ObservationEpoch& epoch);
  // What came after the last epoch is as old as that.
  void Finish();

  // GLONASS satellites have the channel that they were observed on.
  std::span<const NavigationRecord> records() const { return records_; }

 private:
  void Decode(std::int64_t received_gps_ns);

  NavigationMessageDecoder decoder_;
  std::vector<LoggedNavigationMessage> waiting_;
  std::vector<NavigationRecord> records_;
  std::map<std::uint8_t, std::int8_t> glonass_channels_;  // by slot
  std::int64_t last_gps_ns_ = 0;
};

// All that satellites broadcast while a u-blox file was recorded.
Result<std::vector<NavigationRecord>> ReadUbxBroadcast(const std::string& path);

}  // namespace lodemark
