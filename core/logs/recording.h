// A recording: a folder of files that belong together, and what each of them is for.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace lodemark {

// What a file is, as its first lines or messages tell.
enum class FileKind : std::uint8_t {
  kUnknown,
  kGnssLog,           // GnssLogger text
  kRinexObservation,  // Hatanaka-compressed or not
  kRinexNavigation,
  kSp3,
  kDeviceGnss,  // Kaggle 2022 and 2023
  kDerived,     // Kaggle 2021
  kTrajectory,  // truth.csv or trajectory.csv
  kUbx,         // of a u-blox receiver
  kSensors,     // a table of samples of inertial sensors, a barometer or a vehicle, with a header
};

// Fails if the file cannot be opened or is empty.
Result<FileKind> SniffFile(const std::string& path);

// The role a file of this kind has in a manifest; empty for kUnknown.
std::string_view RoleOf(FileKind kind);

struct Recording {
  std::string folder;
  std::string name;
  std::string device;  // empty if unstated
  bool has_manifest = false;
  // Role ("gnss_log", "observation", "receiver_raw", "navigation", "precise_orbits", "device_gnss",
  // "derived", "truth", "base_observation", ...) to the paths of its files. Every file was there.
  std::map<std::string, std::vector<std::string>, std::less<>> files;
  std::optional<Eigen::Vector3d> static_in_ecef;  // metres, of a receiver at rest
  std::optional<Eigen::Vector3d> base_in_ecef;
  // Of tables without a header line: role ("imu", "odometry") to the header that they lack.
  std::map<std::string, std::string, std::less<>> columns;
  // What of the manifest could not be used, one sentence each.
  std::vector<std::string> problems;

  // Empty if the recording has none.
  const std::vector<std::string>& Files(std::string_view role) const;
  // The first of them, if any.
  std::optional<std::string> File(std::string_view role) const;
};

// By the folder's manifest.json, or without one by looking into its files, in the order of their
// names: a truth is a trajectory whose file name begins with "truth". Fails if the path is no
// folder, the manifest is not a JSON object with an object "files", or nothing usable is found.
Result<Recording> OpenRecording(const std::string& folder);

}  // namespace lodemark
