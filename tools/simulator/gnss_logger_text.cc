#include "tools/simulator/gnss_logger_text.h"

#include <cinttypes>
#include <cstdio>

#include "core/base/units.h"

namespace lodemark {
namespace {

template <typename... Arguments>
void Append(std::string* text, const char* format, Arguments... arguments) {
  char row[640];
  const int length = std::snprintf(row, sizeof row, format, arguments...);
  text->append(row, static_cast<std::size_t>(length));
}

}  // namespace

std::string GnssLoggerHeader() {
  return "# \n"
         "# Header Description:\n"
         "# \n"
         "# Version: v3.0.6.4 Platform: 12 Manufacturer: Xiaomi Model: M2006J10C\n"
         "# \n"
         "# Simulated by lodemark: no such phone was there.\n"
         "# \n"
         "# Raw,utcTimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,FullBiasNanos,BiasNanos,"
         "BiasUncertaintyNanos,DriftNanosPerSecond,DriftUncertaintyNanosPerSecond,"
         "HardwareClockDiscontinuityCount,Svid,TimeOffsetNanos,State,ReceivedSvTimeNanos,"
         "ReceivedSvTimeUncertaintyNanos,Cn0DbHz,PseudorangeRateMetersPerSecond,"
         "PseudorangeRateUncertaintyMetersPerSecond,AccumulatedDeltaRangeState,"
         "AccumulatedDeltaRangeMeters,AccumulatedDeltaRangeUncertaintyMeters,CarrierFrequencyHz,"
         "CarrierCycles,CarrierPhase,CarrierPhaseUncertainty,MultipathIndicator,SnrInDb,"
         "ConstellationType,AgcDb,BasebandCn0DbHz,FullInterSignalBiasNanos,"
         "FullInterSignalBiasUncertaintyNanos,SatelliteInterSignalBiasNanos,"
         "SatelliteInterSignalBiasUncertaintyNanos,CodeType,ChipsetElapsedRealtimeNanos\n"
         "# \n"
         "# UncalAccel,utcTimeMillis,elapsedRealtimeNanos,UncalAccelXMps2,UncalAccelYMps2,"
         "UncalAccelZMps2,BiasXMps2,BiasYMps2,BiasZMps2\n"
         "# \n"
         "# UncalGyro,utcTimeMillis,elapsedRealtimeNanos,UncalGyroXRadPerSec,UncalGyroYRadPerSec,"
         "UncalGyroZRadPerSec,DriftXRadPerSec,DriftYRadPerSec,DriftZRadPerSec\n"
         "# \n"
         "# UncalMag,utcTimeMillis,elapsedRealtimeNanos,UncalMagXMicroT,UncalMagYMicroT,"
         "UncalMagZMicroT,BiasXMicroT,BiasYMicroT,BiasZMicroT\n"
         "# \n"
         "# Fix,Provider,LatitudeDegrees,LongitudeDegrees,AltitudeMeters,SpeedMps,AccuracyMeters,"
         "BearingDegrees,UnixTimeMillis,SpeedAccuracyMps,BearingAccuracyDegrees,"
         "elapsedRealtimeNanos,VerticalAccuracyMeters,MockLocation,NumberOfUsedSignals,"
         "VerticalSpeedAccuracyMps,SolutionType\n"
         "# \n";
}

void AppendRawRows(const AndroidEpoch& epoch, std::int64_t utc_ms, std::string* text) {
  const AndroidClock& c = epoch.clock;
  for (const AndroidMeasurement& m : epoch.measurements) {
    Append(text,
           "Raw,%" PRId64 ",%" PRId64 ",%d,,%" PRId64 ",%.6f,%.1f,%.4f,%.2f,%d,%d,0.0,%d,%" PRId64
           ",%" PRId64 ",%.1f,%.6f,%.4f,%d,%.6f,%.4f,%.0f,,,,%d,,%d,%.1f,%.1f,,,,,%s,%" PRId64 "\n",
           utc_ms, c.time_ns, c.leap_second, c.full_bias_ns, c.bias_ns, c.bias_uncertainty_ns,
           c.drift_nsps, c.drift_uncertainty_nsps, c.hardware_clock_discontinuity_count, m.svid,
           m.state, m.received_sv_time_ns, m.received_sv_time_uncertainty_ns, m.cn0_dbhz,
           m.pseudorange_rate_mps, m.pseudorange_rate_uncertainty_mps,
           m.accumulated_delta_range_state, m.accumulated_delta_range_m,
           m.accumulated_delta_range_uncertainty_m, m.carrier_frequency_hz, m.multipath_indicator,
           m.constellation_type, m.agc_db, m.baseband_cn0_dbhz, m.code_type, c.elapsed_realtime_ns);
  }
}

void AppendFixRow(const FixRow& fix, std::string* text) {
  Append(text, "Fix,GPS,%.10f,%.10f,%.3f,%.3f,%.2f,%.1f,%" PRId64 ",%.2f,,%" PRId64 ",%.2f,0,,,\n",
         fix.place.latitude_rad * kDegreesPerRadian, fix.place.longitude_rad * kDegreesPerRadian,
         fix.place.height_m, fix.speed_mps, fix.accuracy_m, fix.bearing_deg, fix.utc_ms,
         fix.speed_accuracy_mps, fix.elapsed_realtime_ns, fix.vertical_accuracy_m);
}

void AppendUncalibratedRow(const UncalibratedRow& row, std::string* text) {
  Append(text, "%s,%" PRId64 ",%" PRId64 ",%.5f,%.5f,%.5f,%.5f,%.5f,%.5f\n", row.kind, row.utc_ms,
         row.elapsed_realtime_ns, row.values[0], row.values[1], row.values[2], row.biases[0],
         row.biases[1], row.biases[2]);
}

}  // namespace lodemark
