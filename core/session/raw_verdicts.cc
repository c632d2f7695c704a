#include "core/session/raw_verdicts.h"

#include <algorithm>

namespace lodemark {
namespace {

SatelliteVerdict VerdictOf(RawVerdict verdict) {
  switch (verdict) {
    case RawVerdict::kTimeAmbiguous:
    case RawVerdict::kTimeUncertain:
    case RawVerdict::kClockUnusable:
      return SatelliteVerdict::kTimeAmbiguous;
    case RawVerdict::kImplausibleRange:
      return SatelliteVerdict::kImplausible;
    case RawVerdict::kUnknownSignal:
      return SatelliteVerdict::kUnknownSignal;
    case RawVerdict::kGood:
    case RawVerdict::kUnknownConstellation:
    case RawVerdict::kUnknownSatellite:
    case RawVerdict::kNotTracking:
    case RawVerdict::kDuplicate:
      break;
  }
  return SatelliteVerdict::kNotTracking;
}

// Satellite and signal of a measurement. A signal nobody knows is left blank.
bool Identify(const AndroidMeasurement& measurement, const GlonassChannels& channels,
              SatelliteStatus* status) {
  AndroidSignal signal;
  RawVerdict verdict = IdentifySignal(measurement, channels, &signal);
  const bool unknown_signal = verdict == RawVerdict::kUnknownSignal;
  if (unknown_signal) {
    AndroidMeasurement plain = measurement;
    plain.present &= ~static_cast<std::uint32_t>(kMeasurementHasCarrierFrequency);
    verdict = IdentifySignal(plain, channels, &signal);
  }
  if (verdict != RawVerdict::kGood) return false;
  status->satellite = signal.satellite;
  status->signal = unknown_signal ? SignalCode{' ', ' '} : signal.signal;
  return true;
}

auto SameSignal(const SatelliteStatus& status) {
  return [&status](const SatelliteStatus& other) {
    return other.satellite == status.satellite && other.signal == status.signal;
  };
}

}  // namespace

void CollectRangeless(const AndroidEpoch& epoch, std::span<const RawOutcome> outcomes,
                      const GlonassChannels& channels, std::vector<SatelliteStatus>* rangeless) {
  rangeless->clear();
  for (const RawOutcome& outcome : outcomes) {
    if (outcome.verdict == RawVerdict::kGood || outcome.verdict == RawVerdict::kDuplicate) continue;
    const AndroidMeasurement& measurement = epoch.measurements[outcome.measurement];
    SatelliteStatus status;
    if (!Identify(measurement, channels, &status)) continue;
    if (std::any_of(rangeless->begin(), rangeless->end(), SameSignal(status))) continue;
    status.verdict = VerdictOf(outcome.verdict);
    status.cn0_dbhz = measurement.Has(kMeasurementHasCn0) ? measurement.cn0_dbhz : 0.0;
    rangeless->push_back(status);
  }
}

void MergeRangeless(std::span<const SatelliteStatus> rangeless, std::uint32_t systems,
                    std::vector<SatelliteStatus>* statuses) {
  for (const SatelliteStatus& status : rangeless) {
    const auto found = std::find_if(statuses->begin(), statuses->end(), SameSignal(status));
    if (found == statuses->end()) {
      statuses->push_back(status);
      const bool on = (systems >> static_cast<int>(status.satellite.system) & 1u) != 0;
      if (!on) statuses->back().verdict = SatelliteVerdict::kSystemOff;
    } else if (found->verdict == SatelliteVerdict::kNotTracking) {
      found->verdict = status.verdict;
    }
  }
}

}  // namespace lodemark
