// Recorded logs, pushed into a session.
#include <memory>
#include <utility>
#include <variant>

#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/log_handle.h"
#include "core/capi/session_handle.h"
#include "core/logs/ubx_frames.h"

namespace lodemark {
namespace {

// A phone gets one or two in a second; a log of a million of them before its first epoch is none.
constexpr std::size_t kMostWaitingMessages = 10'000;

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

lodemark_status AfterPush(lodemark_log* log, const Status& pushed) {
  log->epoch_waits = !pushed && pushed.error().code == ErrorCode::kQueueFull;
  return pushed ? LODEMARK_OK : Fail(pushed.error());
}

lodemark_status PushEpoch(lodemark_log* log, Session* session) {
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
  return AfterPush(log, session->PushAndroidEpoch(time_ns, epoch));
}

void Keep(LoggedNavigationMessage message, lodemark_log* log) {
  if (message.bytes.empty()) return;
  if (log->messages.size() == kMostWaitingMessages) log->messages.pop_front();
  log->messages.push_back(std::move(message));
}

// Reads to the next epoch. False at the end.
template <typename Epoch, typename Reader, typename Record>
bool NextEpoch(Reader* reader, Record* record, lodemark_log* log) {
  while (reader->Next(record)) {
    if (std::holds_alternative<Epoch>(*record)) return true;
    if (auto* message = std::get_if<LoggedNavigationMessage>(record)) {
      Keep(std::move(*message), log);
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
    return BeginsLikeUbx(path) ? take(UbxReader::Open(path)) : take(GnssLoggerReader::Open(path));
  });
}

void lodemark_log_close(lodemark_log* log) { delete log; }

lodemark_status lodemark_log_push_next(lodemark_log* log, lodemark_session* session) {
  using namespace lodemark;
  if (log == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "log is NULL");
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    if (log->epoch_waits) return PushEpoch(log, session->engine.get());
    return NextEpoch(log) ? PushEpoch(log, session->engine.get()) : AtEnd(*log);
  });
}
