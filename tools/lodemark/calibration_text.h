// What 'lodemark calibrate' says: tables for people, JSON for programs, and its files.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/camera/calibration.h"

namespace lodemark {

// A photograph that was given, and what became of it.
struct CalibrationPhoto {
  std::string name;
  int corners = 0;
  bool is_used = false;
  double rms_px = 0.0;
  std::string reason;  // it was not used
};

std::string CalibrationText(const Calibration& calibration,
                            const std::vector<CalibrationPhoto>& photos, bool decorate);

std::string CalibrationJson(const Calibration& calibration,
                            const std::vector<CalibrationPhoto>& photos);

// The content of the camera file that path names by its ending: a camera.json with covariance, rms
// and the photographs, or OpenCV's .yml, .yaml or .xml.
Result<std::string> CalibrationFile(const Calibration& calibration,
                                    const std::vector<CalibrationPhoto>& photos,
                                    const std::string& path);

}  // namespace lodemark
