// The Pixel 5 drive of the recordings for checking, ready to be replayed: epochs, orbits and where
// the phone truly was.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/gnss/precise_orbits.h"
#include "core/logs/trajectory.h"

namespace lodemark {

struct DriveRecording {
  std::vector<ObservationEpoch> epochs;
  std::vector<NavigationRecord> navigation;  // broadcast, GPS
  std::optional<PreciseOrbits> orbits;       // all systems
  std::optional<Trajectory> truth;

  // In ECEF; empty where the truth has none.
  std::optional<Eigen::Vector3d> TruthAt(std::int64_t time_gps_ns) const;
};

// folder: of the recording gnss/pixel5_mtv_20210428.
Result<DriveRecording> ReadDrive(const std::string& folder);

}  // namespace lodemark
