// Recorded logs, pushed into a session.
#include <memory>
#include <utility>
#include <variant>

#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/log_handle.h"
#include "core/capi/session_handle.h"

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

lodemark_status PushEpoch(lodemark_log* log, Session* session) {
  PushMessages(log, session);
  const auto& epoch = std::get<AndroidEpoch>(log->record);
  const AndroidClock& clock = epoch.clock;
  const std::int64_t time_ns =
      clock.Has(kClockHasElapsedRealtime) ? clock.elapsed_realtime_ns : clock.time_ns;
  log->epoch_waits = false;
  if (const lodemark_status status = CheckTimes(epoch, time_ns); status != LODEMARK_OK) {
    return status;
  }
  const Status pushed = session->PushAndroidEpoch(time_ns, epoch);
  log->epoch_waits = !pushed && pushed.error().code == ErrorCode::kQueueFull;
  return pushed ? LODEMARK_OK : Fail(pushed.error());
}

lodemark_status AtEnd(const lodemark_log& log) {
  if (!log.reader.status()) return Fail(log.reader.status().error());
  if (log.epoch_seen) return LODEMARK_END_OF_LOG;
  const ReadReport& report = log.reader.report();
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
    Result<GnssLoggerReader> reader = GnssLoggerReader::Open(path);
    if (!reader) return Fail(reader.error());
    *log = new lodemark_log(std::move(reader).value());
    return lodemark_status{LODEMARK_OK};
  });
}

void lodemark_log_close(lodemark_log* log) { delete log; }

lodemark_status lodemark_log_push_next(lodemark_log* log, lodemark_session* session) {
  using namespace lodemark;
  if (log == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "log is NULL");
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    if (log->epoch_waits) return PushEpoch(log, session->engine.get());
    while (log->reader.Next(&log->record)) {
      if (auto* message = std::get_if<LoggedNavigationMessage>(&log->record)) {
        if (message->bytes.empty()) continue;
        if (log->messages.size() == kMostWaitingMessages) log->messages.pop_front();
        log->messages.push_back(std::move(*message));
      } else if (std::holds_alternative<AndroidEpoch>(log->record)) {
        log->epoch_seen = true;
        return PushEpoch(log, session->engine.get());
      }
    }
    return AtEnd(*log);
  });
}
