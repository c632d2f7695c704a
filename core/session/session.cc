#include "core/session/session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/units.h"
#include "core/fusion/clock_biases.h"
#include "core/fusion/coarse_position.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/velocity_adjustment.h"
#include "core/gnss/android_observables.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/satellite_orbits.h"
#include "core/session/accuracy.h"
#include "core/session/gnss_epoch.h"
#include "core/session/range_weights.h"

namespace lodemark {
namespace {

constexpr std::size_t kMaxEvents = 256;
constexpr double kFarFromStart_m = 1000.0;

EstimateStatus StatusOf(PointStatus status) {
  switch (status) {
    case PointStatus::kGood:
      return EstimateStatus::kFix;
    case PointStatus::kTooFew:
      return EstimateStatus::kTooFewSatellites;
    case PointStatus::kNotConverged:
      return EstimateStatus::kNotConverged;
    case PointStatus::kInconsistent:
      break;
  }
  return EstimateStatus::kInconsistent;
}

}  // namespace

struct Session::Impl {
  explicit Impl(const SessionOptions& session_options)
      : options(session_options), model(session_options) {}

  struct QueuedEpoch {
    std::int64_t time_ns = 0;
    ObservationEpoch epoch;
  };

  void Note(EventKind kind, double value, std::string text) {
    if (events.size() == kMaxEvents) events.erase(events.begin());
    events.push_back({kind, estimate.time_ns, estimate.time_gps_ns, value, std::move(text)});
  }

  void Process(const QueuedEpoch& queued);
  void Solve(const ObservationEpoch& epoch);
  void SolveVelocity(const ObservationEpoch& epoch);
  void Learn();

  SessionOptions options;
  SatelliteOrbits orbits;
  IonosphereModel ionosphere;
  AndroidObservables android;
  std::vector<RawOutcome> raw_outcomes;

  // A ring of epochs, so that pushing reuses their memory.
  std::vector<QueuedEpoch> ring;
  std::size_t first = 0;
  std::size_t count = 0;

  GnssEpochModel model;
  RangeWeights weights;
  CodeRateCheck code_rate;
  ClockBiases biases;
  PointAdjustment adjustment;
  PointEstimate point;
  std::vector<ObservationVerdict> verdicts;
  VelocityEstimate velocity;
  std::vector<RateVerdict> rate_verdicts;
  std::optional<Eigen::Vector3d> last_place_in_ecef;  // only where to linearise
  std::int64_t last_gps_ns = 0;
  bool had_fix = false;

  SessionEstimate estimate;
  std::vector<SatelliteStatus> statuses;
  std::vector<SessionEvent> events;
};

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::Open(const SessionOptions& options) {
  if (options.queue_capacity < 1 || options.queue_capacity > 100'000) {
    return Error{ErrorCode::kInvalidArgument, "session options: queue_capacity must be 1..100000"};
  }
  auto impl = std::make_unique<Impl>(options);
  impl->ring.resize(static_cast<std::size_t>(options.queue_capacity));
  return std::unique_ptr<Session>(new Session(std::move(impl)));
}

Status Session::PushObservationEpoch(std::int64_t time_ns, const ObservationEpoch& epoch) {
  Impl& s = *impl_;
  if (s.count == s.ring.size()) {
    return Error{ErrorCode::kQueueFull, "session: the queue of epochs is full; process first"};
  }
  Impl::QueuedEpoch& slot = s.ring[(s.first + s.count) % s.ring.size()];
  slot.time_ns = s.options.time_base == TimeBase::kGps ? epoch.time_gps_ns : time_ns;
  slot.epoch = epoch;
  ++s.count;
  return {};
}

Status Session::PushAndroidEpoch(std::int64_t time_ns, const AndroidEpoch& epoch) {
  Impl& s = *impl_;
  if (s.count == s.ring.size()) {
    return Error{ErrorCode::kQueueFull, "session: the queue of epochs is full; process first"};
  }
  Impl::QueuedEpoch& slot = s.ring[(s.first + s.count) % s.ring.size()];
  s.android.Convert(epoch, &slot.epoch, &s.raw_outcomes);
  slot.time_ns = s.options.time_base == TimeBase::kGps ? slot.epoch.time_gps_ns : time_ns;
  ++s.count;
  return {};
}

Status Session::PushNavigation(const NavigationRecord& record) {
  Impl& s = *impl_;
  if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) s.orbits.Add(*kepler);
  if (const auto* state = std::get_if<StateEphemeris>(&record)) s.orbits.Add(*state);
  if (const auto* ionosphere = std::get_if<IonosphereMessage>(&record)) {
    s.ionosphere.Add(*ionosphere);
  }
  return {};
}

Status Session::PushPreciseOrbits(const PreciseOrbits& orbits) {
  impl_->orbits.Add(orbits);
  return {};
}

Status Session::PushNavigationMessage(std::int32_t, std::int32_t, std::int32_t, std::int32_t,
                                      std::span<const std::uint8_t>) {
  return {};
}

bool Session::ProcessNext() {
  Impl& s = *impl_;
  if (s.count == 0) return false;
  const Impl::QueuedEpoch& queued = s.ring[s.first];
  s.first = (s.first + 1) % s.ring.size();
  --s.count;
  s.Process(queued);
  return true;
}

void Session::Impl::Process(const QueuedEpoch& queued) {
  const ObservationEpoch& epoch = queued.epoch;
  estimate = SessionEstimate();
  estimate.time_ns = queued.time_ns;
  estimate.time_gps_ns = epoch.time_gps_ns;
  statuses.assign(epoch.signals.size(), SatelliteStatus());
  if (last_gps_ns != 0 && epoch.time_gps_ns > last_gps_ns) {
    biases.Advance(1e-9 * static_cast<double>(epoch.time_gps_ns - last_gps_ns));
  }
  last_gps_ns = epoch.time_gps_ns;
  Solve(epoch);
  had_fix = estimate.status == EstimateStatus::kFix;
}

void Session::Impl::Solve(const ObservationEpoch& epoch) {
  model.FindSatellites(epoch, orbits, &statuses);
  model.NoteStrengths(epoch, &weights);
  const std::vector<double>& disagreements_m = code_rate.Update(epoch);
  std::optional<Eigen::Vector3d> place = last_place_in_ecef;
  if (!place) place = CoarsePosition(model.CoarseRanges(epoch));
  if (!place) {
    estimate.status = EstimateStatus::kTooFewSatellites;
    return;
  }
  PointStatus status = PointStatus::kTooFew;
  for (int pass = 0; pass < 3; ++pass) {
    model.Model(epoch, *place, ionosphere, weights, disagreements_m, &statuses);
    PointOptions point_options;
    status = adjustment.Solve(model.ranges(), *place, biases, point_options, &point, &verdicts);
    if (status != PointStatus::kGood) break;
    const double moved_m = (point.position_in_ecef - *place).norm();
    place = point.position_in_ecef;
    if (moved_m < kFarFromStart_m) break;
  }
  estimate.status = StatusOf(status);
  if (status != PointStatus::kGood) {
    last_place_in_ecef.reset();
    return;
  }
  last_place_in_ecef = point.position_in_ecef;
  estimate.position_in_ecef = point.position_in_ecef;
  estimate.position = GeodeticFromEcef(point.position_in_ecef);
  estimate.covariance_enu_m2 = point.covariance_enu_m2;
  estimate.accuracy_m = RadiusOfProbability(point.covariance_enu_m2.topLeftCorner<2, 2>(), 0.68);
  estimate.vertical_accuracy_m = std::sqrt(point.covariance_enu_m2(2, 2)) * 0.9945;
  estimate.clock_bias_m = point.clock_m;
  estimate.sources = 1;
  for (std::size_t i = 0; i < model.used_signals().size(); ++i) {
    const PreparedSignal& prepared = model.used_signals()[i];
    SatelliteStatus& satellite = statuses[prepared.index];
    const ObservationVerdict& verdict = verdicts[i];
    satellite.has_residual = true;
    satellite.residual_m = verdict.residual_m;
    satellite.weight = verdict.weight;
    satellite.verdict = !verdict.observable     ? SatelliteVerdict::kUnobservable
                        : verdict.weight >= 0.5 ? SatelliteVerdict::kUsed
                        : verdict.weight >= 0.1 ? SatelliteVerdict::kDownWeighted
                                                : SatelliteVerdict::kOutlier;
    if (verdict.used) ++estimate.satellites_used;
  }
  SolveVelocity(epoch);
  Learn();
}

void Session::Impl::SolveVelocity(const ObservationEpoch&) {
  if (!AdjustVelocity(model.rates(), &velocity, &rate_verdicts)) return;
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(estimate.position);
  estimate.has_velocity = true;
  estimate.velocity_enu_mps = enu_from_ecef * velocity.velocity_in_ecef_mps;
  estimate.velocity_covariance_enu_m2ps2 =
      enu_from_ecef * velocity.covariance_ecef_m2ps2 * enu_from_ecef.transpose();
  estimate.speed_accuracy_mps =
      RadiusOfProbability(estimate.velocity_covariance_enu_m2ps2.topLeftCorner<2, 2>(), 0.68);
  estimate.clock_drift_mps = velocity.clock_drift_mps;
  for (std::size_t i = 0; i < rate_verdicts.size(); ++i) {
    SatelliteStatus& satellite = statuses[model.rate_signals()[i]];
    satellite.has_rate_residual = true;
    satellite.range_rate_residual_mps = rate_verdicts[i].residual_mps;
  }
}

void Session::Impl::Learn() {
  if (options.learn_biases) {
    for (int group = 0; group < kMaxClockGroups; ++group) {
      if (point.groups_seen >> group & 1u) {
        biases.Set(group, point.biases[static_cast<std::size_t>(group)]);
      }
    }
  }
  if (point.redundancy <= 0) return;
  const double share =
      static_cast<double>(point.redundancy) / static_cast<double>(model.used_signals().size());
  for (std::size_t i = 0; i < model.used_signals().size(); ++i) {
    const PreparedSignal& prepared = model.used_signals()[i];
    weights.Learn(prepared.clock_group, prepared.weight, verdicts[i].residual_m, share,
                  verdicts[i].weight, verdicts[i].late_share);
  }
  weights.FinishEpoch();
}

std::int32_t Session::queued() const { return static_cast<std::int32_t>(impl_->count); }
const SessionEstimate& Session::estimate() const { return impl_->estimate; }
std::span<const SatelliteStatus> Session::satellites() const { return impl_->statuses; }
std::span<const SessionEvent> Session::events() const { return impl_->events; }
void Session::ClearEvents() { impl_->events.clear(); }

void Session::Reset() {
  Impl& s = *impl_;
  s.android.Reset();
  s.first = 0;
  s.count = 0;
  s.model.Forget();
  s.weights.Forget();
  s.code_rate.Forget();
  s.biases.Forget();
  s.last_place_in_ecef.reset();
  s.last_gps_ns = 0;
  s.had_fix = false;
  s.estimate = SessionEstimate();
  s.statuses.clear();
  s.events.clear();
}

}  // namespace lodemark
