#include "core/logs/kaggle_times.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"

namespace lodemark {
namespace {

// GnssStatus.CONSTELLATION_*
constexpr std::int32_t kGps = 1;
constexpr std::int32_t kGlonass = 3;
constexpr std::int32_t kQzss = 4;
constexpr std::int32_t kBeidou = 5;
constexpr std::int32_t kGalileo = 6;

constexpr std::int32_t kTimeOfWeekStates = 8 | 16384;  // STATE_TOW_DECODED, STATE_TOW_KNOWN

std::int64_t TravelTime(const AndroidMeasurement& measurement) {
  return std::llround(measurement.given_pseudorange_m * 1e9 / kSpeedOfLight_mps -
                      measurement.time_offset_ns);
}

// Whether ReceivedSvTimeNanos is the time of the GPS week.
bool CountsGpsWeek(const AndroidMeasurement& m) {
  const bool runs_with_gps = m.constellation_type == kGps || m.constellation_type == kQzss ||
                             m.constellation_type == kGalileo;
  return runs_with_gps && (m.state & kTimeOfWeekStates) != 0 && m.received_sv_time_ns > 0 &&
         m.received_sv_time_ns < kWeek_ns;
}

std::optional<std::int64_t> TakeMedian(std::vector<std::int64_t>* values) {
  if (values->empty()) return std::nullopt;
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace

std::optional<std::int64_t> ReceptionFromRanges(const std::vector<AndroidMeasurement>& measurements,
                                                const std::vector<TransmitTime>& transmissions,
                                                std::optional<std::int64_t> near_gps_ns) {
  std::vector<std::int64_t> exact_ns;
  std::vector<std::int64_t> of_week_ns;
  std::vector<std::int64_t> rounded_ns;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const AndroidMeasurement& m = measurements[i];
    if (!m.Has(kMeasurementHasGivenPseudorange)) continue;
    const std::int64_t travel_ns = TravelTime(m);
    if (transmissions[i].time_gps_ns) {
      (transmissions[i].rounded ? rounded_ns : exact_ns)
          .push_back(*transmissions[i].time_gps_ns + travel_ns);
    }
    if (near_gps_ns && CountsGpsWeek(m)) {
      of_week_ns.push_back(
          NearestCongruent(m.received_sv_time_ns, kWeek_ns, *near_gps_ns - travel_ns) + travel_ns);
    }
  }
  if (const auto median = TakeMedian(&exact_ns)) return median;
  if (const auto median = TakeMedian(&of_week_ns)) return median;
  return TakeMedian(&rounded_ns);
}

std::int64_t ReceivedSvTime(std::int32_t constellation_type, std::int64_t sent_gps_ns) {
  if (constellation_type == kGlonass) {
    return FloorModulo(ScaleFromGps(sent_gps_ns, TimeScale::kGlonass), kDay_ns);
  }
  const TimeScale scale = constellation_type == kBeidou ? TimeScale::kBeidou : TimeScale::kGps;
  return FloorModulo(ScaleFromGps(sent_gps_ns, scale), kWeek_ns);
}

std::int64_t SentBefore(std::int64_t reception_gps_ns, const AndroidMeasurement& measurement) {
  return reception_gps_ns - TravelTime(measurement);
}

}  // namespace lodemark
