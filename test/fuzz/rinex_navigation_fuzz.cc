// Any bytes as a RINEX navigation file, and what was read written and read once more.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>
#include <vector>

#include "core/gnss/broadcast_rules.h"
#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_navigation_writer.h"

namespace {

using lodemark::NavigationRecord;

void Require(bool law) {
  if (!law) std::abort();
}

bool IsTime(std::int64_t time_gps_ns) {
  constexpr std::int64_t kYear2200_ns = 7'000'000'000'000'000'000;
  return time_gps_ns > -kYear2200_ns && time_gps_ns < kYear2200_ns;
}

void Check(const NavigationRecord& record) {
  if (const auto* kepler = std::get_if<lodemark::KeplerEphemeris>(&record)) {
    Require(lodemark::ImplausibleElement(*kepler).empty());
    Require(kepler->accuracy_m >= 0.0 && kepler->fit_interval_s >= 0.0);
    Require(IsTime(kepler->toe_gps_ns) && IsTime(kepler->transmitted_gps_ns));
  } else if (const auto* state = std::get_if<lodemark::StateEphemeris>(&record)) {
    Require(lodemark::ImplausibleElement(*state).empty());
    Require(IsTime(state->toe_gps_ns) && IsTime(state->transmitted_gps_ns));
    Require(std::isfinite(state->l2_delay_s) && std::isfinite(state->age_days));
  } else if (const auto* offset = std::get_if<lodemark::TimeOffsetMessage>(&record)) {
    Require(std::abs(offset->a0_s) < 1.0 && IsTime(offset->reference_gps_ns));
  }
}

std::vector<NavigationRecord> Read(std::string_view bytes, lodemark::ReadReport* report) {
  std::vector<NavigationRecord> records;
  lodemark::LineReader lines = lodemark::LineReader::FromMemory("input", bytes);
  const lodemark::Status status = lodemark::ReadRinexNavigation(
      &lines, [&](const NavigationRecord& record) { records.push_back(record); }, report);
  Require(status.ok() || !status.error().message.empty());
  return records;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  lodemark::ReadReport report;
  const std::vector<NavigationRecord> records = Read(bytes, &report);
  for (const NavigationRecord& record : records) Check(record);
  Require(report.problems.size() <= lodemark::ReadReport::kKeptProblems);

  const auto file = lodemark::WriteRinexNavigation(records, {});
  lodemark::ReadReport report_again;
  const std::vector<NavigationRecord> again = Read(file.text, &report_again);
  Require(again.size() <= records.size());
  for (const NavigationRecord& record : again) Check(record);
  return 0;
}
