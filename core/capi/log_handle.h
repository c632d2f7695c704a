// What a lodemark_log points to.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <variant>
#include <vector>

#include "core/logs/gnss_logger.h"
#include "core/logs/logged_samples.h"
#include "core/logs/ubx.h"
#include "lodemark/lodemark.h"

struct lodemark_log {
  using Reader = std::variant<lodemark::GnssLoggerReader, lodemark::UbxReader>;

  explicit lodemark_log(Reader opened) : reader(std::move(opened)) {}

  Reader reader;
  lodemark::GnssLoggerRecord record;  // of a phone's text
  lodemark::UbxRecord ubx_record;     // of a u-blox receiver's file
  // Messages that wait for the first epoch with a GPS time.
  std::deque<lodemark::LoggedNavigationMessage> messages;
  lodemark::LoggedSamples samples;
  std::vector<lodemark::LoggedSample> ahead;  // measured after the latest epoch
  std::int64_t heard_gps_ns = 0;              // samples until then were pushed
  bool epoch_waits = false;  // the record is an epoch that found the session's queue full
  bool epoch_seen = false;
};
