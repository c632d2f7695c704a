#include "tools/lodemark/replay_orbits.h"

#include <cstddef>

#include "core/logs/rinex_navigation_writer.h"
#include "tools/lodemark/broadcast_messages.h"
#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

constexpr std::size_t kLargestOrbitFile_bytes = 512u * 1024 * 1024;

// A receiver that starts warm has orbits that its file tells only later, so all that the file tells
// is known from its first epoch on. Of several sets those already sent come first.
Status PushBroadcast(const std::string& path, ReplaySession* session) {
  const Result<std::vector<NavigationRecord>> records = ReadUbxBroadcast(path);
  if (!records) return records.error();
  if (records->empty()) return {};
  lodemark_read_report report;
  return session->PushNavigation(path, WriteRinexNavigation(*records, {}).text, &report);
}

}  // namespace

Status PushOrbits(const ReplayInputs& inputs, ReplaySession* session,
                  std::vector<std::string>* remarks) {
  const auto push = [&](const std::string& path, auto method, const char* wanted) -> Status {
    const Result<std::string> content = ReadFileWhole(path, kLargestOrbitFile_bytes);
    if (!content) return WithAdvice(content.error(), wanted);
    lodemark_read_report report;
    const Status pushed = (session->*method)(path, *content, &report);
    if (!pushed.ok()) return WithAdvice(pushed.error(), wanted);
    if (report.rows_skipped > 0) {
      remarks->push_back(path + ": " + GroupDigits(report.rows_skipped) +
                         " malformed records skipped, the first: " + report.first_problem);
    }
    return {};
  };
  if (inputs.kind == ReplayInputs::Measurements::kUbx) {
    const Status pushed = PushBroadcast(inputs.measurements, session);
    if (!pushed.ok()) return WithAdvice(pushed.error(), "a u-blox file");
  }
  for (const std::string& path : inputs.navigation) {
    const Status pushed = push(path, &ReplaySession::PushNavigation, "a RINEX navigation file");
    if (!pushed.ok()) return pushed;
  }
  for (const std::string& path : inputs.precise_orbits) {
    const Status pushed = push(path, &ReplaySession::PushPreciseOrbits, "an SP3 file");
    if (!pushed.ok()) return pushed;
  }
  return {};
}

}  // namespace lodemark
