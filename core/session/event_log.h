// What happened that a user may want to be told, the latest of it.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/gnss/millisecond_jump.h"
#include "core/session/session.h"

namespace lodemark {

// Writes the sentences of events. Allocates only when there is one.
class EventLog {
 public:
  static constexpr std::size_t kMostEvents = 256;

  // Time that the events to come are stamped with.
  void SetTime(std::int64_t time_ns, std::int64_t time_gps_ns);

  void NoteDiscontinuity();
  void NoteJump(const MillisecondJump& jump);
  // An epoch older by so much than the last one; a restart is not dropped.
  void NoteTimeBackwards(std::int64_t older_by_ns, bool restart);
  void NoteDuplicate();
  // To be called once an epoch that was not dropped; of it follow first fix and fix lost.
  void NoteOutcome(const SessionEstimate& estimate);
  // restarts: how often the filter has begun anew.
  void NoteFilter(int restarts, bool inertial);
  // At most one event per satellite.
  void NoteEphemerisMissing(const SatelliteStatus& satellite);

  // Once per run of such photographs.
  void NotePhoto(const SessionEstimate& estimate);
  void NotePhotoFailed(const std::string& reason);
  // It is so much older than the newest moment, and was dropped.
  void NotePhotoTooLate(double late_s);
  void NoteMapDatum(const std::string& remark);
  // At most one event per sensor, at the sample's own time; its value is the number of the kind
  // from 1.
  void NoteSensorDropped(const SensorSample& sample);

  std::span<const SessionEvent> events() const { return events_; }
  void Clear() { events_.clear(); }
  // Forgets what was said about fixes and satellites too.
  void Reset();

 private:
  void Add(EventKind kind, double value, std::string text);

  std::int64_t time_ns_ = 0;
  std::int64_t time_gps_ns_ = 0;
  bool fix_before_ = false;  // at the epoch before
  bool ever_fixed_ = false;
  int restarts_before_ = 0;
  bool inertial_before_ = false;
  bool contradicted_before_ = false;
  std::string last_failure_;
  std::bitset<kSensorKindCount> dropped_before_;
  std::array<std::bitset<256>, kSystemCount> without_ephemeris_;
  std::vector<SessionEvent> events_;
};

}  // namespace lodemark
