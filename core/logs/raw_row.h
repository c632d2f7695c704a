// A "Raw" row: the columns that GnssLogger texts and Kaggle's device_gnss.csv share.
#pragma once

#include <optional>
#include <span>

#include "core/gnss/android_measurement.h"
#include "core/logs/csv_columns.h"

namespace lodemark {

// The fields of a Raw row that have a place in AndroidClock or AndroidMeasurement.
enum RawField : int {
  kRawTimeNanos,
  kRawLeapSecond,
  kRawTimeUncertaintyNanos,
  kRawFullBiasNanos,
  kRawBiasNanos,
  kRawBiasUncertaintyNanos,
  kRawDriftNanosPerSecond,
  kRawDriftUncertaintyNanosPerSecond,
  kRawHardwareClockDiscontinuityCount,
  kRawSvid,
  kRawTimeOffsetNanos,
  kRawState,
  kRawReceivedSvTimeNanos,
  kRawReceivedSvTimeUncertaintyNanos,
  kRawCn0DbHz,
  kRawPseudorangeRateMetersPerSecond,
  kRawPseudorangeRateUncertaintyMetersPerSecond,
  kRawAccumulatedDeltaRangeState,
  kRawAccumulatedDeltaRangeMeters,
  kRawAccumulatedDeltaRangeUncertaintyMeters,
  kRawCarrierFrequencyHz,
  kRawMultipathIndicator,
  kRawSnrInDb,
  kRawConstellationType,
  kRawAgcDb,
  kRawBasebandCn0DbHz,
  kRawFullInterSignalBiasNanos,
  kRawSatelliteInterSignalBiasNanos,
  kRawCodeType,
  kRawChipsetElapsedRealtimeNanos,
  kRawElapsedRealtimeMillis,
  kRawUtcTimeMillis,
  kRawFieldCount,
};

std::span<const ColumnName> RawColumnNames();

// The header of logs that carry none, by the number of columns of their rows.
std::string_view DefaultRawHeader(int columns);

// What makes two rows belong to the same measurement event.
struct RawEventKey {
  std::int64_t time_ns = 0;
  std::int64_t full_bias_ns = 0;  // 0 if missing
  std::int32_t discontinuity_count = 0;

  bool operator==(const RawEventKey&) const = default;
};

// Empty, and the row counted as skipped, without a plausible TimeNanos.
std::optional<RawEventKey> ReadRawEventKey(const CsvCells& cells);

AndroidClock ReadRawClock(const CsvCells& cells, const RawEventKey& key);

// Empty, and the row counted as skipped, unless satellite, state and time of transmission are
// there and plausible. The svid stays as logged: GLONASS slot, or frequency channel + 100.
std::optional<AndroidMeasurement> ReadRawMeasurement(const CsvCells& cells, const CsvRow& row);

}  // namespace lodemark
