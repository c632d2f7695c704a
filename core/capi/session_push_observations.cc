// Epochs of observables, as RINEX observation files hold them.
#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/session_handle.h"
#include "core/capi/structs.h"

namespace lodemark {
namespace {

static_assert(LODEMARK_SYSTEM_GPS == static_cast<int>(System::kGps));
static_assert(LODEMARK_SYSTEM_GLONASS == static_cast<int>(System::kGlonass));
static_assert(LODEMARK_SYSTEM_GALILEO == static_cast<int>(System::kGalileo));
static_assert(LODEMARK_SYSTEM_BEIDOU == static_cast<int>(System::kBeidou));
static_assert(LODEMARK_SYSTEM_QZSS == static_cast<int>(System::kQzss));
static_assert(LODEMARK_SYSTEM_NAVIC == static_cast<int>(System::kNavic));
static_assert(LODEMARK_SYSTEM_SBAS == static_cast<int>(System::kSbas));

static_assert(LODEMARK_OBSERVATION_HAS_PSEUDORANGE == kHasPseudorange);
static_assert(LODEMARK_OBSERVATION_HAS_CARRIER_PHASE == kHasCarrierPhase);
static_assert(LODEMARK_OBSERVATION_HAS_DOPPLER == kHasDoppler);
static_assert(LODEMARK_OBSERVATION_HAS_CN0 == kHasCn0);
static_assert(LODEMARK_OBSERVATION_HAS_PSEUDORANGE_SIGMA == kHasPseudorangeSigma);
static_assert(LODEMARK_OBSERVATION_HAS_CARRIER_PHASE_SIGMA == kHasCarrierPhaseSigma);
static_assert(LODEMARK_OBSERVATION_HAS_RANGE_RATE_SIGMA == kHasRangeRateSigma);
// The bits above mean the same to the session; the channel's is the interface's own.
constexpr std::uint32_t kSessionBits = 0x7f;
constexpr std::uint32_t kPresentBits = kSessionBits | LODEMARK_OBSERVATION_HAS_GLONASS_CHANNEL;

static_assert(LODEMARK_OBSERVATION_LOSS_OF_LOCK == kLossOfLock);
static_assert(LODEMARK_OBSERVATION_HALF_CYCLE_AMBIGUOUS == kHalfCycleAmbiguous);
static_assert(LODEMARK_OBSERVATION_MULTIPATH_DETECTED == kMultipathDetected);
constexpr std::uint32_t kFlagBits = 0x7;

constexpr double kLargestFrequency_hz = 1e11;

void CheckSignal(const char (&signal)[8], Check* check) {
  const char band = signal[0];
  const char attribute = signal[1];
  const bool good =
      band >= '1' && band <= '9' &&
      (attribute == '\0' || ((attribute >= 'A' && attribute <= 'Z') && signal[2] == '\0'));
  check->True(good, "signal", "is no band and attribute such as \"1C\"");
}

lodemark_status Translate(const lodemark_observation& from, Where where, SignalObservation* to) {
  *to = SignalObservation();
  Check check(where);
  check.Bits(from.present, kPresentBits, "present");
  check.Bits(from.flags, kFlagBits, "flags");
  check.Constant(from.system, kSystemCount - 1, "system");
  CheckSignal(from.signal, &check);
  check.Within(from.frequency_hz, 0.0, kLargestFrequency_hz, "frequency_hz");
  if (check.status() != LODEMARK_OK) return check.status();

  const auto system = static_cast<System>(from.system);
  check.True(from.satellite >= 1 && from.satellite <= LargestSatelliteNumber(system), "satellite",
             "is no satellite of its system");
  const bool has_channel = (from.present & LODEMARK_OBSERVATION_HAS_GLONASS_CHANNEL) != 0;
  if (has_channel) check.Within(from.glonass_channel, -7, 6, "glonass_channel");
  if (check.status() != LODEMARK_OK) return check.status();

  to->satellite = {system, static_cast<std::uint8_t>(from.satellite)};
  to->signal = {from.signal[0], from.signal[1] == '\0' ? ' ' : from.signal[1]};
  if (has_channel) to->glonass_channel = static_cast<std::int8_t>(from.glonass_channel);
  to->present = from.present & kSessionBits;
  to->flags = from.flags;
  to->frequency_hz = from.frequency_hz;
  if (from.frequency_hz == 0.0) {
    to->frequency_hz = CarrierFrequency(system, to->signal.band, to->glonass_channel).value_or(0.0);
  }

  const auto copy = [&](std::uint32_t bit, double value, const char* field, double* target) {
    if ((from.present & bit) == 0) return;
    check.Finite(value, field);
    *target = value;
  };
  copy(kHasPseudorange, from.pseudorange_m, "pseudorange_m", &to->pseudorange_m);
  copy(kHasCarrierPhase, from.carrier_phase_cycles, "carrier_phase_cycles",
       &to->carrier_phase_cycles);
  copy(kHasDoppler, from.doppler_hz, "doppler_hz", &to->doppler_hz);
  copy(kHasCn0, from.cn0_dbhz, "cn0_dbhz", &to->cn0_dbhz);
  copy(kHasPseudorangeSigma, from.pseudorange_sigma_m, "pseudorange_sigma_m",
       &to->pseudorange_sigma_m);
  copy(kHasCarrierPhaseSigma, from.carrier_phase_sigma_m, "carrier_phase_sigma_m",
       &to->carrier_phase_sigma_m);
  copy(kHasRangeRateSigma, from.range_rate_sigma_mps, "range_rate_sigma_mps",
       &to->range_rate_sigma_mps);
  return check.status();
}

lodemark_status Translate(const lodemark_observation_epoch& from, ObservationEpoch* to) {
  Check check({"epoch"});
  check.Bits(from.flags, LODEMARK_EPOCH_CLOCK_DISCONTINUITY, "flags");
  check.Time(from.time_gps_ns, "time_gps_ns");
  check.Within(from.time_fraction_ns, -1e9, 1e9, "time_fraction_ns");
  to->time_gps_ns = from.time_gps_ns;
  to->time_fraction_ns = from.time_fraction_ns;
  to->clock_discontinuity = (from.flags & LODEMARK_EPOCH_CLOCK_DISCONTINUITY) != 0;
  return check.status();
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_session_push_observations(lodemark_session* session, int64_t time_ns,
                                                   const lodemark_observation_epoch* epoch,
                                                   const lodemark_observation* observations,
                                                   int32_t count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    Check check_time({"time_ns"});
    check_time.Time(time_ns, "");
    lodemark_status status = check_time.status();

    lodemark_observation_epoch stated_epoch = {};
    ObservationEpoch& to = session->observation_epoch;
    if (status == LODEMARK_OK) status = ReadStruct(epoch, {"epoch"}, &stated_epoch);
    if (status == LODEMARK_OK) status = Translate(stated_epoch, &to);

    const StructArray<lodemark_observation> array(observations, count, "observations");
    if (status == LODEMARK_OK) status = array.CheckCount();
    if (status != LODEMARK_OK) return status;
    to.signals.resize(static_cast<std::size_t>(count));
    status = array.ForEach([&](const lodemark_observation& from, Where where, std::size_t i) {
      return Translate(from, where, &to.signals[i]);
    });
    if (status != LODEMARK_OK) return status;
    return StatusOf(session->engine->PushObservationEpoch(time_ns, to));
  });
}
