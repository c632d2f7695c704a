// A whole simulated recording: every file of it, by name.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "tools/simulator/scenario.h"

namespace lodemark {

// File names and their content: gnss_log.txt, the navigation file, truth.csv, manifest.json, and
// between buildings signal_paths.csv and buildings.geojson.
using RecordingFiles = std::map<std::string, std::string>;

// The same files, to the last byte, for the same scenario. progress, if not empty, is called with
// the share done.
RecordingFiles MakeRecording(const Scenario& scenario, const std::function<void(double)>& progress);

}  // namespace lodemark
