// What to simulate: a place, a time, how the receiver moves, and how good the signals are.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "tools/simulator/photography.h"

namespace lodemark {

struct Scenario {
  std::string name = "static";
  Geodetic place;                 // start of the path
  std::string place_name;         // for the reader
  std::int64_t start_gps_ns = 0;  // of the first epoch, within a millisecond
  int epochs = 120;
  double interval_s = 1.0;       // between epochs
  std::string systems = "GERC";  // RINEX letters of GPS, Galileo, GLONASS, BeiDou
  double elevation_mask_deg = 8.0;
  double multipath_sigma_m = 1.0;   // of code, at 45 degrees of elevation
  double clock_drift_nsps = 180.0;  // at the first epoch
  std::uint64_t seed = 1;

  // Corners of the way in metres east and north of the place; fewer than two: at rest.
  std::vector<std::array<double, 2>> waypoints_m;
  double speed_mps = 1.35;
  double pause_s = 5.0;  // standing before the first step
  double stop_s = 0.0;   // standing at each corner between; 0: corners are rounded without a stop
  double phone_height_m = 0.0;    // above the way: antenna and camera alike
  double sensor_rate_hz = 100.0;  // samples of the accelerometer and the gyroscope in a second
  double rise_m = 0.8;            // how much higher the highest part of the way is than the lowest

  Photography photography;
};

// "static" or "walk".
Result<Scenario> PresetScenario(std::string_view name);

// A scenario as JSON (docs/formats.md). Missing fields keep the defaults of the preset "static";
// an unknown or impossible one is an error that names it. file is for messages.
Result<Scenario> ScenarioFromJson(const std::string& file, std::string_view text);

}  // namespace lodemark
