// Lets a session hear epochs and photographs, one after the other, and once more what a photograph
// that came late belongs before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/session/epoch_solver.h"
#include "core/session/event_log.h"
#include "core/session/photo_fusion.h"
#include "core/session/recent_moments.h"
#include "core/session/session.h"
#include "core/session/smoothed_way.h"

namespace lodemark {

struct HeardMoment {
  SessionEstimate estimate;
  std::vector<SatelliteStatus> satellites;
  std::vector<LandmarkStatus> landmarks;
};

class MomentHearing {
 public:
  // All of them stay.
  MomentHearing(const SessionOptions& options, const SensorBuffer* sensors, EpochSolver* solver,
                PhotoFusion* photos, SmoothedWay* way, EventLog* events)
      : options_(options),
        sensors_(sensors),
        solver_(solver),
        photos_(photos),
        way_(way),
        events_(events),
        recent_(options) {}

  // Before each of these, and before what is dropped.
  void Begin();
  // An epoch of a time, its clock repaired. The times of *heard are given.
  void HearEpoch(std::int64_t time_ns, const ObservationEpoch& epoch, HeardMoment* heard);
  // The next photograph. False if it is dropped, as it came too late.
  bool HearPhoto(HeardMoment* heard);
  // To be called once for each, and for what was dropped, when all of the estimate is known.
  void Finish(HeardMoment* heard);

  // Nothing is gone back behind this.
  void Forget();

 private:
  // What was known before a time; gives its place among those remembered.
  std::size_t GoBackTo(std::int64_t time_ns);
  bool RemembersMoments() const;
  void Save(std::int64_t time_ns, std::int64_t time_gps_ns, RecentMoment* moment) const;
  void Play(std::int64_t time_ns, const ObservationEpoch& epoch, HeardMoment* heard);
  void HearAgain(RecentMoment* moment);

  SessionOptions options_;
  const SensorBuffer* sensors_;
  EpochSolver* solver_;
  PhotoFusion* photos_;
  SmoothedWay* way_;
  EventLog* events_;
  RecentMoments recent_;
  std::optional<std::size_t> present_;  // of these, the one that is being heard
  bool begun_ = false;                  // and not finished
  HeardMoment again_;
};

}  // namespace lodemark
