// What a lodemark_log points to.
#pragma once

#include <deque>
#include <utility>

#include "core/logs/gnss_logger.h"
#include "lodemark/lodemark.h"

struct lodemark_log {
  explicit lodemark_log(lodemark::GnssLoggerReader opened) : reader(std::move(opened)) {}

  lodemark::GnssLoggerReader reader;
  lodemark::GnssLoggerRecord record;
  // Messages that wait for the first epoch with a GPS time.
  std::deque<lodemark::LoggedNavigationMessage> messages;
  bool epoch_waits = false;  // record is an epoch that found the session's queue full
  bool epoch_seen = false;
};
