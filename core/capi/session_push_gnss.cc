// Epochs as android.location.GnssMeasurementsEvent holds them.
#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/session_handle.h"
#include "core/capi/structs.h"

namespace lodemark {
namespace {

static_assert(LODEMARK_CLOCK_HAS_LEAP_SECOND == kClockHasLeapSecond);
static_assert(LODEMARK_CLOCK_HAS_TIME_UNCERTAINTY == kClockHasTimeUncertainty);
static_assert(LODEMARK_CLOCK_HAS_FULL_BIAS == kClockHasFullBias);
static_assert(LODEMARK_CLOCK_HAS_BIAS == kClockHasBias);
static_assert(LODEMARK_CLOCK_HAS_BIAS_UNCERTAINTY == kClockHasBiasUncertainty);
static_assert(LODEMARK_CLOCK_HAS_DRIFT == kClockHasDrift);
static_assert(LODEMARK_CLOCK_HAS_DRIFT_UNCERTAINTY == kClockHasDriftUncertainty);
static_assert(LODEMARK_CLOCK_HAS_ELAPSED_REALTIME == kClockHasElapsedRealtime);
constexpr std::uint32_t kClockBits = 0xff;

static_assert(LODEMARK_MEASUREMENT_HAS_CARRIER_FREQUENCY == kMeasurementHasCarrierFrequency);
static_assert(LODEMARK_MEASUREMENT_HAS_ACCUMULATED_DELTA_RANGE ==
              kMeasurementHasAccumulatedDeltaRange);
static_assert(LODEMARK_MEASUREMENT_HAS_SNR == kMeasurementHasSnr);
static_assert(LODEMARK_MEASUREMENT_HAS_AGC == kMeasurementHasAgc);
static_assert(LODEMARK_MEASUREMENT_HAS_BASEBAND_CN0 == kMeasurementHasBasebandCn0);
static_assert(LODEMARK_MEASUREMENT_HAS_FULL_INTER_SIGNAL_BIAS ==
              kMeasurementHasFullInterSignalBias);
static_assert(LODEMARK_MEASUREMENT_HAS_SATELLITE_INTER_SIGNAL_BIAS ==
              kMeasurementHasSatelliteInterSignalBias);
static_assert(LODEMARK_MEASUREMENT_HAS_CODE_TYPE == kMeasurementHasCodeType);
static_assert(LODEMARK_MEASUREMENT_HAS_RECEIVED_TIME_UNCERTAINTY ==
              kMeasurementHasReceivedTimeUncertainty);
static_assert(LODEMARK_MEASUREMENT_HAS_RANGE_RATE == kMeasurementHasRangeRate);
static_assert(LODEMARK_MEASUREMENT_HAS_RANGE_RATE_UNCERTAINTY ==
              kMeasurementHasRangeRateUncertainty);
static_assert(LODEMARK_MEASUREMENT_HAS_CN0 == kMeasurementHasCn0);
static_assert(LODEMARK_MEASUREMENT_HAS_GIVEN_PSEUDORANGE == kMeasurementHasGivenPseudorange);
constexpr std::uint32_t kMeasurementBits = 0x1fff;

// Copies the fields of one struct to those of another that count: those without a presence bit and
// those whose bit is set. Numbers are checked on the way.
class Copier {
 public:
  Copier(Where where, std::uint32_t present) : check_(where), present_(present) {}

  void Copy(double from, const char* field, double* to, std::uint32_t bit = 0) {
    if (!Counts(bit)) return;
    check_.Finite(from, field);
    *to = from;
  }
  void CopyTime(std::int64_t from, const char* field, std::int64_t* to, std::uint32_t bit = 0) {
    if (!Counts(bit)) return;
    check_.Time(from, field);
    *to = from;
  }

  bool Counts(std::uint32_t bit) const { return bit == 0 || (present_ & bit) != 0; }
  Check& check() { return check_; }

 private:
  Check check_;
  std::uint32_t present_;
};

lodemark_status Translate(const lodemark_gnss_clock& from, AndroidClock* to) {
  *to = AndroidClock();
  Copier copier({"clock"}, from.present);
  copier.check().Bits(from.present, kClockBits, "present");
  copier.CopyTime(from.time_ns, "time_ns", &to->time_ns);
  copier.CopyTime(from.full_bias_ns, "full_bias_ns", &to->full_bias_ns, kClockHasFullBias);
  copier.CopyTime(from.elapsed_realtime_ns, "elapsed_realtime_ns", &to->elapsed_realtime_ns,
                  kClockHasElapsedRealtime);
  copier.Copy(from.bias_ns, "bias_ns", &to->bias_ns, kClockHasBias);
  copier.Copy(from.bias_uncertainty_ns, "bias_uncertainty_ns", &to->bias_uncertainty_ns,
              kClockHasBiasUncertainty);
  copier.Copy(from.drift_nsps, "drift_nsps", &to->drift_nsps, kClockHasDrift);
  copier.Copy(from.drift_uncertainty_nsps, "drift_uncertainty_nsps", &to->drift_uncertainty_nsps,
              kClockHasDriftUncertainty);
  copier.Copy(from.time_uncertainty_ns, "time_uncertainty_ns", &to->time_uncertainty_ns,
              kClockHasTimeUncertainty);
  if (copier.Counts(kClockHasLeapSecond)) to->leap_second = from.leap_second;
  to->hardware_clock_discontinuity_count = from.hardware_clock_discontinuity_count;
  to->present = from.present;
  return copier.check().status();
}

lodemark_status Translate(const lodemark_gnss_measurement& from, Where where,
                          AndroidMeasurement* to) {
  *to = AndroidMeasurement();
  Copier copier(where, from.present);
  copier.check().Bits(from.present, kMeasurementBits, "present");
  copier.check().Reserved(static_cast<std::uint32_t>(from.reserved));
  to->svid = from.svid;
  to->constellation_type = from.constellation_type;
  to->state = from.state;
  to->accumulated_delta_range_state = from.accumulated_delta_range_state;
  to->multipath_indicator = from.multipath_indicator;
  to->present = from.present;
  copier.CopyTime(from.received_sv_time_ns, "received_sv_time_ns", &to->received_sv_time_ns);
  copier.CopyTime(from.received_sv_time_uncertainty_ns, "received_sv_time_uncertainty_ns",
                  &to->received_sv_time_uncertainty_ns, kMeasurementHasReceivedTimeUncertainty);
  copier.Copy(from.time_offset_ns, "time_offset_ns", &to->time_offset_ns);
  copier.Copy(from.cn0_dbhz, "cn0_dbhz", &to->cn0_dbhz, kMeasurementHasCn0);
  copier.Copy(from.baseband_cn0_dbhz, "baseband_cn0_dbhz", &to->baseband_cn0_dbhz,
              kMeasurementHasBasebandCn0);
  copier.Copy(from.pseudorange_rate_mps, "pseudorange_rate_mps", &to->pseudorange_rate_mps,
              kMeasurementHasRangeRate);
  copier.Copy(from.pseudorange_rate_uncertainty_mps, "pseudorange_rate_uncertainty_mps",
              &to->pseudorange_rate_uncertainty_mps, kMeasurementHasRangeRateUncertainty);
  copier.Copy(from.accumulated_delta_range_m, "accumulated_delta_range_m",
              &to->accumulated_delta_range_m, kMeasurementHasAccumulatedDeltaRange);
  copier.Copy(from.accumulated_delta_range_uncertainty_m, "accumulated_delta_range_uncertainty_m",
              &to->accumulated_delta_range_uncertainty_m, kMeasurementHasAccumulatedDeltaRange);
  copier.Copy(from.carrier_frequency_hz, "carrier_frequency_hz", &to->carrier_frequency_hz,
              kMeasurementHasCarrierFrequency);
  copier.Copy(from.snr_db, "snr_db", &to->snr_db, kMeasurementHasSnr);
  copier.Copy(from.agc_db, "agc_db", &to->agc_db, kMeasurementHasAgc);
  copier.Copy(from.full_inter_signal_bias_ns, "full_inter_signal_bias_ns",
              &to->full_inter_signal_bias_ns, kMeasurementHasFullInterSignalBias);
  copier.Copy(from.satellite_inter_signal_bias_ns, "satellite_inter_signal_bias_ns",
              &to->satellite_inter_signal_bias_ns, kMeasurementHasSatelliteInterSignalBias);
  copier.Copy(from.given_pseudorange_m, "given_pseudorange_m", &to->given_pseudorange_m,
              kMeasurementHasGivenPseudorange);
  if (copier.Counts(kMeasurementHasCodeType)) {
    static_assert(sizeof to->code_type == sizeof from.code_type);
    copier.check().Text(from.code_type, "code_type");
    std::memcpy(to->code_type, from.code_type, sizeof to->code_type);
  }
  return copier.check().status();
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_session_push_gnss(lodemark_session* session, int64_t time_ns,
                                           const lodemark_gnss_clock* clock,
                                           const lodemark_gnss_measurement* measurements,
                                           int32_t count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    Check check_time({"time_ns"});
    check_time.Time(time_ns, "");
    lodemark_status status = check_time.status();

    lodemark_gnss_clock stated_clock = {};
    AndroidEpoch& epoch = session->android_epoch;
    if (status == LODEMARK_OK) status = ReadStruct(clock, {"clock"}, &stated_clock);
    if (status == LODEMARK_OK) status = Translate(stated_clock, &epoch.clock);

    const StructArray<lodemark_gnss_measurement> array(measurements, count, "measurements");
    if (status == LODEMARK_OK) status = array.CheckCount();
    if (status != LODEMARK_OK) return status;
    epoch.measurements.resize(static_cast<std::size_t>(count));
    status = array.ForEach([&](const lodemark_gnss_measurement& from, Where where, std::size_t i) {
      return Translate(from, where, &epoch.measurements[i]);
    });
    if (status != LODEMARK_OK) return status;
    return StatusOf(session->engine->PushAndroidEpoch(time_ns, epoch));
  });
}
