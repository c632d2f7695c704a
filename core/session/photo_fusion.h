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
#include "core/session/photo_level.h"
#include "core/session/photo_sighting.h"
#include "core/session/session.h"
#include "core/session/sight_lines.h"
#include "core/session/sighting_witness.h"

namespace lodemark {

class PhotoFusion {
 public:
  explicit PhotoFusion(const SessionOptions& options);

  // What epochs and photographs leave behind for those to come.
  struct Memory {
    Motion motion;
    bool has_epoch = false;
    std::int64_t epoch_ns = 0;
    std::int64_t epoch_gps_ns = 0;
    std::optional<SessionEstimate> last_fix;
  };
  const Memory& memory() const { return past_; }
  void GoBackTo(const Memory& memory) { past_ = memory; }

  // Fails, and uses none, if the map's buildings are damaged.
  Status UseMap(const FeatureMap* map);
  bool has_map() const { return map_ != nullptr; }
  Status Push(const CameraFrame& frame);
  std::size_t queued() const { return queue_.count(); }
  std::int64_t next_time_ns() const { return queue_.front().time_ns; }  // where one is queued

  // What the map's buildings leave in sight at a time, from where the receiver must be by then;
  // null if the map has none.
  SightSource* SightsAt(std::int64_t time_ns, std::int64_t time_gps_ns, EventLog* events);

  // Gives the next photograph what is up and where it looks by the phone's attitude at its time, or
  // at least what is up by the accelerometer, if it has nothing better.
  void Hold(const SensorBuffer& sensors, const std::optional<DeviceAttitude>& attitude);

  // Looks the next photograph up and estimates where it was taken, with the last epoch where that
  // is near in time.
  void Look(EpochSolver* solver, SessionEstimate* estimate, std::vector<LandmarkStatus>* landmarks,
            EventLog* events);
  // What it was found to show; nothing if it could not be looked up.
  const std::optional<PhotoSighting>& sighting() const { return sighting_; }
  // The time of a photograph, and its GPS time if that is known.
  void SetTime(std::int64_t time_ns, SessionEstimate* estimate) const;
  // The next photograph is not looked at.
  void Drop() { queue_.Pop(); }

  // The same for one whose landmarks were found otherwise.
  void Take(PhotoSighting sighting, EpochSolver* solver, SessionEstimate* estimate,
            std::vector<LandmarkStatus>* landmarks);
  // The same for one of a time that was looked at before.
  void TakeAgain(std::int64_t time_ns, const std::optional<PhotoSighting>& sighting,
                 EpochSolver* solver, SessionEstimate* estimate,
                 std::vector<LandmarkStatus>* landmarks);

  // What the latest photograph gives an epoch of the time; nothing where none is near.
  const PhotoPart& PartAt(std::int64_t time_ns);
  // What an epoch is to be adjusted with: nothing where a filter has heard the photograph already.
  const PhotoPart& PartForEpoch(std::int64_t time_ns);
  // After the epoch, or photograph, was solved with the last part.
  void Judge(const EpochSolver& solver, SessionEstimate* estimate,
             std::vector<LandmarkStatus>* landmarks) const;
  // An epoch was solved; of a time and a GPS time.
  void NoteEpoch(std::int64_t time_gps_ns, const SessionEstimate& estimate);
  void Forget();

 private:
  void EstimateAtSighting(EpochSolver* solver, SessionEstimate* estimate,
                          std::vector<LandmarkStatus>* landmarks);
  std::optional<PlacePrior> PlaceAt(std::int64_t time_ns) const;
  std::optional<PlacePrior> PredictedPlaceAt(std::int64_t time_ns) const;
  const MapFrame& FrameAt(std::int64_t time_gps_ns, EventLog* events);

  Scheme scheme_;
  Estimator estimator_;
  TimeBase time_base_;
  const FeatureMap* map_ = nullptr;
  std::optional<MapFrame> map_frame_;  // once the date is known
  MapFrame undated_frame_{EnuFrame(Geodetic{}), 0.0, {}};
  SightLines sights_;
  FrameQueue queue_;
  std::optional<PhotoSighting> sighting_;  // the latest
  bool sighting_near_ = false;             // of the moment of the last part
  SightingWitness witness_;
  PhotoPart part_;
  Memory past_;
};

}  // namespace lodemark
