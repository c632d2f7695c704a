#include "core/session/event_log.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/units.h"

namespace lodemark {
namespace {

const char* WhatJumped(MillisecondJump::Kind kind) {
  using Kind = MillisecondJump::Kind;
  switch (kind) {
    case Kind::kTagCodeAndPhase:
      return "time tag, code and phase";
    case Kind::kTagAndCode:
      return "time tag and code";
    case Kind::kCodeAndPhase:
      return "code and phase";
    case Kind::kCode:
      return "code";
    case Kind::kPhase:
      break;
  }
  return "phase";
}

// Seconds to the millisecond.
std::string Milliseconds(double seconds) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f", seconds);
  return text;
}

const char* WordOf(EstimateStatus status) {
  switch (status) {
    case EstimateStatus::kTooFewSatellites:
      return "too few satellites";
    case EstimateStatus::kNoEphemeris:
      return "no orbits for enough satellites";
    case EstimateStatus::kNotConverged:
      return "the geometry fixes no position";
    case EstimateStatus::kInconsistent:
      return "the ranges do not agree";
    case EstimateStatus::kNoData:
    case EstimateStatus::kFix:
      break;
  }
  return "no measurements";
}

const char* WordOf(SensorKind kind) {
  switch (kind) {
    case SensorKind::kAccelerometer:
      return "accelerometer";
    case SensorKind::kGyroscope:
      return "gyroscope";
    case SensorKind::kBarometer:
      return "barometer";
    case SensorKind::kVehicle:
      break;
  }
  return "vehicle";
}

}  // namespace

void EventLog::SetTime(std::int64_t time_ns, std::int64_t time_gps_ns) {
  time_ns_ = time_ns;
  time_gps_ns_ = time_gps_ns;
}

void EventLog::Add(EventKind kind, double value, std::string text) {
  if (events_.size() == kMostEvents) events_.erase(events_.begin());
  events_.push_back({kind, time_ns_, time_gps_ns_, value, std::move(text)});
}

void EventLog::NoteDiscontinuity() {
  Add(EventKind::kClockDiscontinuity, 0.0,
      "the receiver clock is discontinuous; its bias starts anew");
}

void EventLog::NoteJump(const MillisecondJump& jump) {
  Add(EventKind::kMillisecondJump, jump.milliseconds,
      "the receiver clock jumped by " + std::to_string(jump.milliseconds) + " ms in " +
          WhatJumped(jump.kind) + "; repaired");
}

void EventLog::NoteTimeBackwards(std::int64_t older_by_ns, bool restart) {
  const double older_by_s = 1e-9 * static_cast<double>(older_by_ns);
  Add(EventKind::kTimeBackwards, older_by_s,
      "an epoch " + Milliseconds(older_by_s) + " s older than the last one; " +
          (restart ? "as others before it, so time goes on from there" : "dropped"));
}

void EventLog::NoteDuplicate() {
  Add(EventKind::kDuplicateEpoch, 0.0, "a second epoch of the same time; dropped");
}

void EventLog::NoteOutcome(const SessionEstimate& estimate) {
  const bool fix = estimate.status == EstimateStatus::kFix;
  if (fix && !ever_fixed_) {
    Add(EventKind::kFirstFix, estimate.satellites_used,
        "first position, from " + std::to_string(estimate.satellites_used) + " satellites" +
            (estimate.landmarks_used > 0
                 ? " and " + std::to_string(estimate.landmarks_used) + " landmarks"
                 : ""));
  }
  if (!fix && fix_before_) {
    Add(EventKind::kFixLost, estimate.satellites_seen,
        std::string("no position any more: ") + WordOf(estimate.status));
  }
  fix_before_ = fix;
  ever_fixed_ = ever_fixed_ || fix;
}

void EventLog::NoteFilter(int restarts, bool inertial) {
  if (restarts > restarts_before_) {
    Add(EventKind::kFilterRestarted, restarts,
        "the place carried on fits the measurements no more; the filter begins anew");
  }
  if (inertial != inertial_before_) {
    Add(inertial ? EventKind::kInertialAligned : EventKind::kInertialLost, 0.0,
        inertial ? "it is known how the inertial sensors are turned; they carry the filter"
                 : "inertial sensors carry the filter no more: their samples end, or tell of "
                   "another motion");
  }
  restarts_before_ = restarts;
  inertial_before_ = inertial;
}

void EventLog::NotePhoto(const SessionEstimate& estimate) {
  if (estimate.photo == PhotoOutcome::kNone) return;
  const bool contradicted = estimate.photo == PhotoOutcome::kContradicted;
  if (contradicted && !contradicted_before_) {
    Add(EventKind::kPhotoContradicted, estimate.landmarks_seen,
        "the photograph is of another place than satellites say; left out: is the map of this "
        "place, and still true?");
  }
  contradicted_before_ = contradicted;
}

void EventLog::NoteMapDatum(const std::string& remark) { Add(EventKind::kMapDatum, 0.0, remark); }

void EventLog::NotePhotoFailed(const std::string& reason) {
  if (reason == last_failure_) return;
  last_failure_ = reason;
  Add(EventKind::kPhotoFailed, 0.0, "a photograph could not be looked up: " + reason);
}

void EventLog::NotePhotoTooLate(double late_s) {
  Add(EventKind::kPhotoTooLate, late_s,
      "a photograph " + Milliseconds(late_s) + " s older than what was heard last; dropped");
}

void EventLog::NoteSensorDropped(const SensorSample& sample) {
  const auto kind = static_cast<std::size_t>(sample.kind);
  if (dropped_before_.test(kind)) return;
  dropped_before_.set(kind);
  Add(EventKind::kSensorDropped, static_cast<double>(kind) + 1.0,
      std::string("a sample of the ") + WordOf(sample.kind) +
          " is not later than the one before; it and others like it are dropped");
  events_.back().time_ns = sample.time_ns;
  events_.back().time_gps_ns = 0;
}

void EventLog::NoteEphemerisMissing(const SatelliteStatus& satellite) {
  const auto system = static_cast<std::size_t>(satellite.satellite.system);
  if (system >= without_ephemeris_.size()) return;
  std::bitset<256>& noted = without_ephemeris_[system];
  if (noted.test(satellite.satellite.number)) return;
  noted.set(satellite.satellite.number);
  const bool too_old = satellite.verdict == SatelliteVerdict::kEphemerisTooOld;
  Add(EventKind::kEphemerisMissing, satellite.satellite.number,
      SatelliteName(satellite.satellite) +
          (too_old ? ": no ephemeris near enough in time" : ": no ephemeris"));
}

void EventLog::Reset() { *this = EventLog(); }

}  // namespace lodemark
