#include "tools/lodemark/replay_session.h"

#include <cstring>

namespace lodemark {
namespace {

// A session keeps at most so many events, and no receiver tracks as many signals as this.
constexpr std::size_t kEvents = 256;
constexpr std::size_t kSignals = 512;

lodemark_gnss_clock ToC(const AndroidClock& from) {
  lodemark_gnss_clock to = {};
  to.struct_size = sizeof to;
  to.present = from.present;  // the bits are the same
  to.time_ns = from.time_ns;
  to.full_bias_ns = from.full_bias_ns;
  to.elapsed_realtime_ns = from.elapsed_realtime_ns;
  to.bias_ns = from.bias_ns;
  to.bias_uncertainty_ns = from.bias_uncertainty_ns;
  to.drift_nsps = from.drift_nsps;
  to.drift_uncertainty_nsps = from.drift_uncertainty_nsps;
  to.time_uncertainty_ns = from.time_uncertainty_ns;
  to.leap_second = from.leap_second;
  to.hardware_clock_discontinuity_count = from.hardware_clock_discontinuity_count;
  return to;
}

void ToC(const AndroidMeasurement& from, lodemark_gnss_measurement* to) {
  *to = {};
  to->struct_size = sizeof *to;
  to->present = from.present;  // the bits are the same
  to->svid = from.svid;
  to->constellation_type = from.constellation_type;
  to->state = from.state;
  to->accumulated_delta_range_state = from.accumulated_delta_range_state;
  to->multipath_indicator = from.multipath_indicator;
  to->received_sv_time_ns = from.received_sv_time_ns;
  to->received_sv_time_uncertainty_ns = from.received_sv_time_uncertainty_ns;
  to->time_offset_ns = from.time_offset_ns;
  to->cn0_dbhz = from.cn0_dbhz;
  to->baseband_cn0_dbhz = from.baseband_cn0_dbhz;
  to->pseudorange_rate_mps = from.pseudorange_rate_mps;
  to->pseudorange_rate_uncertainty_mps = from.pseudorange_rate_uncertainty_mps;
  to->accumulated_delta_range_m = from.accumulated_delta_range_m;
  to->accumulated_delta_range_uncertainty_m = from.accumulated_delta_range_uncertainty_m;
  to->carrier_frequency_hz = from.carrier_frequency_hz;
  to->snr_db = from.snr_db;
  to->agc_db = from.agc_db;
  to->full_inter_signal_bias_ns = from.full_inter_signal_bias_ns;
  to->satellite_inter_signal_bias_ns = from.satellite_inter_signal_bias_ns;
  to->given_pseudorange_m = from.given_pseudorange_m;
  static_assert(sizeof to->code_type == sizeof from.code_type);
  std::memcpy(to->code_type, from.code_type, sizeof to->code_type);
}

static_assert(LODEMARK_MEASUREMENT_HAS_GIVEN_PSEUDORANGE == kMeasurementHasGivenPseudorange);
static_assert(LODEMARK_CLOCK_HAS_ELAPSED_REALTIME == kClockHasElapsedRealtime);
static_assert(LODEMARK_OBSERVATION_HAS_PSEUDORANGE == kHasPseudorange);
static_assert(LODEMARK_OBSERVATION_HAS_RANGE_RATE_SIGMA == kHasRangeRateSigma);
constexpr std::uint32_t kSharedFields = 0x7f;  // from the pseudorange to the range rate's sigma
static_assert(LODEMARK_OBSERVATION_LOSS_OF_LOCK == kLossOfLock);
static_assert(LODEMARK_OBSERVATION_MULTIPATH_DETECTED == kMultipathDetected);
constexpr std::uint32_t kSharedFlags = 0x7;

void ToC(const SignalObservation& from, lodemark_observation* to) {
  *to = {};
  to->struct_size = sizeof *to;
  to->present = from.present & kSharedFields;
  to->flags = from.flags & kSharedFlags;
  to->system = static_cast<std::int32_t>(from.satellite.system);
  to->satellite = from.satellite.number;
  if (from.glonass_channel != kUnknownGlonassChannel) {
    to->present |= LODEMARK_OBSERVATION_HAS_GLONASS_CHANNEL;
    to->glonass_channel = from.glonass_channel;
  }
  to->signal[0] = from.signal.band;
  if (from.signal.attribute != ' ') to->signal[1] = from.signal.attribute;
  to->frequency_hz = from.frequency_hz;
  to->pseudorange_m = from.pseudorange_m;
  to->carrier_phase_cycles = from.carrier_phase_cycles;
  to->doppler_hz = from.doppler_hz;
  to->cn0_dbhz = from.cn0_dbhz;
  to->pseudorange_sigma_m = from.pseudorange_sigma_m;
  to->carrier_phase_sigma_m = from.carrier_phase_sigma_m;
  to->range_rate_sigma_mps = from.range_rate_sigma_mps;
}

Status ToStatus(lodemark_status status) {
  if (status >= LODEMARK_OK) return {};
  return LastError(status);
}

// Calls list(capacity), which fills values from the front; makes room once if there was too little.
template <typename Struct, typename List>
lodemark_status FetchList(std::vector<Struct>* values, std::int32_t* count, List list) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    values->front().struct_size = sizeof(Struct);
    const lodemark_status status = list(values->data(), static_cast<std::int32_t>(values->size()));
    if (status != LODEMARK_OK || static_cast<std::size_t>(*count) <= values->size()) return status;
    values->resize(static_cast<std::size_t>(*count));
  }
  return LODEMARK_OK;
}

}  // namespace

Error LastError(lodemark_status status) {
  const std::string text = lodemark_last_error();
  switch (status) {
    case LODEMARK_ERROR_INVALID_ARGUMENT:
      return {ErrorCode::kInvalidArgument, text};
    case LODEMARK_ERROR_UNSUPPORTED:
      return {ErrorCode::kUnsupported, text};
    case LODEMARK_ERROR_OUT_OF_ORDER:
      return {ErrorCode::kOutOfOrder, text};
    case LODEMARK_ERROR_QUEUE_FULL:
      return {ErrorCode::kQueueFull, text};
    case LODEMARK_ERROR_IO:
      return {ErrorCode::kIo, text};
    case LODEMARK_ERROR_BAD_DATA:
      return {ErrorCode::kBadData, text};
    case LODEMARK_ERROR_OUT_OF_MEMORY:
      return {ErrorCode::kOutOfMemory, text};
    default:
      return {ErrorCode::kInternal, text};
  }
}

ReplaySession::ReplaySession(lodemark_session* session)
    : session_(session), satellites_(kSignals), landmarks_(1), events_(kEvents) {
  // So that an epoch without signals has an array too.
  measurements_.reserve(kSignals);
  observations_.reserve(kSignals);
}

Result<std::vector<lodemark_estimate>> ReplaySession::Smoothed() {
  std::vector<lodemark_estimate> estimates(1);
  std::int32_t count = 0;
  const lodemark_status status =
      FetchList(&estimates, &count, [&](lodemark_estimate* out, std::int32_t capacity) {
        return lodemark_session_smoothed(session_.get(), out, capacity, &count);
      });
  if (status != LODEMARK_OK) return LastError(status);
  estimates.resize(static_cast<std::size_t>(count));
  return estimates;
}

Result<ReplaySession> ReplaySession::Open(const lodemark_session_options& options) {
  lodemark_session* session = nullptr;
  const lodemark_status status = lodemark_session_open(&options, &session);
  if (status != LODEMARK_OK) return LastError(status);
  return ReplaySession(session);
}

Status ReplaySession::PushNavigation(const std::string& name, const std::string& content,
                                     lodemark_read_report* report) {
  *report = {};
  report->struct_size = sizeof *report;
  return ToStatus(lodemark_session_push_navigation(session_.get(), name.c_str(), content.data(),
                                                   content.size(), report));
}

Status ReplaySession::PushPreciseOrbits(const std::string& name, const std::string& content,
                                        lodemark_read_report* report) {
  *report = {};
  report->struct_size = sizeof *report;
  return ToStatus(lodemark_session_push_precise_orbits(session_.get(), name.c_str(), content.data(),
                                                       content.size(), report));
}

Status ReplaySession::Push(const AndroidEpoch& epoch) {
  const lodemark_gnss_clock clock = ToC(epoch.clock);
  measurements_.resize(epoch.measurements.size());
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    ToC(epoch.measurements[i], &measurements_[i]);
  }
  return ToStatus(lodemark_session_push_gnss(session_.get(), 0, &clock, measurements_.data(),
                                             static_cast<std::int32_t>(measurements_.size())));
}

Status ReplaySession::Push(const ObservationEpoch& epoch) {
  lodemark_observation_epoch to = {};
  to.struct_size = sizeof to;
  to.flags = epoch.clock_discontinuity ? LODEMARK_EPOCH_CLOCK_DISCONTINUITY : 0;
  to.time_gps_ns = epoch.time_gps_ns;
  to.time_fraction_ns = epoch.time_fraction_ns;
  observations_.resize(epoch.signals.size());
  for (std::size_t i = 0; i < observations_.size(); ++i) ToC(epoch.signals[i], &observations_[i]);
  return ToStatus(
      lodemark_session_push_observations(session_.get(), 0, &to, observations_.data(),
                                         static_cast<std::int32_t>(observations_.size())));
}

Status ReplaySession::Push(const LoggedNavigationMessage& message) {
  lodemark_broadcast_message to = {};
  to.struct_size = sizeof to;
  to.type = message.type;
  to.svid = message.svid;
  to.message_id = message.message_id;
  to.submessage_id = message.submessage_id;
  if (message.bytes.empty()) return Error{ErrorCode::kBadData, "a message without bytes"};
  return ToStatus(lodemark_session_push_broadcast(session_.get(), &to, message.bytes.data(),
                                                  message.bytes.size()));
}

Status ReplaySession::UseMap(const std::string& path) {
  lodemark_map* map = nullptr;
  lodemark_status status = lodemark_map_open(path.c_str(), &map);
  if (status < LODEMARK_OK) return LastError(status);
  map_.reset(map);
  return ToStatus(lodemark_session_use_map(session_.get(), map));
}

Status ReplaySession::Push(const lodemark_frame& frame, const lodemark_lens& lens,
                           const std::vector<std::uint8_t>& pixels) {
  return ToStatus(
      lodemark_session_push_image(session_.get(), &frame, &lens, pixels.data(), lens.width_px));
}

Status ReplaySession::Push(std::span<const lodemark_sensor_sample> samples) {
  return ToStatus(lodemark_session_push_sensors(session_.get(), samples.data(),
                                                static_cast<std::int32_t>(samples.size())));
}

Result<bool> ReplaySession::Process() {
  event_count_ = 0;
  satellite_count_ = 0;
  landmark_count_ = 0;
  const lodemark_status status = lodemark_session_process(session_.get());
  if (status == LODEMARK_NOTHING_QUEUED) return false;
  if (status < LODEMARK_OK) return LastError(status);
  const Status fetched = Fetch();
  if (!fetched.ok()) return fetched.error();
  return true;
}

Status ReplaySession::Fetch() {
  estimate_.struct_size = sizeof estimate_;
  lodemark_status status = lodemark_session_estimate(session_.get(), &estimate_);
  if (status < LODEMARK_OK) return LastError(status);
  status = FetchList(&satellites_, &satellite_count_, [&](lodemark_satellite* out, int capacity) {
    return lodemark_session_satellites(session_.get(), out, capacity, &satellite_count_);
  });
  if (status < LODEMARK_OK) return LastError(status);
  status = FetchList(&landmarks_, &landmark_count_, [&](lodemark_landmark* out, int capacity) {
    return lodemark_session_landmarks(session_.get(), out, capacity, &landmark_count_);
  });
  if (status < LODEMARK_OK) return LastError(status);
  status = FetchList(&events_, &event_count_, [&](lodemark_event* out, int capacity) {
    return lodemark_session_events(session_.get(), out, capacity, &event_count_);
  });
  if (status < LODEMARK_OK) return LastError(status);
  if (event_count_ > 0) status = lodemark_session_clear_events(session_.get());
  return ToStatus(status);
}

std::span<const lodemark_satellite> ReplaySession::satellites() const {
  return {satellites_.data(), static_cast<std::size_t>(satellite_count_)};
}

std::span<const lodemark_landmark> ReplaySession::landmarks() const {
  return {landmarks_.data(), static_cast<std::size_t>(landmark_count_)};
}

std::span<const lodemark_event> ReplaySession::events() const {
  return {events_.data(), static_cast<std::size_t>(event_count_)};
}

}  // namespace lodemark
