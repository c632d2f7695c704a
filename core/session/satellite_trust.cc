#include "core/session/satellite_trust.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// A reflection still changes about as the way there does; what fits nothing says nothing.
constexpr double kTrustInReflections = 0.1;
constexpr double kLargestFactor = 100.0;

}  // namespace

double TrustIn(const ObservationVerdict& verdict) {
  return verdict.weight + kTrustInReflections * verdict.late_share;
}

double SigmaFactorOfTrust(double trust) { return 1.0 / std::max(trust, 1.0 / kLargestFactor); }

double SatelliteTrust::SigmaFactor(SatelliteId satellite) const {
  const auto record =
      std::find_if(satellites_.begin(), satellites_.end(),
                   [&](const Record& known) { return known.satellite == satellite; });
  return SigmaFactorOfTrust(record == satellites_.end() ? kUnknownTrust : record->trust);
}

void SatelliteTrust::Learn(double seconds, std::span<const RangeSource> sources,
                           std::span<const ObservationVerdict> verdicts) {
  if (!(seconds > 0.0)) return;
  for (Record& record : satellites_) {
    record.heard = 0.0;
    record.ranges = 0;
  }
  for (std::size_t i = 0; i < sources.size() && i < verdicts.size(); ++i) {
    auto record = std::find_if(satellites_.begin(), satellites_.end(), [&](const Record& known) {
      return known.satellite == sources[i].satellite;
    });
    if (record == satellites_.end()) {
      record = satellites_.insert(record, Record{sources[i].satellite, kUnknownTrust, 0.0, 0});
    }
    record->heard += TrustIn(verdicts[i]);
    ++record->ranges;
  }
  std::erase_if(satellites_, [](const Record& record) { return record.ranges == 0; });
  const double gain = 1.0 - std::exp(-seconds / kTrustMemory_s);
  for (Record& record : satellites_) {
    record.trust += gain * (record.heard / record.ranges - record.trust);
  }
}

}  // namespace lodemark
