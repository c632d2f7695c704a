#include "test/experiments/drive_recording.h"

#include <utility>

#include "core/base/units.h"
#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_observation.h"
#include "core/logs/sp3.h"

namespace lodemark {

std::optional<Eigen::Vector3d> DriveRecording::TruthAt(std::int64_t time_gps_ns) const {
  const std::optional<TrajectoryPoint> at = truth->At(time_gps_ns);
  if (!at || !at->has_position() || !at->height_m) return std::nullopt;
  return EcefFromGeodetic({*at->latitude_deg * kRadiansPerDegree,
                           *at->longitude_deg * kRadiansPerDegree, *at->height_m});
}

Result<DriveRecording> ReadDrive(const std::string& folder) {
  DriveRecording drive;
  ReadReport report;
  const Status navigation = ReadRinexNavigation(
      folder + "/hour1180.21n",
      [&](const NavigationRecord& record) { drive.navigation.push_back(record); }, &report);
  if (!navigation) return navigation.error();
  Result<PreciseOrbits> orbits =
      ReadSp3(folder + "/COD0MGXFIN_20211180000_01D_05M_ORB.SP3.gz", &report);
  if (!orbits) return orbits.error();
  drive.orbits = std::move(*orbits);
  Result<Trajectory> truth = ReadTrajectory(folder + "/truth.csv", &report);
  if (!truth) return truth.error();
  drive.truth = std::move(*truth);
  Result<RinexObservationReader> reader =
      RinexObservationReader::Open(folder + "/Pixel5_GnssLog_first1000.21o.gz");
  if (!reader) return reader.error();
  ObservationEpoch epoch;
  while (reader->Next(&epoch)) drive.epochs.push_back(epoch);
  return drive;
}

}  // namespace lodemark
