// The drive replayed through the layers that a session is made of, with drawn photographs handed
// over as sights instead of images.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/session/session.h"
#include "test/experiments/drive_landmarks.h"
#include "test/experiments/drive_recording.h"

namespace lodemark {

// From first, so many epochs.
struct EpochSpan {
  std::size_t first = 0;
  std::size_t count = 0;

  bool Holds(std::size_t epoch) const { return epoch >= first && epoch < first + count; }
};

struct DriveRun {
  Scheme scheme = Scheme::kJoint;
  bool all_systems = false;  // with precise orbits; else GPS with broadcast ones
  int satellites = 0;        // that the street leaves; 0: all
  EpochSpan outage = {};     // no signal at all
  Estimator estimator = Estimator::kEpoch;
};

// One for each epoch, of its time or, where it has no signals, of the photograph before it.
struct DriveAnswer {
  SessionEstimate estimate;
  Eigen::Matrix3d bound_enu_m2;  // of the photograph alone; not finite where there is none
};

class DriveSession {
 public:
  // Of the recording the first epochs, up to so many.
  DriveSession(const DriveRecording& drive, std::size_t epochs);

  // Photographs, one shortly before each epoch.
  std::vector<std::optional<DrawnPhoto>> Photograph(const Street& street, std::uint64_t seed) const;

  std::vector<DriveAnswer> Replay(const DriveRun& run,
                                  const std::vector<std::optional<DrawnPhoto>>& photos);

  std::size_t epochs() const { return epochs_; }

 private:
  // Satellites of an epoch as a street with buildings on both sides leaves them: those along it,
  // and high ones, first.
  using Ranking = std::vector<SatelliteId>;

  ObservationEpoch Seen(std::size_t epoch, const DriveRun& run) const;
  void RankSatellites();

  const DriveRecording& drive_;
  std::size_t epochs_ = 0;
  EnuFrame frame_{Geodetic{}};
  std::vector<PathPoint> path_;  // at each epoch
  std::vector<Ranking> rankings_;
};

}  // namespace lodemark
