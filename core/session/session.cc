#include "core/session/session.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/units.h"
#include "core/gnss/android_observables.h"
#include "core/gnss/millisecond_jump.h"
#include "core/gnss/navigation_message.h"
#include "core/session/distinct_satellites.h"
#include "core/session/epoch_order.h"
#include "core/session/epoch_solver.h"
#include "core/session/event_log.h"
#include "core/session/glonass_slots.h"
#include "core/session/moment_hearing.h"
#include "core/session/photo_fusion.h"
#include "core/session/raw_verdicts.h"
#include "core/session/smoothed_way.h"

namespace lodemark {
namespace {

// Android's svid of GLONASS satellites given by channel.
constexpr int kFirstChannelSvid = 93;
constexpr int kLastChannelSvid = 106;
constexpr std::int32_t kGlonassConstellation = 3;  // GnssStatus.CONSTELLATION_GLONASS

// GLONASS satellites rise and set by some degrees meanwhile.
constexpr std::int64_t kNameSlotsEvery_ns = 300 * kSecond_ns;

bool NamesChannels(const AndroidEpoch& epoch) {
  return std::any_of(epoch.measurements.begin(), epoch.measurements.end(),
                     [](const AndroidMeasurement& measurement) {
                       return measurement.constellation_type == kGlonassConstellation &&
                              measurement.svid >= kFirstChannelSvid &&
                              measurement.svid <= kLastChannelSvid;
                     });
}

}  // namespace

struct Session::Impl {
  explicit Impl(const SessionOptions& session_options)
      : options(session_options),
        solver(session_options, &sensors),
        photos(session_options),
        hearing(session_options, &sensors, &solver, &photos, &way, &events) {}

  struct QueuedEpoch {
    std::int64_t time_ns = 0;
    ObservationEpoch epoch;
    std::vector<SatelliteStatus> rangeless;  // raw measurements without a range
  };

  // The place in the queue for one more; null if there is none.
  QueuedEpoch* NextSlot() {
    return count == ring.size() ? nullptr : &ring[(first + count) % ring.size()];
  }
  void Enqueue(QueuedEpoch* slot, std::int64_t time_ns);
  void Add(NavigationRecord record);

  // False if the epoch is to be dropped.
  bool Admit(QueuedEpoch* queued);
  void ProcessEpoch();
  void ProcessFrame();
  void Process(QueuedEpoch* queued);
  void NameGlonassSlots();

  SessionOptions options;
  EpochSolver solver;
  NavigationMessageDecoder messages;
  std::vector<NavigationRecord> records;
  std::int64_t last_pushed_gps_ns = 0;

  AndroidObservables android;
  std::vector<RawOutcome> raw_outcomes;
  bool names_channels = false;  // the phone gives channels for GLONASS satellites
  std::int64_t slots_named_gps_ns = 0;

  // A ring of epochs, so that pushing reuses their memory.
  std::vector<QueuedEpoch> ring;
  std::size_t first = 0;
  std::size_t count = 0;

  EpochOrder order;
  MillisecondJumpRepair jumps;
  bool discontinuity = false;  // of an epoch that was dropped
  HeardMoment heard;           // the latest
  PhotoFusion photos;
  SensorBuffer sensors;
  EventLog events;
  SmoothedWay way;
  MomentHearing hearing;
};

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::Open(const SessionOptions& options) {
  if (options.queue_capacity < 1 || options.queue_capacity > 4096) {
    return Error{ErrorCode::kInvalidArgument, "options.queue_capacity is not within 1..4096"};
  }
  auto impl = std::make_unique<Impl>(options);
  impl->ring.resize(static_cast<std::size_t>(options.queue_capacity));
  return std::unique_ptr<Session>(new Session(std::move(impl)));
}

namespace {

Error QueueFull() {
  return {ErrorCode::kQueueFull, "session: the queue of epochs is full; process first"};
}

}  // namespace

Status Session::PushObservationEpoch(std::int64_t time_ns, const ObservationEpoch& epoch) {
  Impl::QueuedEpoch* slot = impl_->NextSlot();
  if (slot == nullptr) return QueueFull();
  slot->epoch = epoch;
  slot->rangeless.clear();
  impl_->Enqueue(slot, time_ns);
  return {};
}

Status Session::PushAndroidEpoch(std::int64_t time_ns, const AndroidEpoch& epoch) {
  Impl& s = *impl_;
  Impl::QueuedEpoch* slot = s.NextSlot();
  if (slot == nullptr) return QueueFull();
  s.android.Convert(epoch, &slot->epoch, &s.raw_outcomes);
  CollectRangeless(epoch, s.raw_outcomes, s.android.glonass_channels(), &slot->rangeless);
  s.names_channels = s.names_channels || NamesChannels(epoch);
  s.Enqueue(slot, time_ns);
  return {};
}

void Session::Impl::Enqueue(QueuedEpoch* slot, std::int64_t time_ns) {
  slot->time_ns = options.time_base == TimeBase::kGps ? slot->epoch.time_gps_ns : time_ns;
  if (slot->epoch.time_gps_ns != 0) last_pushed_gps_ns = slot->epoch.time_gps_ns;
  ++count;
}

void Session::Impl::Add(NavigationRecord record) {
  if (auto* kepler = std::get_if<KeplerEphemeris>(&record)) {
    kepler->healthy = kepler->healthy || options.accept_unhealthy;
    solver.orbits().Add(*kepler);
  } else if (auto* state = std::get_if<StateEphemeris>(&record)) {
    state->healthy = state->healthy || options.accept_unhealthy;
    solver.orbits().Add(*state);
    if (state->satellite.system == System::kGlonass) {
      android.glonass_channels().SetChannel(state->satellite.number, state->glonass_channel);
    }
  } else if (const auto* ionosphere = std::get_if<IonosphereMessage>(&record)) {
    solver.ionosphere().Add(*ionosphere);
  }
}

Status Session::PushNavigation(const NavigationRecord& record) {
  impl_->Add(record);
  return {};
}

Status Session::PushPreciseOrbits(const PreciseOrbits& orbits) {
  impl_->solver.orbits().Add(orbits);
  return {};
}

Status Session::PushNavigationMessage(std::int32_t type, std::int32_t svid, std::int32_t,
                                      std::int32_t, std::span<const std::uint8_t> bytes) {
  Impl& s = *impl_;
  if (s.last_pushed_gps_ns == 0) {
    return Error{ErrorCode::kOutOfOrder,
                 "navigation message: no epoch has given a GPS time yet; push epochs first"};
  }
  s.records.clear();
  const MessageVerdict verdict =
      s.messages.Push(type, svid, bytes, s.last_pushed_gps_ns, &s.records);
  for (NavigationRecord& record : s.records) s.Add(std::move(record));
  switch (verdict) {
    case MessageVerdict::kTaken:
    case MessageVerdict::kUnused:
      break;
    case MessageVerdict::kUnknownType:
      return Error{ErrorCode::kUnsupported,
                   "navigation message: type " + std::to_string(type) + " is not decoded"};
    case MessageVerdict::kUnknownSatellite:
      return Error{ErrorCode::kBadData, "navigation message: svid " + std::to_string(svid) +
                                            " is no satellite of the message's system"};
    case MessageVerdict::kUnknownTime:
      return Error{ErrorCode::kOutOfOrder,
                   "navigation message: the last epoch's GPS time is not between 1980 and 2100"};
    case MessageVerdict::kMalformed:
      return Error{ErrorCode::kBadData, "navigation message: svid " + std::to_string(svid) +
                                            ": too short or not of its type"};
    case MessageVerdict::kBadParity:
      return Error{ErrorCode::kBadData,
                   "navigation message: svid " + std::to_string(svid) + ": parity does not fit"};
  }
  return {};
}

Status Session::UseMap(const FeatureMap* map) {
  impl_->hearing.Forget();
  return impl_->photos.UseMap(map);
}

Status Session::PushFrame(const CameraFrame& frame) { return impl_->photos.Push(frame); }

Status Session::PushSensors(std::span<const SensorSample> samples) {
  // What can fail comes first.
  for (const SensorSample& sample : samples) impl_->sensors.Prepare(sample.kind);
  for (const SensorSample& sample : samples) {
    if (!impl_->sensors.Push(sample)) impl_->events.NoteSensorDropped(sample);
  }
  return {};
}

bool Session::ProcessNext() {
  Impl& s = *impl_;
  const bool has_frame = s.photos.queued() > 0;
  if (s.count == 0 && !has_frame) return false;
  // Of the same time the photograph first, so that the epoch has it.
  const bool frame_first =
      has_frame && (s.count == 0 || s.photos.next_time_ns() <= s.ring[s.first].time_ns);
  s.hearing.Begin();
  s.heard.estimate = SessionEstimate();
  s.heard.satellites.clear();
  s.heard.landmarks.clear();
  if (frame_first) {
    s.ProcessFrame();
  } else {
    s.ProcessEpoch();
  }
  s.hearing.Finish(&s.heard);
  const EpochFilter& filter = s.solver.filter();
  s.events.NoteFilter(filter.restarts(), filter.inertial());
  return true;
}

void Session::Impl::ProcessEpoch() {
  QueuedEpoch* queued = &ring[first];
  first = (first + 1) % ring.size();
  --count;
  if (count == 0) first = 0;  // the same few slots again and again
  heard.estimate.time_ns = queued->time_ns;
  heard.estimate.time_gps_ns = queued->epoch.time_gps_ns;
  events.SetTime(queued->time_ns, queued->epoch.time_gps_ns);
  if (Admit(queued)) Process(queued);
}

void Session::Impl::ProcessFrame() {
  if (!hearing.HearPhoto(&heard)) return;
  events.NotePhoto(heard.estimate);
  events.NoteOutcome(heard.estimate);
}

bool Session::Impl::Admit(QueuedEpoch* queued) {
  ObservationEpoch& epoch = queued->epoch;
  if (epoch.time_gps_ns == 0) return true;  // no time, nothing to put in order
  const std::int64_t older_by_ns = order.OlderBy(epoch.time_gps_ns);
  const EpochPlace place = order.Judge(epoch.time_gps_ns);
  if (place == EpochPlace::kDuplicate) events.NoteDuplicate();
  if (place == EpochPlace::kBackwards || place == EpochPlace::kRestart) {
    events.NoteTimeBackwards(older_by_ns, place == EpochPlace::kRestart);
  }
  if (place == EpochPlace::kRestart) {
    jumps.Reset();
    solver.ForgetTime();
    hearing.Forget();
  }
  epoch.clock_discontinuity = epoch.clock_discontinuity || discontinuity;
  const bool dropped = place == EpochPlace::kDuplicate || place == EpochPlace::kBackwards;
  discontinuity = dropped && epoch.clock_discontinuity;
  return !dropped;
}

void Session::Impl::Process(QueuedEpoch* queued) {
  ObservationEpoch& epoch = queued->epoch;
  if (const std::optional<MillisecondJump> jump = jumps.Repair(&epoch)) events.NoteJump(*jump);
  if (epoch.clock_discontinuity) events.NoteDiscontinuity();
  hearing.HearEpoch(queued->time_ns, epoch, &heard);
  SessionEstimate& estimate = heard.estimate;
  events.NotePhoto(estimate);
  if (estimate.status == EstimateStatus::kFix) NameGlonassSlots();
  MergeRangeless(queued->rangeless, options.systems, &heard.satellites);
  DistinctSatellites seen;
  for (const SatelliteStatus& status : heard.satellites) {
    seen.Add(status.satellite);
    if (status.verdict == SatelliteVerdict::kNoEphemeris ||
        status.verdict == SatelliteVerdict::kEphemerisTooOld) {
      events.NoteEphemerisMissing(status);
    }
  }
  estimate.satellites_seen = seen.count();
  events.NoteOutcome(estimate);
}

void Session::Impl::NameGlonassSlots() {
  if (!names_channels) return;
  const SessionEstimate& estimate = heard.estimate;
  const std::int64_t since_ns = estimate.time_gps_ns - slots_named_gps_ns;
  if (slots_named_gps_ns != 0 && since_ns >= 0 && since_ns < kNameSlotsEvery_ns) return;
  slots_named_gps_ns = estimate.time_gps_ns;
  NameVisibleSlots(solver.orbits(), estimate.time_gps_ns, estimate.position_in_ecef,
                   &android.glonass_channels());
}

std::int32_t Session::queued() const {
  return static_cast<std::int32_t>(impl_->count + impl_->photos.queued());
}
const SessionEstimate& Session::estimate() const { return impl_->heard.estimate; }
std::span<const SatelliteStatus> Session::satellites() const { return impl_->heard.satellites; }
std::span<const LandmarkStatus> Session::landmarks() const { return impl_->heard.landmarks; }
std::span<const SessionEvent> Session::events() const { return impl_->events.events(); }
std::vector<SessionEstimate> Session::Smoothed() const {
  return impl_->way.Estimates(impl_->solver.filter());
}
void Session::ClearEvents() { impl_->events.Clear(); }

void Session::Reset() {
  Impl& s = *impl_;
  s.android.Reset();
  s.last_pushed_gps_ns = 0;
  s.slots_named_gps_ns = 0;
  s.first = 0;
  s.count = 0;
  s.solver.Forget();
  s.order.Forget();
  s.jumps.Reset();
  s.discontinuity = false;
  s.heard = HeardMoment();
  s.photos.Forget();
  s.sensors.Forget();
  s.events.Reset();
  s.way.Forget();
  s.hearing.Forget();
}

}  // namespace lodemark
