#include "core/gnss/satellite_orbits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/gnss/broadcast_orbit.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/group_delay.h"

namespace lodemark {
namespace {

constexpr std::int64_t kMinute_ns = 60 * kSecond_ns;
constexpr std::int64_t kHour_ns = 60 * kMinute_ns;
constexpr int kNumbers = 64;  // above every LargestSatelliteNumber
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62;

struct KeplerSet {
  std::int64_t sent_ns;  // known or usual time of transmission
  KeplerEphemeris ephemeris;
};

struct StateSet {
  std::int64_t sent_ns;
  StateOrbit orbit;
};

// All that is known of one satellite. Sets ascend in sent_ns.
struct Satellite {
  std::vector<KeplerSet> kepler;
  std::vector<StateSet> states;
  std::vector<PreciseSample> precise;
  std::uint32_t types = 0;   // bit 1 << MessageType of the sets in kepler
  GroupDelays group_delays;  // the last known of each
};

// How far from toe a set may be used: half its fit interval and half an hour more, which bridges a
// late upload. GPS and NavIC sets fit 4 h (IS-GPS-200N 20.3.4.4), those of QZSS 2 h
// (IS-QZSS-PNT-005 4.1.2.4), BeiDou's are hourly and fit 4 h. At these ages 95 % of a day's sets
// were within 10 m of their successors, and within 1 m half an hour before. Galileo's serve 4 h (OS
// SDD 1.3 2.3.1.3). GLONASS sets are half-hourly and meant for 15 min to each side (ICD 5.1
// A.3.1.2); SBAS sets time out in 6 min (DO-229 A.4.4.1).
std::int64_t LargestAge_ns(const KeplerEphemeris& ephemeris) {
  constexpr std::int64_t kAllowance_ns = 30 * kMinute_ns;
  switch (ephemeris.satellite.system) {
    case System::kGalileo:
      return 4 * kHour_ns;
    case System::kQzss:
      return kHour_ns + kAllowance_ns;
    case System::kBeidou:
    case System::kNavic:
      return 2 * kHour_ns + kAllowance_ns;
    default: {
      const double fit_h = ephemeris.fit_interval_s / 3600.0;
      return (fit_h > 4.0 ? 3 * kHour_ns : 2 * kHour_ns) + kAllowance_ns;
    }
  }
}

std::int64_t LargestAge_ns(const StateEphemeris& ephemeris) {
  return ephemeris.satellite.system == System::kSbas ? 6 * kMinute_ns : 30 * kMinute_ns;
}

// Whether a set can be used at all. The element check also rejects what is not finite.
template <typename Ephemeris>
bool IsUsable(const Ephemeris& e, std::int64_t other_ns) {
  const auto is_time = [](std::int64_t time_ns) { return time_ns >= 0 && time_ns < kLatest_ns; };
  return static_cast<int>(e.satellite.system) < kSystemCount && e.satellite.number >= 1 &&
         e.satellite.number <= LargestSatelliteNumber(e.satellite.system) &&
         is_time(e.toe_gps_ns) && is_time(e.transmitted_gps_ns) && is_time(other_ns) &&
         e.accuracy_m >= 0.0 && e.accuracy_m < 1e9 && ImplausibleElement(e).empty();
}

// When a set was sent. Where the file does not say, or says what cannot be, the usual lead over
// toe.
std::int64_t SentTime_ns(System system, std::int64_t transmitted_ns, std::int64_t toe_ns) {
  constexpr std::int64_t kFarthest_ns = 6 * kHour_ns;
  if (transmitted_ns > 0 && std::abs(transmitted_ns - toe_ns) <= kFarthest_ns) {
    return transmitted_ns;
  }
  switch (system) {
    case System::kGps:
    case System::kQzss:
    case System::kNavic:
      return toe_ns - 2 * kHour_ns;
    case System::kGlonass:
      return toe_ns - 15 * kMinute_ns;
    default:
      return toe_ns;
  }
}

std::int64_t Toe_ns(const KeplerSet& set) { return set.ephemeris.toe_gps_ns; }
std::int64_t Toe_ns(const StateSet& set) { return set.orbit.ephemeris().toe_gps_ns; }
std::int64_t LargestAge_ns(const KeplerSet& set) { return LargestAge_ns(set.ephemeris); }
std::int64_t LargestAge_ns(const StateSet& set) { return LargestAge_ns(set.orbit.ephemeris()); }

// The set to use at a time among those that fits accepts.
template <typename Set, typename Fits>
const Set* SelectSet(const std::vector<Set>& sets, std::int64_t time_ns, const Fits& fits) {
  const auto usable = [&](const Set& set) {
    return std::abs(time_ns - Toe_ns(set)) <= LargestAge_ns(set) && fits(set);
  };
  const auto future = std::upper_bound(
      sets.begin(), sets.end(), time_ns,
      [](std::int64_t value_ns, const Set& set) { return value_ns < set.sent_ns; });
  for (auto set = future; set != sets.begin();) {
    if (usable(*--set)) return &*set;
  }
  const Set* nearest = nullptr;
  for (auto set = future; set != sets.end(); ++set) {
    if (!usable(*set)) continue;
    if (nearest == nullptr ||
        std::abs(time_ns - Toe_ns(*set)) < std::abs(time_ns - Toe_ns(*nearest))) {
      nearest = &*set;
    }
  }
  return nearest;
}

// Message types in the order in which a signal would have them: Galileo's own message first, as its
// clock is made for the signal; else the message with most sets.
std::span<const MessageType> PreferredTypes(System system, SignalCode signal) {
  using enum MessageType;
  static constexpr std::array<MessageType, 2> kFnavFirst = {kFnav, kInav};
  static constexpr std::array<MessageType, 2> kInavFirst = {kInav, kFnav};
  static constexpr std::array<MessageType, 5> kBeidou = {kD1, kD2, kCnav1, kCnav2Beidou, kCnav3};
  static constexpr std::array<MessageType, 4> kOthers = {kLnav, kCnav, kCnav2, kL1Nav};
  switch (system) {
    case System::kGalileo:
      return signal.band == '5' ? kFnavFirst : kInavFirst;
    case System::kBeidou:
      return kBeidou;
    default:
      return kOthers;
  }
}

constexpr std::uint32_t TypeBit(MessageType type) { return 1u << static_cast<unsigned>(type); }

const KeplerEphemeris* SelectKepler(const Satellite& satellite, System system, SignalCode signal,
                                    std::int64_t time_ns) {
  for (const MessageType type : PreferredTypes(system, signal)) {
    if ((satellite.types & TypeBit(type)) == 0) continue;
    const KeplerSet* set = SelectSet(satellite.kepler, time_ns, [type](const KeplerSet& candidate) {
      return candidate.ephemeris.type == type;
    });
    if (set != nullptr) return &set->ephemeris;
  }
  return nullptr;
}

bool IsSame(const KeplerEphemeris& a, const KeplerEphemeris& b) {
  return a.toe_gps_ns == b.toe_gps_ns && a.toc_gps_ns == b.toc_gps_ns && a.type == b.type &&
         a.issue_of_data == b.issue_of_data && a.issue_of_clock == b.issue_of_clock &&
         a.health == b.health && a.healthy == b.healthy;
}

bool IsSame(const StateEphemeris& a, const StateEphemeris& b) {
  return a.toe_gps_ns == b.toe_gps_ns && a.type == b.type && a.health == b.health &&
         a.healthy == b.healthy && a.position_in_ecef == b.position_in_ecef;
}

// Puts the set behind those sent no later; at the limit the first goes. False if that is the set.
template <typename Set>
bool Insert(Set set, std::vector<Set>* sets) {
  const auto place =
      std::upper_bound(sets->begin(), sets->end(), set, [](const Set& a, const Set& b) {
        return a.sent_ns != b.sent_ns ? a.sent_ns < b.sent_ns : Toe_ns(a) < Toe_ns(b);
      });
  const bool full = sets->size() >= SatelliteOrbits::kMostSets;
  if (full && place == sets->begin()) return false;
  sets->insert(place, std::move(set));
  if (full) sets->erase(sets->begin());
  return true;
}

// A time as whole nanoseconds and a fraction of at most half of one.
struct Instant {
  std::int64_t whole_ns = 0;
  double fraction_s = 0.0;
};

Instant Normalised(std::int64_t time_ns, double fraction_s) {
  const double whole_ns = std::round(fraction_s * 1e9);
  return {time_ns + static_cast<std::int64_t>(whole_ns), fraction_s - 1e-9 * whole_ns};
}

// Empty for what is no time, so that no later difference can overflow.
std::optional<Instant> MakeInstant(std::int64_t time_ns, double fraction_s) {
  if (!(std::abs(fraction_s) < 1e6) || time_ns < 0 || time_ns >= kLatest_ns) return std::nullopt;
  return Normalised(time_ns, fraction_s);
}

// What answers for one signal at one time.
struct Source {
  const Satellite* satellite = nullptr;
  const KeplerEphemeris* kepler = nullptr;  // this or
  const StateOrbit* orbit = nullptr;        // this or neither
  OrbitVerdict broadcast = OrbitVerdict::kNoEphemeris;
};

Source SelectSource(const Satellite& satellite, SatelliteId id, SignalCode signal,
                    std::int64_t time_ns) {
  Source source{.satellite = &satellite};
  if (satellite.kepler.empty() && satellite.states.empty()) return source;
  bool healthy = true;
  source.kepler = SelectKepler(satellite, id.system, signal, time_ns);
  if (source.kepler != nullptr) {
    healthy = source.kepler->healthy;
  } else {
    const StateSet* set =
        SelectSet(satellite.states, time_ns, [](const StateSet&) { return true; });
    if (set == nullptr) {
      source.broadcast = OrbitVerdict::kTooOld;
      return source;
    }
    source.orbit = &set->orbit;
    healthy = set->orbit.ephemeris().healthy;
  }
  source.broadcast = healthy ? OrbitVerdict::kGood : OrbitVerdict::kUnhealthy;
  return source;
}

// What the signal's group delay adds to the clock.
double DelayCorrection(const Source& source, SatelliteId id, SignalCode signal, ClockSource clock) {
  if (id.system == System::kGlonass) {
    const double l2_delay_s = source.orbit == nullptr ? 0.0 : source.orbit->ephemeris().l2_delay_s;
    return GlonassDelayCorrection(signal, clock, l2_delay_s);
  }
  GroupDelays delays = source.satellite->group_delays;
  if (source.kepler == nullptr) {
    return GroupDelayCorrection(id, signal, clock, MessageType::kLnav, delays);
  }
  UpdateGroupDelays(source.kepler->group_delays, &delays);
  return GroupDelayCorrection(id, signal, clock, source.kepler->type, delays);
}

// The relativistic term of a precise clock, -2 r.v / c^2, and its rate for a Kepler orbit
// (IS-GPS-200N 20.3.3.3.3.1).
void AddRelativity(const PreciseState& precise, SatelliteState* state) {
  constexpr double kGm_m3ps2 = 3.986004418e14;
  constexpr double kEarthRotation_radps = 7.2921151467e-5;
  constexpr double kFactor = -2.0 / (kSpeedOfLight_mps * kSpeedOfLight_mps);
  const Eigen::Vector3d& position = precise.position_in_ecef;
  const Eigen::Vector3d inertial =
      precise.velocity_in_ecef +
      kEarthRotation_radps * Eigen::Vector3d(-position.y(), position.x(), 0.0);
  state->clock_bias_s += kFactor * position.dot(inertial);
  state->clock_drift_sps += kFactor * (inertial.squaredNorm() - kGm_m3ps2 / position.norm());
}

bool EvaluatePrecise(const Source& source, SatelliteId id, SignalCode signal,
                     const Instant& instant, SatelliteState* state) {
  const std::optional<PreciseState> precise =
      InterpolatePrecise(source.satellite->precise, instant.whole_ns, instant.fraction_s);
  if (!precise) return false;
  *state = SatelliteState{};
  state->position_in_ecef = precise->position_in_ecef;
  state->velocity_in_ecef = precise->velocity_in_ecef;
  state->clock_bias_s =
      precise->clock_bias_s + DelayCorrection(source, id, signal, ClockSource::kPrecise);
  state->clock_drift_sps = precise->clock_drift_sps;
  AddRelativity(*precise, state);
  // Samples that lie on no orbit can give any velocity.
  if (!(std::abs(state->clock_bias_s) < 1.0)) return false;
  const auto& samples = source.satellite->precise;
  const auto after = std::upper_bound(
      samples.begin(), samples.end(), instant.whole_ns,
      [](std::int64_t time_ns, const PreciseSample& s) { return time_ns < s.time_gps_ns; });
  state->accuracy_m = (after == samples.begin() ? *after : *(after - 1)).position_sigma_m;
  state->reference_gps_ns = instant.whole_ns;
  state->precise = true;
  if (source.orbit != nullptr) state->glonass_channel = source.orbit->ephemeris().glonass_channel;
  return true;
}

void EvaluateBroadcast(const Source& source, const Instant& instant, double delay_s,
                       SatelliteState* state) {
  *state = SatelliteState{};
  BroadcastState broadcast;
  if (source.kepler != nullptr) {
    broadcast = KeplerState(*source.kepler, instant.whole_ns, instant.fraction_s);
    state->accuracy_m = source.kepler->accuracy_m;
    state->reference_gps_ns = source.kepler->toe_gps_ns;
    state->issue_of_data = source.kepler->issue_of_data;
  } else {
    broadcast = source.orbit->At(instant.whole_ns, instant.fraction_s);
    const StateEphemeris& ephemeris = source.orbit->ephemeris();
    state->accuracy_m = ephemeris.accuracy_m;
    state->reference_gps_ns = ephemeris.toe_gps_ns;
    state->glonass_channel = ephemeris.glonass_channel;
  }
  state->position_in_ecef = broadcast.position_in_ecef;
  state->velocity_in_ecef = broadcast.velocity_in_ecef;
  state->clock_bias_s = broadcast.clock_bias_s + delay_s;
  state->clock_drift_sps = broadcast.clock_drift_sps;
}

// The clock without relativity, from which the time of transmission is known to 0.2 microseconds.
double FirstClock(const Source& source, const Instant& instant) {
  return source.kepler != nullptr
             ? KeplerClockPolynomial(*source.kepler, instant.whole_ns, instant.fraction_s)
             : source.orbit->ClockBias(instant.whole_ns, instant.fraction_s);
}

}  // namespace

struct SatelliteOrbits::Impl {
  std::array<std::array<Satellite, kNumbers>, kSystemCount> satellites;

  Satellite* Find(SatelliteId id) {
    const auto system = static_cast<std::size_t>(id.system);
    if (system >= satellites.size() || id.number >= kNumbers) return nullptr;
    return &satellites[system][id.number];
  }
};

SatelliteOrbits::SatelliteOrbits() : impl_(std::make_unique<Impl>()) {}
SatelliteOrbits::~SatelliteOrbits() = default;
SatelliteOrbits::SatelliteOrbits(SatelliteOrbits&&) noexcept = default;
SatelliteOrbits& SatelliteOrbits::operator=(SatelliteOrbits&&) noexcept = default;

bool SatelliteOrbits::Add(const KeplerEphemeris& ephemeris) {
  if (!IsUsable(ephemeris, ephemeris.toc_gps_ns)) return false;
  Satellite& satellite = *impl_->Find(ephemeris.satellite);
  const std::int64_t sent_ns =
      SentTime_ns(ephemeris.satellite.system, ephemeris.transmitted_gps_ns, ephemeris.toe_gps_ns);
  for (const KeplerSet& set : satellite.kepler) {
    if (IsSame(set.ephemeris, ephemeris)) return false;
  }
  if (!Insert(KeplerSet{sent_ns, ephemeris}, &satellite.kepler)) return false;
  satellite.types |= TypeBit(ephemeris.type);
  UpdateGroupDelays(ephemeris.group_delays, &satellite.group_delays);
  return true;
}

bool SatelliteOrbits::Add(const StateEphemeris& ephemeris) {
  if (!IsUsable(ephemeris, ephemeris.toe_gps_ns) || !(std::abs(ephemeris.l2_delay_s) < 1e-6)) {
    return false;
  }
  Satellite& satellite = *impl_->Find(ephemeris.satellite);
  const std::int64_t sent_ns =
      SentTime_ns(ephemeris.satellite.system, ephemeris.transmitted_gps_ns, ephemeris.toe_gps_ns);
  for (const StateSet& set : satellite.states) {
    if (IsSame(set.orbit.ephemeris(), ephemeris)) return false;
  }
  return Insert(StateSet{sent_ns, StateOrbit(ephemeris)}, &satellite.states);
}

void SatelliteOrbits::Add(const PreciseOrbits& orbits) {
  const auto earlier = [](const PreciseSample& a, const PreciseSample& b) {
    return a.time_gps_ns < b.time_gps_ns;
  };
  const auto same_time = [](const PreciseSample& a, const PreciseSample& b) {
    return a.time_gps_ns == b.time_gps_ns;
  };
  for (const auto& [id, added] : orbits.samples) {
    Satellite* satellite = impl_->Find(id);
    if (satellite == nullptr) continue;
    // What is added comes first among equal times, so that unique keeps it.
    std::vector<PreciseSample> merged;
    merged.reserve(added.size() + satellite->precise.size());
    for (const PreciseSample& sample : added) {
      if (sample.time_gps_ns >= 0 && sample.time_gps_ns < kLatest_ns &&
          sample.position_in_ecef.norm() < 1e9 && std::abs(sample.clock_bias_s) < 1.0) {
        merged.push_back(sample);
      }
    }
    merged.insert(merged.end(), satellite->precise.begin(), satellite->precise.end());
    std::stable_sort(merged.begin(), merged.end(), earlier);
    merged.erase(std::unique(merged.begin(), merged.end(), same_time), merged.end());
    if (merged.size() > kMostSamples) {
      merged.erase(merged.begin(), merged.end() - static_cast<std::ptrdiff_t>(kMostSamples));
    }
    satellite->precise = std::move(merged);
  }
}

OrbitVerdict SatelliteOrbits::AtTransmission(SatelliteId satellite, SignalCode signal,
                                             std::int64_t time_gps_ns, double pseudorange_m,
                                             double receiver_clock_s, SatelliteState* state) const {
  const Satellite* known = impl_->Find(satellite);
  // The satellite's own reading at transmission.
  const std::optional<Instant> reading =
      MakeInstant(time_gps_ns, receiver_clock_s - pseudorange_m / kSpeedOfLight_mps);
  if (known == nullptr || !reading) return OrbitVerdict::kNoEphemeris;
  const Source source = SelectSource(*known, satellite, signal, reading->whole_ns);
  if (source.broadcast == OrbitVerdict::kUnhealthy) return source.broadcast;

  Instant sent = *reading;
  double applied_s = 0.0;  // reading less sent
  const auto apply = [&](double clock_s) {
    applied_s = clock_s;
    sent = Normalised(reading->whole_ns, reading->fraction_s - clock_s);
  };
  if (EvaluatePrecise(source, satellite, signal, *reading, state)) {
    apply(state->clock_bias_s);
    if (!EvaluatePrecise(source, satellite, signal, sent, state)) return OrbitVerdict::kTooOld;
  } else {
    if (source.broadcast != OrbitVerdict::kGood) return source.broadcast;
    const double delay_s = DelayCorrection(source, satellite, signal, ClockSource::kBroadcast);
    apply(FirstClock(source, *reading) + delay_s);
    EvaluateBroadcast(source, sent, delay_s, state);
  }
  // What the clock there says anew, below a microsecond, moves the satellite by millimetres.
  const double late_s = state->clock_bias_s - applied_s;
  state->position_in_ecef -= late_s * state->velocity_in_ecef;
  state->transmitted_gps_ns = Normalised(sent.whole_ns, sent.fraction_s - late_s).whole_ns;
  return OrbitVerdict::kGood;
}

OrbitVerdict SatelliteOrbits::AtTime(SatelliteId satellite, SignalCode signal,
                                     std::int64_t time_gps_ns, double fraction_s,
                                     SatelliteState* state) const {
  const Satellite* known = impl_->Find(satellite);
  const std::optional<Instant> instant = MakeInstant(time_gps_ns, fraction_s);
  if (known == nullptr || !instant) return OrbitVerdict::kNoEphemeris;
  const Source source = SelectSource(*known, satellite, signal, instant->whole_ns);
  if (source.broadcast == OrbitVerdict::kUnhealthy) return source.broadcast;
  if (!EvaluatePrecise(source, satellite, signal, *instant, state)) {
    if (source.broadcast != OrbitVerdict::kGood) return source.broadcast;
    EvaluateBroadcast(source, *instant,
                      DelayCorrection(source, satellite, signal, ClockSource::kBroadcast), state);
  }
  state->transmitted_gps_ns = instant->whole_ns;
  return OrbitVerdict::kGood;
}

std::int8_t SatelliteOrbits::GlonassChannel(int slot) const {
  if (slot < 1 || slot >= kNumbers) return kUnknownGlonassChannel;
  const auto glonass = static_cast<std::size_t>(System::kGlonass);
  const std::vector<StateSet>& sets =
      impl_->satellites[glonass][static_cast<std::size_t>(slot)].states;
  for (auto set = sets.rbegin(); set != sets.rend(); ++set) {
    const std::int8_t channel = set->orbit.ephemeris().glonass_channel;
    if (channel != kUnknownGlonassChannel) return channel;
  }
  return kUnknownGlonassChannel;
}

}  // namespace lodemark
