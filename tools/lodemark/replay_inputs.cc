#include "tools/lodemark/replay_inputs.h"

#include <filesystem>

#include "core/logs/recording.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;
using Kind = ReplayInputs::Measurements;

// The option that takes a file of this kind, and what the kind is called.
struct KindUse {
  const char* name;
  const char* option;
};

KindUse UseOf(FileKind kind) {
  switch (kind) {
    case FileKind::kGnssLog:
      return {"a GnssLogger text", "--log"};
    case FileKind::kDeviceGnss:
    case FileKind::kDerived:
      return {"a Kaggle csv", "--log"};
    case FileKind::kRinexObservation:
      return {"a RINEX observation file", "--obs"};
    case FileKind::kRinexNavigation:
      return {"a RINEX navigation file", "--nav"};
    case FileKind::kSp3:
      return {"an SP3 file", "--sp3"};
    case FileKind::kTrajectory:
      return {"a trajectory", nullptr};
    case FileKind::kUbx:
      return {"a u-blox file", "--log"};
    case FileKind::kSensors:
      return {"a table of samples of sensors", nullptr};
    case FileKind::kUnknown:
      break;
  }
  return {"a file of unknown kind", nullptr};
}

// A file that cannot be told by its first lines goes on to its reader, which says what is wrong. A
// pipe can be read only once, so it does too.
Result<FileKind> KindOf(const std::string& path, FileKind otherwise) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored) &&
      !fs::is_directory(path, ignored)) {
    return otherwise;
  }
  const Result<FileKind> kind = SniffFile(path);
  if (kind && *kind == FileKind::kUnknown) return otherwise;
  return kind;
}

Status CheckKind(const std::string& path, FileKind expected, const char* option) {
  const Result<FileKind> kind = KindOf(path, expected);
  if (!kind) return WithAdvice(kind.error(), UseOf(expected).name);
  const KindUse use = UseOf(*kind);
  if (use.option != nullptr && std::string_view(use.option) == option) return {};
  return Error{ErrorCode::kBadData,
               path + ": is " + use.name +
                   (use.option != nullptr ? std::string("; name it with ") + use.option
                                          : std::string("; name ") + UseOf(expected).name)};
}

Status FromFile(const std::string& path, FileKind expected, const char* option,
                ReplayInputs* inputs) {
  const Status checked = CheckKind(path, expected, option);
  if (!checked.ok()) return checked;
  const Result<FileKind> kind = KindOf(path, expected);
  if (!kind) return kind.error();
  inputs->measurements = path;
  inputs->name = fs::path(path).filename().string();
  inputs->kind = *kind == FileKind::kRinexObservation ? Kind::kObservation
                 : *kind == FileKind::kGnssLog        ? Kind::kGnssLog
                 : *kind == FileKind::kUbx            ? Kind::kUbx
                                                      : Kind::kKaggle;
  return {};
}

Status FromFolder(const std::string& folder, ReplayInputs* inputs) {
  std::error_code ignored;
  if (fs::is_regular_file(folder, ignored)) {
    const Result<FileKind> kind = SniffFile(folder);
    if (!kind) return WithAdvice(kind.error(), "a recording folder");
    const char* option = UseOf(*kind).option;
    return Error{ErrorCode::kBadData, folder + ": is a file and no recording folder; " +
                                          (option != nullptr ? std::string("name it with ") + option
                                                             : std::string("name its folder"))};
  }
  const Result<Recording> recording = OpenRecording(folder);
  if (!recording) return WithAdvice(recording.error(), "a recording folder");
  inputs->name = recording->name;
  inputs->remarks = recording->problems;
  inputs->navigation = recording->Files("navigation");
  inputs->precise_orbits = recording->Files("precise_orbits");
  for (const char* role : {"imu", "odometry"}) {
    const auto stated = recording->columns.find(role);
    const std::string columns = stated != recording->columns.end() ? stated->second : "";
    for (const std::string& path : recording->Files(role)) {
      inputs->sensors.push_back({role, path, columns});
    }
  }
  const struct {
    const char* role;
    Kind kind;
  } choices[] = {{"gnss_log", Kind::kGnssLog},
                 {"observation", Kind::kObservation},
                 {"receiver_raw", Kind::kUbx},
                 {"device_gnss", Kind::kKaggle},
                 {"derived", Kind::kKaggle}};
  for (const auto& [role, kind] : choices) {
    const std::vector<std::string>& files = recording->Files(role);
    if (files.empty()) continue;
    inputs->measurements = files.front();
    inputs->kind = kind;
    if (files.size() > 1) {
      inputs->remarks.push_back(folder + ": holds " + std::to_string(files.size()) + " files as " +
                                role + "; the first, " +
                                fs::path(files.front()).filename().string() +
                                ", is replayed: name another with --obs or --log");
    }
    return {};
  }
  return Error{ErrorCode::kBadData,
               folder +
                   ": has no measurements; a recording needs a GnssLogger text, a RINEX "
                   "observation file, a u-blox file or a Kaggle csv"};
}

// Photographs lie in cam0, as in recordings of EuRoC.
Status FindPhotos(const ReplayRequest& request, ReplayInputs* inputs) {
  if (request.map.empty()) return {};
  const fs::path cam0 = fs::path(request.recording) / "cam0";
  const fs::path list = cam0 / "data.csv";
  std::error_code ignored;
  if (request.recording.empty() || !fs::exists(list, ignored)) {
    inputs->remarks.push_back((request.recording.empty() ? "--map" : list.string()) +
                              std::string(": there are no photographs to look up in the map; a "
                                          "recording has them in cam0, listed in cam0/data.csv"));
    return {};
  }
  inputs->photos.list = list.string();
  inputs->photos.folder =
      fs::is_directory(cam0 / "data", ignored) ? (cam0 / "data").string() : cam0.string();
  for (const fs::path& camera :
       {cam0 / "camera.json", fs::path(request.recording) / "camera.json"}) {
    if (!fs::exists(camera, ignored)) continue;
    inputs->photos.camera = camera.string();
    return {};
  }
  return Error{ErrorCode::kBadData, (cam0 / "camera.json").string() +
                                        ": is missing; photographs need the camera that took "
                                        "them, see 'lodemark calibrate'"};
}

}  // namespace

Error WithAdvice(Error error, const std::string& wanted) {
  if (error.message.find("; ") != std::string::npos) return error;
  // What this version cannot read is the file's fault here, not the command line's.
  if (error.code == ErrorCode::kUnsupported) error.code = ErrorCode::kBadData;
  if (error.code == ErrorCode::kIo) error.message += "; check its name and permissions";
  if (error.code == ErrorCode::kBadData) error.message += "; name " + wanted;
  return error;
}

std::string WantedMeasurements(Kind kind) {
  return UseOf(kind == Kind::kObservation ? FileKind::kRinexObservation
               : kind == Kind::kKaggle    ? FileKind::kDeviceGnss
               : kind == Kind::kUbx       ? FileKind::kUbx
                                          : FileKind::kGnssLog)
      .name;
}

Result<ReplayInputs> FindReplayInputs(const ReplayRequest& request) {
  ReplayInputs inputs;
  Status found;
  if (!request.recording.empty()) {
    found = FromFolder(request.recording, &inputs);
  } else if (!request.log.empty()) {
    found = FromFile(request.log, FileKind::kGnssLog, "--log", &inputs);
  } else {
    found = FromFile(request.observation, FileKind::kRinexObservation, "--obs", &inputs);
  }
  if (!found.ok()) return found.error();
  for (const std::string& path : request.navigation) {
    const Status checked = CheckKind(path, FileKind::kRinexNavigation, "--nav");
    if (!checked.ok()) return checked.error();
    inputs.navigation.push_back(path);
  }
  for (const std::string& path : request.precise_orbits) {
    const Status checked = CheckKind(path, FileKind::kSp3, "--sp3");
    if (!checked.ok()) return checked.error();
    inputs.precise_orbits.push_back(path);
  }
  if (request.broadcast_only) inputs.precise_orbits.clear();
  std::error_code ignored;
  // A pipe cannot be read a second time for its samples.
  if (inputs.kind == Kind::kGnssLog && fs::is_regular_file(inputs.measurements, ignored)) {
    inputs.sensors.push_back({"gnss_log", inputs.measurements, ""});
  }
  const Status photos = FindPhotos(request, &inputs);
  if (!photos.ok()) return photos.error();
  return inputs;
}

}  // namespace lodemark
