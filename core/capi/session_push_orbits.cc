// Where the satellites are: files from memory, and messages as they were broadcast.
#include <string>
#include <string_view>

#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/session_handle.h"
#include "core/capi/structs.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"
#include "core/logs/rinex_navigation.h"
#include "core/logs/sp3.h"

namespace lodemark {
namespace {

// Longer than any message of any system.
constexpr std::size_t kLongestMessage = 4096;

lodemark_status CheckFile(const lodemark_session* session, const void* bytes,
                          const lodemark_read_report* report) {
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  if (bytes == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "bytes is NULL");
  if (report == nullptr) return LODEMARK_OK;
  return CheckStruct<lodemark_read_report>(report, {"report"});
}

void Write(const ReadReport& from, lodemark_read_report* report) {
  if (report == nullptr) return;
  lodemark_read_report to = {};
  to.rows_read = from.rows_read;
  to.rows_skipped = from.rows_skipped;
  to.rows_unknown = from.rows_unknown;
  if (!from.problems.empty()) {
    const std::string text = FormatProblem(from.file, from.problems.front());
    CopyText(text.data(), text.size(), to.first_problem, sizeof to.first_problem);
  }
  WriteStruct(to, report);
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_session_push_navigation(lodemark_session* session, const char* name,
                                                 const void* bytes, size_t byte_count,
                                                 lodemark_read_report* report) {
  using namespace lodemark;
  return Guard([&] {
    const lodemark_status status = CheckFile(session, bytes, report);
    if (status != LODEMARK_OK) return status;
    LineReader lines = LineReader::FromMemory(name != nullptr ? name : "navigation",
                                              {static_cast<const char*>(bytes), byte_count});
    ReadReport read;
    const auto take = [&](const NavigationRecord& record) {
      (void)session->engine->PushNavigation(record);
    };
    const Status done = ReadRinexNavigation(&lines, take, &read);
    Write(read, report);
    return StatusOf(done);
  });
}

lodemark_status lodemark_session_push_precise_orbits(lodemark_session* session, const char* name,
                                                     const void* bytes, size_t byte_count,
                                                     lodemark_read_report* report) {
  using namespace lodemark;
  return Guard([&] {
    const lodemark_status status = CheckFile(session, bytes, report);
    if (status != LODEMARK_OK) return status;
    LineReader lines = LineReader::FromMemory(name != nullptr ? name : "precise orbits",
                                              {static_cast<const char*>(bytes), byte_count});
    ReadReport read;
    const Result<PreciseOrbits> orbits = ReadSp3(&lines, &read);
    Write(read, report);
    if (!orbits) return Fail(orbits.error());
    return StatusOf(session->engine->PushPreciseOrbits(*orbits));
  });
}

lodemark_status lodemark_session_push_broadcast(lodemark_session* session,
                                                const lodemark_broadcast_message* message,
                                                const uint8_t* bytes, size_t byte_count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    lodemark_broadcast_message stated = {};
    lodemark_status status = ReadStruct(message, {"message"}, &stated);
    if (status != LODEMARK_OK) return status;
    Check check({"message"});
    check.Reserved(static_cast<std::uint32_t>(stated.reserved));
    status = check.status();
    if (status != LODEMARK_OK) return status;
    if (bytes == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "bytes is NULL");
    if (byte_count == 0 || byte_count > kLongestMessage) {
      return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "byte_count is that of no message");
    }
    return StatusOf(session->engine->PushNavigationMessage(
        stated.type, stated.svid, stated.message_id, stated.submessage_id, {bytes, byte_count}));
  });
}
