#include "tools/lodemark/replay_orbits.h"

#include <cstddef>

#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

constexpr std::size_t kLargestOrbitFile_bytes = 512u * 1024 * 1024;

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
