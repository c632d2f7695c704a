// Photographs of a session: waiting, looked up, and joined to the epochs around them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/map/feature_map.h"
#include "core/session/epoch_solver.h"
#include "core/session/event_log.h"
#include "core/session/frame_queue.h"
#include "core/session/motion.h"
#include "core/session/photo_sighting.h"
#include "core/session/session.h"
#include "core/session/sighting_witness.h"

namespace lodemark {

class PhotoFusion {
 public:
  PhotoFusion(Scheme scheme, TimeBase time_base);

  void UseMap(const FeatureMap* map);
  Status Push(const CameraFrame& frame);
  std::size_t queued() const { return queue_.count(); }
  std::int64_t next_time_ns() const { return queue_.front().time_ns; }  // where one is queued

  // Looks the next photograph up and estimates where it was taken, with the last epoch where that
  // is near in time.
  void Look(EpochSolver* solver, SessionEstimate* estimate, std::vector<LandmarkStatus>* landmarks,
            EventLog* events);

  // What the latest photograph gives an epoch of the time; nothing where none is near.
  const PhotoPart& PartAt(std::int64_t time_ns);
  // After the epoch, or photograph, was solved with the last part.
  void Judge(const EpochSolver& solver, SessionEstimate* estimate,
             std::vector<LandmarkStatus>* landmarks) const;
  // An epoch was solved; of a time and a GPS time.
  void NoteEpoch(std::int64_t time_gps_ns, const SessionEstimate& estimate);
  void Forget();

 private:
  std::optional<PlacePrior> PlaceAt(std::int64_t time_ns) const;
  const MapFrame& FrameAt(std::int64_t time_gps_ns, EventLog* events);

  Scheme scheme_;
  TimeBase time_base_;
  const FeatureMap* map_ = nullptr;
  std::optional<MapFrame> map_frame_;  // once the date is known
  MapFrame undated_frame_{EnuFrame(Geodetic{}), 0.0, {}};
  FrameQueue queue_;
  std::optional<PhotoSighting> sighting_;  // the latest
  bool sighting_near_ = false;             // of the moment of the last part
  SightingWitness witness_;
  PhotoPart part_;
  Motion motion_;
  bool has_epoch_ = false;
  std::int64_t epoch_ns_ = 0;
  std::int64_t epoch_gps_ns_ = 0;
  std::optional<SessionEstimate> last_fix_;
};

}  // namespace lodemark
