#include "core/session/satellite_trust.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Of a satellite nobody has heard of yet.
constexpr double kUnknownTrust = 0.5;

// Streets come and go within seconds.
constexpr double kMemory_s = 2.0;

// A reflection still changes about as the way there does; what fits nothing says nothing.
constexpr double kTrustInReflections = 0.1;
constexpr double kLargestFactor = 100.0;

}  // namespace

double SatelliteTrust::SigmaFactor(SatelliteId satellite) const {
  const auto record =
      std::find_if(satellites_.begin(), satellites_.end(),
                   [&](const Record& known) { return known.satellite == satellite; });
  const double trust = record == satellites_.end() ? kUnknownTrust : record->trust;
  return 1.0 / std::max(trust, 1.0 / kLargestFactor);
}

void SatelliteTrust::Learn(double seconds, const std::vector<PreparedSignal>& signals,
                           std::span<const ObservationVerdict> verdicts) {
  if (!(seconds > 0.0)) return;
  for (Record& record : satellites_) {
    record.heard = 0.0;
    record.ranges = 0;
  }
  for (std::size_t i = 0; i < signals.size() && i < verdicts.size(); ++i) {
    auto record = std::find_if(satellites_.begin(), satellites_.end(), [&](const Record& known) {
      return known.satellite == signals[i].satellite_id;
    });
    if (record == satellites_.end()) {
      record = satellites_.insert(record, Record{signals[i].satellite_id, kUnknownTrust, 0.0, 0});
    }
    record->heard += verdicts[i].weight + kTrustInReflections * verdicts[i].late_share;
    ++record->ranges;
  }
  std::erase_if(satellites_, [](const Record& record) { return record.ranges == 0; });
  const double gain = 1.0 - std::exp(-seconds / kMemory_s);
  for (Record& record : satellites_) {
    record.trust += gain * (record.heard / record.ranges - record.trust);
  }
}

}  // namespace lodemark
