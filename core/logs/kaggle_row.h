// One row of a Kaggle measurement file.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/logs/csv_columns.h"
#include "core/logs/kaggle_gnss.h"
#include "core/logs/raw_row.h"

namespace lodemark {

enum KaggleField : int {
  kKaggleMessageType = kRawFieldCount,
  kKaggleEpochMillis,  // 2021 only
  kKaggleArrivalTime,
  kKaggleReceivedSvTime,  // as GPS time
  kKagglePseudorange,
  kKagglePseudorangeSigma,
  kKaggleSignalType,
  kKaggleSatelliteX,
  kKaggleSatelliteY,
  kKaggleSatelliteZ,
  kKaggleSatelliteVelocityX,
  kKaggleSatelliteVelocityY,
  kKaggleSatelliteVelocityZ,
  kKaggleClockBias,
  kKaggleClockDrift,
  kKaggleInterSignalBias,
  kKaggleIonosphere,
  kKaggleTroposphere,
  kKaggleElevation,
  kKaggleAzimuth,
  kKaggleReceiverX,
  kKaggleReceiverY,
  kKaggleReceiverZ,
};

std::span<const ColumnName> KaggleColumnNames();

// The time of transmission as GPS time. Empty if the row does not give it.
struct TransmitTime {
  std::optional<std::int64_t> time_gps_ns;
  bool rounded = false;
};

struct KaggleRow {
  AndroidMeasurement measurement;
  KaggleDerived derived;
  TransmitTime transmission;
};

// Empty, and the row counted as skipped, if it has no measurement.
std::optional<KaggleRow> ReadDeviceGnssRow(const CsvCells& cells, const CsvRow& row);
std::optional<KaggleRow> ReadDerived2021Row(const CsvCells& cells, const CsvRow& row);

std::optional<Eigen::Vector3d> ReadReceiverPosition(const CsvCells& cells);

// Whether a time in nanoseconds since 1980 was written with no more digits than a spreadsheet or a
// floating-point number keeps. Never of times of 15 digits, such as those of a week.
bool LostDigits(std::string_view text);

}  // namespace lodemark
