#include "tools/lodemark/replay_diagnosis.h"

#include <algorithm>
#include <optional>

#include "core/logs/rinex_navigation.h"
#include "core/logs/sp3.h"
#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

// Broadcast orbits serve for two to four hours around their reference times.
constexpr std::int64_t kOrbitLife_ns = 4LL * 3600 * 1'000'000'000;

struct Span {
  std::int64_t first_gps_ns = 0;
  std::int64_t last_gps_ns = 0;

  void Extend(std::int64_t time_gps_ns) {
    first_gps_ns = std::min(first_gps_ns, time_gps_ns);
    last_gps_ns = std::max(last_gps_ns, time_gps_ns);
  }
};

void Extend(std::int64_t time_gps_ns, std::optional<Span>* span) {
  if (!*span) *span = Span{time_gps_ns, time_gps_ns};
  (*span)->Extend(time_gps_ns);
}

std::optional<Span> NavigationSpan(const std::string& path) {
  std::optional<Span> span;
  ReadReport report;
  const auto take = [&](const NavigationRecord& record) {
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) {
      Extend(kepler->toe_gps_ns, &span);
    }
    if (const auto* state = std::get_if<StateEphemeris>(&record)) Extend(state->toe_gps_ns, &span);
  };
  const Status read = ReadRinexNavigation(path, take, &report);
  return read.ok() ? span : std::nullopt;
}

std::optional<Span> PreciseSpan(const std::string& path) {
  std::optional<Span> span;
  ReadReport report;
  const Result<PreciseOrbits> orbits = ReadSp3(path, &report);
  if (!orbits) return span;
  for (const auto& [satellite, samples] : orbits->samples) {
    if (samples.empty()) continue;
    Extend(samples.front().time_gps_ns, &span);
    Extend(samples.back().time_gps_ns, &span);
  }
  return span;
}

std::string DayText(std::int64_t time_gps_ns) { return CalendarText(time_gps_ns).substr(0, 10); }

std::string DaysText(const Span& span) {
  const std::string first = DayText(span.first_gps_ns);
  const std::string last = DayText(span.last_gps_ns);
  return first == last ? first : first + " to " + last;
}

// Empty if the file's orbits reach the time of the recording.
std::string OfAnotherDay(const std::string& path, const char* what, const char* option,
                         const std::optional<Span>& orbits, const Span& recording) {
  if (!orbits) return "";
  if (orbits->first_gps_ns <= recording.last_gps_ns + kOrbitLife_ns &&
      orbits->last_gps_ns >= recording.first_gps_ns - kOrbitLife_ns) {
    return "";
  }
  return path + ": its " + what + " are of " + DaysText(*orbits) + ", the recording is of " +
         DaysText(recording) + "; name the file of that day with " + option;
}

}  // namespace

std::string WhyNoEstimate(const ReplayInputs& inputs, const MeasurementCounts& counts,
                          const ReplaySummary& summary) {
  const std::string& file = inputs.measurements;
  if (summary.epochs() == 0) {
    if (counts.epochs_refused > 0) {
      return file + ": none of its " + GroupDigits(counts.epochs_refused) +
             " epochs can be used; the first: " + counts.first_refusal;
    }
    return file + ": none of its " + GroupDigits(counts.epochs) +
           " epochs has a GPS time; record for longer, under open sky";
  }
  const Span recording = {*summary.first_gps_ns(), summary.last_gps_ns()};
  const std::string day = DayText(recording.first_gps_ns);
  if (inputs.navigation.empty() && inputs.precise_orbits.empty() && counts.broadcast_taken == 0) {
    return file + ": no orbits are known; name a RINEX navigation file of " + day +
           " with --nav, or an SP3 file with --sp3";
  }
  // A single file that does reach the day makes another one's date beside the point.
  std::string another_day;
  bool reached = counts.broadcast_taken > 0;
  for (const std::string& path : inputs.navigation) {
    const std::string found =
        OfAnotherDay(path, "ephemerides", "--nav", NavigationSpan(path), recording);
    reached = reached || found.empty();
    if (another_day.empty()) another_day = found;
  }
  for (const std::string& path : inputs.precise_orbits) {
    const std::string found =
        OfAnotherDay(path, "precise orbits", "--sp3", PreciseSpan(path), recording);
    reached = reached || found.empty();
    if (another_day.empty()) another_day = found;
  }
  if (!reached) return another_day;

  const std::int64_t without = summary.CountOf(LODEMARK_VERDICT_NO_EPHEMERIS) +
                               summary.CountOf(LODEMARK_VERDICT_EPHEMERIS_TOO_OLD);
  if (summary.signals() > 0 && 2 * without > summary.signals()) {
    return file + ": no valid ephemeris for its satellites; name a RINEX navigation file of " +
           day + " that has them with --nav";
  }
  const std::map<std::string, std::int64_t> outcomes = summary.Outcomes();
  const auto most =
      std::max_element(outcomes.begin(), outcomes.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return file + ": none of its " + GroupDigits(summary.epochs()) + " epochs gives a position, " +
         "mostly for " + most->first + "; see the reasons in satellites.csv";
}

}  // namespace lodemark
