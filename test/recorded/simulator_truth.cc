#include "test/recorded/simulator_truth.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/line_reader.h"
#include "core/logs/parse_number.h"

namespace lodemark::test {
namespace {

// "GPS Time" of the file's second line: 2023-01-08 09:59:00.
constexpr std::int64_t kOrigin_ns = 1'357'207'140 * kSecond_ns;

std::optional<System> SystemOf(std::string_view name) {
  if (name == "GPS") return System::kGps;
  if (name == "GALILEO") return System::kGalileo;
  if (name == "GLONASS") return System::kGlonass;
  if (name == "BeiDou") return System::kBeidou;
  if (name == "Quasi-Zenith") return System::kQzss;
  if (name == "IRNSS") return System::kNavic;
  return std::nullopt;
}

std::vector<std::string_view> Cells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return cells;
}

}  // namespace

SimulatorTruth ReadSimulatorTruth(const std::string& path) {
  SimulatorTruth truth;
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return truth;
  std::string_view line;
  while (lines->Next(&line)) {
    const std::vector<std::string_view> cells = Cells(line);
    if (cells.size() < 40) continue;
    const std::optional<System> system = SystemOf(cells[2]);
    if (!system) continue;
    const auto number = [&](std::size_t i) { return ParseDouble(cells[i]).value_or(0.0); };
    SimulatedSignalPath path_of_signal;
    for (std::size_t i = 0; i < 6; ++i) {
      path_of_signal.pseudorange_m[i] = number(15 + i);
      path_of_signal.ionosphere_m[i] = kSpeedOfLight_mps * number(22 + i);
    }
    path_of_signal.troposphere_m = kSpeedOfLight_mps * number(28);
    const std::int64_t time_ns = kOrigin_ns + std::llround(number(0)) * kMillisecond_ns;
    // GLONASS counts by slot, QZSS by PRN - 192: both stand in the column of identifiers.
    truth[{time_ns, {*system, static_cast<std::uint8_t>(number(3))}}] = path_of_signal;
  }
  return truth;
}

}  // namespace lodemark::test
