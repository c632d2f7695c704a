#include "test/recorded/session_replay.h"

#include <memory>
#include <utility>

#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_observation.h"

namespace lodemark::test {
namespace {

bool IsListed(const SignalObservation& signal, const std::string& names) {
  const std::string name = {SystemLetter(signal.satellite.system), signal.signal.band,
                            signal.signal.attribute};
  return names.find(name) != std::string::npos;
}

}  // namespace

std::vector<SessionEstimate> Replay(const ReplayFiles& files, const SessionOptions& options,
                                    const ReplayEdits& edits) {
  Result<std::unique_ptr<Session>> session = Session::Open(options);
  if (!session) return {};
  ReadReport report;
  for (const std::string& path : files.navigation) {
    const Status status = ReadRinexNavigation(
        path,
        [&](const NavigationRecord& record) {
          if (!edits.takes || edits.takes(record)) (void)(*session)->PushNavigation(record);
        },
        &report);
    if (!status.ok()) return {};
  }
  Result<RinexObservationReader> reader = RinexObservationReader::Open(files.observations);
  if (!reader) return {};
  std::vector<SessionEstimate> estimates;
  ObservationEpoch epoch;
  while (reader->Next(&epoch)) {
    if (edits.epoch) edits.epoch(&epoch);
    if (!(*session)->PushObservationEpoch(0, epoch).ok()) return {};
    (*session)->ProcessNext();
    estimates.push_back((*session)->estimate());
  }
  return estimates;
}

std::uint32_t SystemsOf(const std::string& letters) {
  std::uint32_t systems = 0;
  for (int i = 0; i < kSystemCount; ++i) {
    if (letters.find(SystemLetter(static_cast<System>(i))) != std::string::npos) {
      systems |= 1u << i;
    }
  }
  return systems;
}

void KeepSignals(const std::string& names, ObservationEpoch* epoch) {
  std::erase_if(epoch->signals,
                [&](const SignalObservation& signal) { return !IsListed(signal, names); });
}

void DropSignals(const std::string& names, ObservationEpoch* epoch) {
  std::erase_if(epoch->signals,
                [&](const SignalObservation& signal) { return IsListed(signal, names); });
}

}  // namespace lodemark::test
