// Writes what a phone's GnssLogger would have written.
#pragma once

#include <cstdint>
#include <string>

#include "core/geo/geodetic.h"
#include "core/gnss/android_measurement.h"

namespace lodemark {

// The comment lines that name the columns, of version 3.
std::string GnssLoggerHeader();

// One Raw row per measurement. utc_ms is Unix time.
void AppendRawRows(const AndroidEpoch& epoch, std::int64_t utc_ms, std::string* text);

struct FixRow {
  Geodetic place;
  double speed_mps = 0.0;
  double bearing_deg = 0.0;
  double accuracy_m = 0.0;
  double vertical_accuracy_m = 0.0;
  double speed_accuracy_mps = 0.0;
  std::int64_t utc_ms = 0;
  std::int64_t elapsed_realtime_ns = 0;
};
void AppendFixRow(const FixRow& fix, std::string* text);

// A row of an uncalibrated sensor ("UncalAccel", "UncalGyro", "UncalMag") with its biases.
struct UncalibratedRow {
  const char* kind = "";
  std::int64_t utc_ms = 0;
  std::int64_t elapsed_realtime_ns = 0;
  double values[3] = {};
  double biases[3] = {};
};
void AppendUncalibratedRow(const UncalibratedRow& row, std::string* text);

}  // namespace lodemark
