// The photographs of a scenario as files: pictures, lens, poses, times, surveyed points.
#pragma once

#include <functional>

#include "core/base/result.h"
#include "tools/simulator/recording.h"
#include "tools/simulator/scenario.h"

namespace lodemark {

// For each group its folder with the pictures, camera.json, poses.csv (the truth), data.csv where
// the phone took them, and survey.csv and marks.csv where asked for. None for a scenario without
// photographs. The same files, to the last byte, for the same scenario. progress, if not empty, is
// called with the share done. Error if the lens sees nothing or pictures cannot be encoded.
Result<RecordingFiles> MakePhotos(const Scenario& scenario,
                                  const std::function<void(double)>& progress);

}  // namespace lodemark
