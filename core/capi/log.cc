// Recorded logs, pushed into a session.
#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/log_handle.h"
#include "core/capi/sensors.h"
#include "core/capi/session_handle.h"
#include "core/logs/ubx_frames.h"

namespace lodemark {
namespace {

// A phone gets one or two in a second; a log of a million of them before its first epoch is none.
constexpr std::size_t kMostWaitingMessages = 10'000;

// Samples of sensors that were measured longer before the first epoch are of no use, and between
// two epochs none measures so often.
constexpr std::int64_t kBeforeFirst_ns = 10'000'000'000;
constexpr std::size_t kMostAhead = 20'000;

// What no session takes is of no use: damaged, or of a type that is not decoded.
void PushMessages(lodemark_log* log, Session* session) {
  while (!log->messages.empty()) {
    const LoggedNavigationMessage& message = log->messages.front();
    const Status pushed = session->PushNavigationMessage(
        message.type, message.svid, message.message_id, message.submessage_id, message.bytes);
    if (!pushed && pushed.error().code == ErrorCode::kOutOfOrder) return;
    log->messages.pop_front();
  }
}

// Times as lodemark_session_push_gnss takes them; all else the reader has checked.
lodemark_status CheckTimes(const AndroidEpoch& epoch, std::int64_t time_ns) {
  Check check({"epoch"});
  check.Time(time_ns, "elapsed_realtime_ns");
  check.Time(epoch.clock.time_ns, "time_ns");
  check.Time(epoch.clock.full_bias_ns, "full_bias_ns");
  for (const AndroidMeasurement& measurement : epoch.measurements) {
    check.Time(measurement.received_sv_time_ns, "received_sv_time_ns");
    check.Time(measurement.received_sv_time_uncertainty_ns, "received_sv_time_uncertainty_ns");
  }
  return check.status();
}

lodemark_sensor_sample ToC(const LoggedSample& from, TimeBase time_base) {
  lodemark_sensor_sample to = {};
  switch (from.kind) {
    case LoggedSensor::Kind::kAcceleration:
      to.sensor = LODEMARK_SENSOR_ACCELEROMETER;
      break;
    case LoggedSensor::Kind::kTurnRate:
      to.sensor = LODEMARK_SENSOR_GYROSCOPE;
      break;
    default:
      to.sensor = LODEMARK_SENSOR_BAROMETER;
      break;
  }
  to.time_ns = time_base == TimeBase::kGps ? from.time_gps_ns : from.elapsed_realtime_ns;
  std::copy(from.value.begin(), from.value.end(), to.value);
  return to;
}

// What was measured until shortly after the epoch, so that its own moment lies between samples. A
// row of a text is late by some milliseconds; what is later than the epoch before it is left out.
void PushSamples(const AndroidClock& clock, lodemark_log* log, lodemark_session* session) {
  if (!clock.Has(kClockHasFullBias)) return;
  const std::int64_t epoch_gps_ns = clock.time_ns - clock.full_bias_ns;
  const std::int64_t until_gps_ns = epoch_gps_ns + SensorBuffer::kLongestGap_ns;
  if (log->heard_gps_ns == 0) log->heard_gps_ns = epoch_gps_ns - kBeforeFirst_ns;
  std::vector<LoggedSample>& ahead = log->ahead;
  // A time long before what was heard: that one, or this, was wrong. The file goes on from here.
  if (until_gps_ns < log->heard_gps_ns - kBeforeFirst_ns) {
    log->heard_gps_ns = epoch_gps_ns - kBeforeFirst_ns;
    ahead.clear();
  }
  for (LoggedSample sample; log->samples.Next(&sample);) {
    if (sample.time_gps_ns > log->heard_gps_ns && ahead.size() < kMostAhead) {
      ahead.push_back(sample);
    }
  }
  if (until_gps_ns <= log->heard_gps_ns) return;
  std::stable_sort(ahead.begin(), ahead.end(), [](const LoggedSample& a, const LoggedSample& b) {
    return a.time_gps_ns < b.time_gps_ns;
  });
  const auto end = std::find_if(ahead.begin(), ahead.end(), [&](const LoggedSample& sample) {
    return sample.time_gps_ns > until_gps_ns;
  });
  session->sensor_samples.clear();
  for (auto sample = ahead.begin(); sample != end; ++sample) {
    SensorSample read;
    const lodemark_sensor_sample stated = ToC(*sample, session->time_base);
    if (ReadSample(stated, {"log"}, &read) == LODEMARK_OK) session->sensor_samples.push_back(read);
  }
  (void)session->engine->PushSensors(session->sensor_samples);
  ahead.erase(ahead.begin(), end);
  log->heard_gps_ns = until_gps_ns;
}

lodemark_status AfterPush(lodemark_log* log, const Status& pushed) {
  log->epoch_waits = !pushed && pushed.error().code == ErrorCode::kQueueFull;
  return StatusOf(pushed);
}

lodemark_status PushEpoch(lodemark_log* log, lodemark_session* handle) {
  Session* session = handle->engine.get();
  log->epoch_seen = true;
  PushMessages(log, session);
  if (std::holds_alternative<UbxReader>(log->reader)) {
    // The file tells no time but this.
    const auto& epoch = std::get<ObservationEpoch>(log->ubx_record);
    return AfterPush(log, session->PushObservationEpoch(epoch.time_gps_ns, epoch));
  }
  const auto& epoch = std::get<AndroidEpoch>(log->record);
  const AndroidClock& clock = epoch.clock;
  const std::int64_t time_ns =
      clock.Has(kClockHasElapsedRealtime) ? clock.elapsed_realtime_ns : clock.time_ns;
  log->epoch_waits = false;
  if (const lodemark_status status = CheckTimes(epoch, time_ns); status != LODEMARK_OK) {
    return status;
  }
  PushSamples(clock, log, handle);
  return AfterPush(log, session->PushAndroidEpoch(time_ns, epoch));
}

void Keep(LoggedNavigationMessage message, lodemark_log* log) {
  if (log->messages.size() == kMostWaitingMessages) log->messages.pop_front();
  log->messages.push_back(std::move(message));
}

// Reads to the next epoch. False at the end.
template <typename Epoch, typename Reader, typename Record>
bool NextEpoch(Reader* reader, Record* record, lodemark_log* log) {
  while (reader->Next(record)) {
    if (const auto* epoch = std::get_if<Epoch>(record)) {
      if constexpr (std::is_same_v<Epoch, AndroidEpoch>) log->samples.Take(*epoch);
      return true;
    }
    if (auto* message = std::get_if<LoggedNavigationMessage>(record)) {
      Keep(std::move(*message), log);
    }
    if constexpr (std::is_same_v<Epoch, AndroidEpoch>) {
      if (const auto* sensor = std::get_if<LoggedSensor>(record)) log->samples.Take(*sensor);
    }
  }
  return false;
}

bool NextEpoch(lodemark_log* log) {
  if (auto* ubx = std::get_if<UbxReader>(&log->reader)) {
    return NextEpoch<ObservationEpoch>(ubx, &log->ubx_record, log);
  }
  return NextEpoch<AndroidEpoch>(std::get_if<GnssLoggerReader>(&log->reader), &log->record, log);
}

lodemark_status AtEnd(const lodemark_log& log) {
  const auto status_of = [](const auto& reader) -> const Status& { return reader.status(); };
  const auto report_of = [](const auto& reader) -> const ReadReport& { return reader.report(); };
  const Status& status = std::visit(status_of, log.reader);
  if (!status) return Fail(status.error());
  if (log.epoch_seen) return LODEMARK_END_OF_LOG;
  const ReadReport& report = std::visit(report_of, log.reader);
  if (!report.problems.empty()) {
    return Fail({ErrorCode::kBadData, FormatProblem(report.file, report.problems.front())});
  }
  return Fail({ErrorCode::kBadData, report.file + ": holds no epoch of raw measurements"});
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_log_open(const char* path, lodemark_log** log) {
  using namespace lodemark;
  return Guard([&] {
    if (log == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "log is NULL");
    *log = nullptr;
    if (path == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "path is NULL");
    const auto take = [&](auto reader) {
      if (!reader) return Fail(reader.error());
      *log = new lodemark_log(std::move(reader).value());
      return lodemark_status{LODEMARK_OK};
    };
    if (BeginsLikeUbx(path)) return take(UbxReader::Open(path));
    return take(GnssLoggerReader::Open(path));
  });
}

void lodemark_log_close(lodemark_log* log) { delete log; }

lodemark_status lodemark_log_push_next(lodemark_log* log, lodemark_session* session) {
  using namespace lodemark;
  if (log == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "log is NULL");
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    if (log->epoch_waits) return PushEpoch(log, session);
    return NextEpoch(log) ? PushEpoch(log, session) : AtEnd(*log);
  });
}
