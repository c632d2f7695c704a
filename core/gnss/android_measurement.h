// Raw GNSS measurements as android.location.GnssClock and GnssMeasurement report them.
#pragma once

#include <cstdint>
#include <vector>

namespace lodemark {

// Which optional fields of an AndroidClock hold a value.
enum AndroidClockField : std::uint32_t {
  kClockHasLeapSecond = 1u << 0,
  kClockHasTimeUncertainty = 1u << 1,
  kClockHasFullBias = 1u << 2,
  kClockHasBias = 1u << 3,
  kClockHasBiasUncertainty = 1u << 4,
  kClockHasDrift = 1u << 5,
  kClockHasDriftUncertainty = 1u << 6,
  kClockHasElapsedRealtime = 1u << 7,
};

struct AndroidClock {
  std::int64_t time_ns = 0;
  std::int64_t full_bias_ns = 0;
  std::int64_t elapsed_realtime_ns = 0;
  double bias_ns = 0.0;
  double bias_uncertainty_ns = 0.0;
  double drift_nsps = 0.0;
  double drift_uncertainty_nsps = 0.0;
  double time_uncertainty_ns = 0.0;
  std::int32_t leap_second = 0;
  std::int32_t hardware_clock_discontinuity_count = 0;
  std::uint32_t present = 0;  // AndroidClockField bits

  bool Has(std::uint32_t fields) const { return (present & fields) == fields; }
};

// Which optional fields of an AndroidMeasurement hold a value.
enum AndroidMeasurementField : std::uint32_t {
  kMeasurementHasCarrierFrequency = 1u << 0,
  kMeasurementHasAccumulatedDeltaRange = 1u << 1,
  kMeasurementHasSnr = 1u << 2,
  kMeasurementHasAgc = 1u << 3,
  kMeasurementHasBasebandCn0 = 1u << 4,
  kMeasurementHasFullInterSignalBias = 1u << 5,
  kMeasurementHasSatelliteInterSignalBias = 1u << 6,
  kMeasurementHasCodeType = 1u << 7,
  kMeasurementHasReceivedTimeUncertainty = 1u << 8,
  kMeasurementHasRangeRate = 1u << 9,
  kMeasurementHasRangeRateUncertainty = 1u << 10,
  kMeasurementHasCn0 = 1u << 11,
  kMeasurementHasGivenPseudorange = 1u << 12,
};

struct AndroidMeasurement {
  std::int32_t svid = 0;
  std::int32_t constellation_type = 0;  // GnssStatus.CONSTELLATION_*
  std::int32_t state = 0;               // GnssMeasurement.STATE_* bits
  std::int32_t accumulated_delta_range_state = 0;
  std::int32_t multipath_indicator = 0;
  std::uint32_t present = 0;  // AndroidMeasurementField bits
  std::int64_t received_sv_time_ns = 0;
  std::int64_t received_sv_time_uncertainty_ns = 0;
  double time_offset_ns = 0.0;
  double cn0_dbhz = 0.0;
  double baseband_cn0_dbhz = 0.0;
  double pseudorange_rate_mps = 0.0;
  double pseudorange_rate_uncertainty_mps = 0.0;
  double accumulated_delta_range_m = 0.0;
  double accumulated_delta_range_uncertainty_m = 0.0;
  double carrier_frequency_hz = 0.0;
  double snr_db = 0.0;
  double agc_db = 0.0;
  double full_inter_signal_bias_ns = 0.0;
  double satellite_inter_signal_bias_ns = 0.0;
  // A pseudorange computed elsewhere, for logs whose time stamps lost their digits.
  double given_pseudorange_m = 0.0;
  char code_type[8] = {};  // GnssMeasurement.getCodeType(), zero-terminated: "C", "Q", ...

  bool Has(std::uint32_t fields) const { return (present & fields) == fields; }
};

// The clock and all measurements of one GnssMeasurementsEvent.
struct AndroidEpoch {
  AndroidClock clock;
  std::vector<AndroidMeasurement> measurements;
};

}  // namespace lodemark
