// The options of lodemark replay, and what they mean to a session.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "lodemark/lodemark.h"
#include "tools/lodemark/replay_inputs.h"

namespace CLI {
class App;
}

namespace lodemark {

struct ReplayOptions {
  ReplayRequest request;
  std::string out;
  bool json = false;

  std::string scheme;   // empty: joint where there is a map, else gnss
  std::string systems;  // letters of RINEX; empty: all
  std::string ionosphere = "best";
  std::string troposphere = "saastamoinen";
  std::string weight = "signal";
  double mask_deg = 5.0;
  double smallest_cn0_dbhz = 10.0;
  std::optional<double> elevation_a_m;
  std::optional<double> elevation_b_m;
  bool variance_components = false;
  bool zenith_delay = false;
  bool height_memory = false;
  bool fixed_biases = false;
  bool accept_unhealthy = false;
  std::uint64_t seed = 1;
};

void DeclareReplayOptions(CLI::App& command, ReplayOptions* options);

// The one asked for, or the one that the inputs suggest.
std::string SchemeOf(const ReplayOptions& options);

// Whether samples of inertial sensors, a barometer or a vehicle are to be heard.
bool UsesSensors(const ReplayOptions& options);

// Fails with one sentence where the options make no sense, or none in this version.
Result<lodemark_session_options> SessionOptionsOf(const ReplayOptions& options);

// The command line that gives the same run.
std::vector<std::string> CommandLineOf(const ReplayOptions& options);

}  // namespace lodemark
