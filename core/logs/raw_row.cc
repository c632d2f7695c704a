#include "core/logs/raw_row.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

#include "core/base/units.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

// Keeps sums and differences of two times inside 64 bits: 146 years.
constexpr std::int64_t kLargestTime_ns = 4'600'000'000'000'000'000;

constexpr std::int32_t kLargestInt = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kLargestSvid = 255;
constexpr std::int64_t kLargestElapsed_ms = 100'000'000'000;  // 3 years; a UTC stamp is larger

// Ranges outside which a value says nothing. They only keep nonsense out: what is usable is
// decided where the measurement is used.
constexpr double kLargestBias_ns = 1e9;
constexpr double kLargestUncertainty_ns = 1e18;      // chips report 6e9 before the first fix
constexpr double kLargestDrift_nsps = 1e6;           // 1000 parts per million
constexpr double kLargestRate_mps = 50'000.0;        // orbit and a drift of 150 parts per million
constexpr double kLargestRateUncertainty_mps = 1e9;  // the speed of light means "unknown"
constexpr double kLargestDeltaRange_m = 1e12;        // years of drift
constexpr double kLargestDeltaRangeUncertainty_m = 1e6;
constexpr double kLargestCn0_dbhz = 80.0;
constexpr double kLowestCarrier_hz = 1e8;
constexpr double kHighestCarrier_hz = 1e10;
constexpr double kLargestGain_db = 200.0;

constexpr ColumnName kNames[] = {
    {"TimeNanos", kRawTimeNanos},
    {"LeapSecond", kRawLeapSecond},
    {"TimeUncertaintyNanos", kRawTimeUncertaintyNanos},
    {"FullBiasNanos", kRawFullBiasNanos},
    {"BiasNanos", kRawBiasNanos},
    {"BiasUncertaintyNanos", kRawBiasUncertaintyNanos},
    {"DriftNanosPerSecond", kRawDriftNanosPerSecond},
    {"DriftUncertaintyNanosPerSecond", kRawDriftUncertaintyNanosPerSecond},
    {"HardwareClockDiscontinuityCount", kRawHardwareClockDiscontinuityCount},
    {"Svid", kRawSvid},
    {"TimeOffsetNanos", kRawTimeOffsetNanos},
    {"State", kRawState},
    {"ReceivedSvTimeNanos", kRawReceivedSvTimeNanos},
    {"ReceivedSvTimeUncertaintyNanos", kRawReceivedSvTimeUncertaintyNanos},
    {"Cn0DbHz", kRawCn0DbHz},
    {"PseudorangeRateMetersPerSecond", kRawPseudorangeRateMetersPerSecond},
    {"PseudorangeRateUncertaintyMetersPerSecond", kRawPseudorangeRateUncertaintyMetersPerSecond},
    {"AccumulatedDeltaRangeState", kRawAccumulatedDeltaRangeState},
    {"AccumulatedDeltaRangeMeters", kRawAccumulatedDeltaRangeMeters},
    {"AccumulatedDeltaRangeUncertaintyMeters", kRawAccumulatedDeltaRangeUncertaintyMeters},
    {"CarrierFrequencyHz", kRawCarrierFrequencyHz},
    {"MultipathIndicator", kRawMultipathIndicator},
    {"SnrInDb", kRawSnrInDb},
    {"ConstellationType", kRawConstellationType},
    {"AgcDb", kRawAgcDb},
    {"BasebandCn0DbHz", kRawBasebandCn0DbHz},
    {"FullInterSignalBiasNanos", kRawFullInterSignalBiasNanos},
    {"SatelliteInterSignalBiasNanos", kRawSatelliteInterSignalBiasNanos},
    {"CodeType", kRawCodeType},
    {"ChipsetElapsedRealtimeNanos", kRawChipsetElapsedRealtimeNanos},
    {"ElapsedRealtimeMillis", kRawElapsedRealtimeMillis},
    {"utcTimeMillis", kRawUtcTimeMillis},
};

// Column orders of v1.4 and of v3.0 on, whose beginning all versions share.
constexpr std::string_view kHeader14 =
    "Raw,ElapsedRealtimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,FullBiasNanos,BiasNanos,"
    "BiasUncertaintyNanos,DriftNanosPerSecond,DriftUncertaintyNanosPerSecond,"
    "HardwareClockDiscontinuityCount,Svid,TimeOffsetNanos,State,ReceivedSvTimeNanos,"
    "ReceivedSvTimeUncertaintyNanos,Cn0DbHz,PseudorangeRateMetersPerSecond,"
    "PseudorangeRateUncertaintyMetersPerSecond,AccumulatedDeltaRangeState,"
    "AccumulatedDeltaRangeMeters,AccumulatedDeltaRangeUncertaintyMeters,CarrierFrequencyHz,"
    "CarrierCycles,CarrierPhase,CarrierPhaseUncertainty,MultipathIndicator,SnrInDb,"
    "ConstellationType";
constexpr std::string_view kHeader30 =
    "Raw,utcTimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,FullBiasNanos,BiasNanos,"
    "BiasUncertaintyNanos,DriftNanosPerSecond,DriftUncertaintyNanosPerSecond,"
    "HardwareClockDiscontinuityCount,Svid,TimeOffsetNanos,State,ReceivedSvTimeNanos,"
    "ReceivedSvTimeUncertaintyNanos,Cn0DbHz,PseudorangeRateMetersPerSecond,"
    "PseudorangeRateUncertaintyMetersPerSecond,AccumulatedDeltaRangeState,"
    "AccumulatedDeltaRangeMeters,AccumulatedDeltaRangeUncertaintyMeters,CarrierFrequencyHz,"
    "CarrierCycles,CarrierPhase,CarrierPhaseUncertainty,MultipathIndicator,SnrInDb,"
    "ConstellationType,AgcDb,BasebandCn0DbHz,FullInterSignalBiasNanos,"
    "FullInterSignalBiasUncertaintyNanos,SatelliteInterSignalBiasNanos,"
    "SatelliteInterSignalBiasUncertaintyNanos,CodeType,ChipsetElapsedRealtimeNanos";
constexpr int kColumns30 = 37;

// Puts a value where it belongs and marks it present.
template <typename T>
void Set(const std::optional<T>& value, std::uint32_t field, T* place, std::uint32_t* present) {
  if (!value) return;
  *place = *value;
  *present |= field;
}

void ReadCodeType(std::string_view text, AndroidMeasurement* measurement) {
  text = TrimSpaces(text);
  const auto is_letter = [](char c) { return c >= 'A' && c <= 'Z'; };
  if (text.empty() || text.size() >= std::size(measurement->code_type)) return;
  if (text == "UNKNOWN" || !std::all_of(text.begin(), text.end(), is_letter)) return;
  std::copy(text.begin(), text.end(), std::begin(measurement->code_type));
  measurement->present |= kMeasurementHasCodeType;
}

}  // namespace

std::span<const ColumnName> RawColumnNames() { return kNames; }

std::string_view DefaultRawHeader(int columns) {
  return columns < kColumns30 ? kHeader14 : kHeader30;
}

std::optional<RawEventKey> ReadRawEventKey(const CsvCells& cells) {
  const auto time_ns = cells.RequiredInteger(kRawTimeNanos, 0, kLargestTime_ns);
  if (!time_ns) return std::nullopt;
  RawEventKey key;
  key.time_ns = *time_ns;
  key.full_bias_ns =
      cells.Integer(kRawFullBiasNanos, -kLargestTime_ns, kLargestTime_ns).value_or(0);
  key.discontinuity_count = static_cast<std::int32_t>(
      cells.Integer(kRawHardwareClockDiscontinuityCount, 0, kLargestInt).value_or(0));
  return key;
}

AndroidClock ReadRawClock(const CsvCells& cells, const RawEventKey& key) {
  AndroidClock clock;
  clock.time_ns = key.time_ns;
  clock.full_bias_ns = key.full_bias_ns;
  if (key.full_bias_ns != 0) clock.present |= kClockHasFullBias;
  clock.hardware_clock_discontinuity_count = key.discontinuity_count;

  if (const auto leap_second = cells.Integer(kRawLeapSecond, 0, 100)) {
    clock.leap_second = static_cast<std::int32_t>(*leap_second);
    clock.present |= kClockHasLeapSecond;
  }
  Set(cells.Double(kRawTimeUncertaintyNanos, 0.0, kLargestUncertainty_ns), kClockHasTimeUncertainty,
      &clock.time_uncertainty_ns, &clock.present);
  Set(cells.Double(kRawBiasNanos, -kLargestBias_ns, kLargestBias_ns), kClockHasBias, &clock.bias_ns,
      &clock.present);
  Set(cells.Double(kRawBiasUncertaintyNanos, 0.0, kLargestUncertainty_ns), kClockHasBiasUncertainty,
      &clock.bias_uncertainty_ns, &clock.present);
  Set(cells.Double(kRawDriftNanosPerSecond, -kLargestDrift_nsps, kLargestDrift_nsps),
      kClockHasDrift, &clock.drift_nsps, &clock.present);
  Set(cells.Double(kRawDriftUncertaintyNanosPerSecond, 0.0, kLargestUncertainty_ns),
      kClockHasDriftUncertainty, &clock.drift_uncertainty_nsps, &clock.present);

  // The stamp of the chipset if it has one (0 is none), else when the logger wrote the row.
  if (const auto elapsed_ns = cells.Integer(kRawChipsetElapsedRealtimeNanos, 0, kLargestTime_ns)) {
    clock.elapsed_realtime_ns = *elapsed_ns;
  }
  if (clock.elapsed_realtime_ns == 0) {
    clock.elapsed_realtime_ns =
        cells.Integer(kRawElapsedRealtimeMillis, 0, kLargestElapsed_ms).value_or(0) *
        kMillisecond_ns;
  }
  if (clock.elapsed_realtime_ns != 0) clock.present |= kClockHasElapsedRealtime;
  return clock;
}

std::optional<AndroidMeasurement> ReadRawMeasurement(const CsvCells& cells, const CsvRow& row) {
  const auto svid = cells.RequiredInteger(kRawSvid, 1, kLargestSvid);
  if (!svid) return std::nullopt;
  const auto constellation = cells.RequiredInteger(kRawConstellationType, 0, 255);
  if (!constellation) return std::nullopt;
  const auto state = cells.RequiredInteger(kRawState, 0, kLargestInt);
  if (!state) return std::nullopt;
  const auto received_ns =
      cells.RequiredInteger(kRawReceivedSvTimeNanos, -kLargestTime_ns, kLargestTime_ns);
  if (!received_ns) return std::nullopt;

  AndroidMeasurement m;
  if (!row[kRawTimeOffsetNanos].empty()) {  // a value we cannot read is not no offset
    const auto offset_ns =
        cells.RequiredDouble(kRawTimeOffsetNanos, -kLargestBias_ns, kLargestBias_ns);
    if (!offset_ns) return std::nullopt;
    m.time_offset_ns = *offset_ns;
  }
  m.svid = static_cast<std::int32_t>(*svid);
  m.constellation_type = static_cast<std::int32_t>(*constellation);
  m.state = static_cast<std::int32_t>(*state);
  m.received_sv_time_ns = *received_ns;
  Set(cells.Integer(kRawReceivedSvTimeUncertaintyNanos, 0,
                    std::numeric_limits<std::int64_t>::max()),
      kMeasurementHasReceivedTimeUncertainty, &m.received_sv_time_uncertainty_ns, &m.present);
  Set(cells.Double(kRawCn0DbHz, 0.0, kLargestCn0_dbhz), kMeasurementHasCn0, &m.cn0_dbhz,
      &m.present);
  Set(cells.Double(kRawBasebandCn0DbHz, 0.0, kLargestCn0_dbhz), kMeasurementHasBasebandCn0,
      &m.baseband_cn0_dbhz, &m.present);
  Set(cells.Double(kRawPseudorangeRateMetersPerSecond, -kLargestRate_mps, kLargestRate_mps),
      kMeasurementHasRangeRate, &m.pseudorange_rate_mps, &m.present);
  Set(cells.Double(kRawPseudorangeRateUncertaintyMetersPerSecond, 0.0, kLargestRateUncertainty_mps),
      kMeasurementHasRangeRateUncertainty, &m.pseudorange_rate_uncertainty_mps, &m.present);

  const auto delta_range_state = cells.Integer(kRawAccumulatedDeltaRangeState, 0, kLargestInt);
  m.accumulated_delta_range_state = static_cast<std::int32_t>(delta_range_state.value_or(0));
  const auto delta_range_m =
      cells.Double(kRawAccumulatedDeltaRangeMeters, -kLargestDeltaRange_m, kLargestDeltaRange_m);
  if (delta_range_state) {
    Set(delta_range_m, kMeasurementHasAccumulatedDeltaRange, &m.accumulated_delta_range_m,
        &m.present);
  }
  m.accumulated_delta_range_uncertainty_m =
      cells.Double(kRawAccumulatedDeltaRangeUncertaintyMeters, 0.0, kLargestDeltaRangeUncertainty_m)
          .value_or(0.0);

  Set(cells.Double(kRawCarrierFrequencyHz, kLowestCarrier_hz, kHighestCarrier_hz),
      kMeasurementHasCarrierFrequency, &m.carrier_frequency_hz, &m.present);
  m.multipath_indicator =
      static_cast<std::int32_t>(cells.Integer(kRawMultipathIndicator, 0, 2).value_or(0));
  Set(cells.Double(kRawSnrInDb, -kLargestGain_db, kLargestGain_db), kMeasurementHasSnr, &m.snr_db,
      &m.present);
  Set(cells.Double(kRawAgcDb, -kLargestGain_db, kLargestGain_db), kMeasurementHasAgc, &m.agc_db,
      &m.present);
  Set(cells.Double(kRawFullInterSignalBiasNanos, -kLargestBias_ns, kLargestBias_ns),
      kMeasurementHasFullInterSignalBias, &m.full_inter_signal_bias_ns, &m.present);
  Set(cells.Double(kRawSatelliteInterSignalBiasNanos, -kLargestBias_ns, kLargestBias_ns),
      kMeasurementHasSatelliteInterSignalBias, &m.satellite_inter_signal_bias_ns, &m.present);
  ReadCodeType(row[kRawCodeType], &m);
  return m;
}

}  // namespace lodemark
