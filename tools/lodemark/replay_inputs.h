// Which files a replay reads: those of a recording, or those named one by one.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "tools/lodemark/replay_photos.h"
#include "tools/lodemark/replay_sensors.h"

namespace lodemark {

// What the command line names.
struct ReplayRequest {
  std::string recording;  // a folder; or one of the next two
  std::string log;
  std::string observation;
  std::vector<std::string> navigation;
  std::vector<std::string> precise_orbits;
  bool broadcast_only = false;
  std::string map;  // empty: photographs are not looked at
};

struct ReplayInputs {
  enum class Measurements { kGnssLog, kObservation, kKaggle, kUbx };

  std::string name;  // of the recording, or of the file
  Measurements kind = Measurements::kGnssLog;
  std::string measurements;
  std::vector<std::string> navigation;
  std::vector<std::string> precise_orbits;
  std::vector<SensorFile> sensors;   // what may hold samples of sensors
  PhotoFiles photos;                 // where a map is named and the recording has any
  std::vector<std::string> remarks;  // what the user should know, one sentence each
};

// Looks into the files' first lines only. Errors name the file and say what to do.
Result<ReplayInputs> FindReplayInputs(const ReplayRequest& request);

// The error with a word on what to do, unless it has one: wanted is what should have been named.
Error WithAdvice(Error error, const std::string& wanted);

// What should have been named as the measurements.
std::string WantedMeasurements(ReplayInputs::Measurements kind);

}  // namespace lodemark
