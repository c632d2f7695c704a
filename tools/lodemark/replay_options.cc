#include "tools/lodemark/replay_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>

#include "core/gnss/signal.h"
#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

const std::vector<std::string> kIonospheres = {"best",  "none",   "klobuchar",
                                               "bdgim", "ntcm-g", "climatology"};
const std::vector<std::string> kTropospheres = {"saastamoinen", "hopfield", "none"};
const std::vector<std::string> kWeights = {"signal", "elevation"};
static_assert(LODEMARK_IONOSPHERE_CLIMATOLOGY == 5 && LODEMARK_IONOSPHERE_NTCM_G == 4);
static_assert(LODEMARK_TROPOSPHERE_NONE == 2 && LODEMARK_WEIGHT_ELEVATION == 1);

const std::vector<std::string> kSchemes = {"joint", "tight", "tight-diagonal", "vision", "gnss"};
static_assert(LODEMARK_SCHEME_VISION == 3 && LODEMARK_SCHEME_GNSS == 4);

// Photographs and satellites as far as there are any, filtered over time, forwards or both ways.
constexpr const char* kFilterScheme = "ekf";
constexpr const char* kInertialScheme = "ekf-imu";
constexpr const char* kSmootherScheme = "batch";

constexpr const char* kAllSchemes =
    "joint, tight, tight-diagonal, vision, gnss, ekf, ekf-imu, batch";

// What the design names and a later version will do.
const std::vector<std::string> kLaterSchemes = {"window"};

// In an option of the C interface zero stands for the default; this is as good as zero.
constexpr double kAlmostZero = 1e-9;

std::int32_t IndexIn(const std::vector<std::string>& words, const std::string& word) {
  return static_cast<std::int32_t>(std::find(words.begin(), words.end(), word) - words.begin());
}

Result<std::uint32_t> SystemBits(const std::string& letters) {
  std::uint32_t bits = 0;
  for (const char letter : letters) {
    const std::optional<System> system = SystemFromLetter(letter);
    if (!system) {
      return Error{ErrorCode::kInvalidArgument,
                   "--systems " + letters + ": '" + std::string(1, letter) +
                       "' is no system; choose from G (GPS), R (GLONASS), E (Galileo), C "
                       "(BeiDou), J (QZSS), I (NavIC), S (SBAS)"};
    }
    bits |= 1u << static_cast<unsigned>(*system);
  }
  return bits;
}

std::string NumberText(double value) { return Format("%.10g", value); }

}  // namespace

void DeclareReplayOptions(CLI::App& command, ReplayOptions* options) {
  ReplayRequest& request = options->request;
  command.add_option("RECORDING", request.recording,
                     "Folder of a recording, with a manifest.json or without");
  command.add_option("--out", options->out, "Folder to write the run to")->required();

  const std::string files = "Files in place of a recording";
  command.add_option("--log", request.log, "GnssLogger text, u-blox file or Kaggle csv")
      ->group(files);
  command.add_option("--obs", request.observation, "RINEX or CRINEX observations")->group(files);
  command.add_option("--nav", request.navigation, "RINEX navigation")->group(files);
  command.add_option("--sp3", request.precise_orbits, "Precise orbits and clocks")->group(files);

  const std::string estimation = "Estimation";
  command
      .add_option("--map", request.map,
                  "Map to look photographs up in, whose buildings hide satellites")
      ->group(estimation);
  command
      .add_option("--scheme", options->scheme,
                  "joint, tight, tight-diagonal, vision or gnss, each moment for itself; ekf, "
                  "filtered over time; ekf-imu, the same with samples of sensors; batch, ekf "
                  "forwards and back. Joint with a map, else gnss")
      ->group(estimation);
  command.add_option("--systems", options->systems, "Only these: letters of GRECJIS")
      ->group(estimation);
  command.add_flag("--broadcast", request.broadcast_only, "Ignore precise orbits")
      ->group(estimation);
  command.add_option("--ionosphere", options->ionosphere, "Model of its delay")
      ->check(CLI::IsMember(kIonospheres))
      ->capture_default_str()
      ->group(estimation);
  command.add_option("--troposphere", options->troposphere, "Model of its delay")
      ->check(CLI::IsMember(kTropospheres))
      ->capture_default_str()
      ->group(estimation);
  command.add_option("--mask", options->mask_deg, "Smallest elevation in degrees")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str()
      ->group(estimation);
  command.add_option("--min-cn0", options->smallest_cn0_dbhz, "Smallest C/N0 in dB-Hz")
      ->check(CLI::Range(0.0, 80.0))
      ->capture_default_str()
      ->group(estimation);
  command.add_option("--weight", options->weight, "By signal, or by elevation alone")
      ->check(CLI::IsMember(kWeights))
      ->capture_default_str()
      ->group(estimation);
  command.add_option("--elevation-a", options->elevation_a_m, "a of a² + b²/sin², in metres")
      ->check(CLI::PositiveNumber)
      ->group(estimation);
  command.add_option("--elevation-b", options->elevation_b_m, "b of it, in metres")
      ->check(CLI::PositiveNumber)
      ->group(estimation);
  command
      .add_flag("--variance-components", options->variance_components,
                "a and b, and factors of both kinds of sights, from residuals")
      ->group(estimation);
  command.add_flag("--zenith-delay", options->zenith_delay, "Estimate a tropospheric delay")
      ->group(estimation);
  command.add_flag("--height-memory", options->height_memory, "A weak memory of the height")
      ->group(estimation);
  command.add_flag("--fixed-biases", options->fixed_biases, "Learn no biases from past epochs")
      ->group(estimation);
  command.add_flag("--accept-unhealthy", options->accept_unhealthy, "Use unhealthy satellites")
      ->group(estimation);
  command.add_option("--seed", options->seed, "Of every random choice")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(estimation);
  command.add_flag("--json", options->json, "Print the summary as JSON");
}

std::string SchemeOf(const ReplayOptions& options) {
  if (!options.scheme.empty()) return options.scheme;
  return options.request.map.empty() ? "gnss" : "joint";
}

bool UsesSensors(const ReplayOptions& options) { return options.scheme == kInertialScheme; }

Result<lodemark_session_options> SessionOptionsOf(const ReplayOptions& options) {
  const auto usage = [](std::string text) {
    return Error{ErrorCode::kInvalidArgument, std::move(text)};
  };
  const ReplayRequest& request = options.request;
  if (std::find(kLaterSchemes.begin(), kLaterSchemes.end(), options.scheme) !=
      kLaterSchemes.end()) {
    return usage("--scheme " + options.scheme + ": not in this version; choose from " +
                 kAllSchemes);
  }
  std::string scheme = SchemeOf(options);
  const bool filters = scheme == kFilterScheme || scheme == kInertialScheme;
  const bool smooths = scheme == kSmootherScheme;
  if (filters || smooths) scheme = request.map.empty() ? "gnss" : "joint";
  if (std::find(kSchemes.begin(), kSchemes.end(), scheme) == kSchemes.end()) {
    return usage("--scheme " + scheme + ": no such scheme; choose from " + kAllSchemes);
  }
  if (scheme != "gnss" && options.request.map.empty()) {
    return usage("--scheme " + scheme +
                 ": needs photographs and the map they show; name it with "
                 "--map");
  }
  const int named = (request.recording.empty() ? 0 : 1) + (request.log.empty() ? 0 : 1) +
                    (request.observation.empty() ? 0 : 1);
  if (named != 1) {
    return usage("name one recording: a folder, or a file with --log or --obs");
  }
  const Result<std::uint32_t> systems = SystemBits(options.systems);
  if (!systems) return systems.error();
  if (request.broadcast_only && !request.precise_orbits.empty()) {
    return usage("--broadcast ignores precise orbits, so --sp3 makes no sense beside it");
  }

  lodemark_session_options to = {};
  to.struct_size = sizeof to;
  to.time_base = LODEMARK_TIME_BASE_GPS;
  to.systems = *systems;
  const auto flag = [&to](bool on, std::uint32_t bit) {
    if (on) to.flags |= bit;
  };
  flag(options.variance_components, LODEMARK_SESSION_VARIANCE_COMPONENTS);
  flag(options.zenith_delay, LODEMARK_SESSION_ZENITH_DELAY);
  flag(options.height_memory, LODEMARK_SESSION_HEIGHT_MEMORY);
  flag(options.fixed_biases, LODEMARK_SESSION_FIXED_BIASES);
  flag(options.accept_unhealthy, LODEMARK_SESSION_ACCEPT_UNHEALTHY);
  to.scheme = IndexIn(kSchemes, scheme);
  to.estimator = filters   ? LODEMARK_ESTIMATOR_FILTER
                 : smooths ? LODEMARK_ESTIMATOR_SMOOTHER
                           : LODEMARK_ESTIMATOR_EPOCH;
  to.ionosphere = IndexIn(kIonospheres, options.ionosphere);
  to.troposphere = IndexIn(kTropospheres, options.troposphere);
  to.weight = IndexIn(kWeights, options.weight);
  to.elevation_mask_deg = options.mask_deg != 0.0 ? options.mask_deg : kAlmostZero;
  to.smallest_cn0_dbhz = options.smallest_cn0_dbhz > 0.0 ? options.smallest_cn0_dbhz : -1.0;
  to.elevation_a_m = options.elevation_a_m.value_or(0.0);
  to.elevation_b_m = options.elevation_b_m.value_or(0.0);
  to.seed = options.seed;
  return to;
}

std::vector<std::string> CommandLineOf(const ReplayOptions& options) {
  std::vector<std::string> line = {"lodemark", "replay"};
  const auto add = [&line](const char* option, const std::string& value) {
    line.emplace_back(option);
    line.push_back(value);
  };
  const auto add_files = [&line](const char* option, const std::vector<std::string>& paths) {
    if (paths.empty()) return;
    line.emplace_back(option);
    line.insert(line.end(), paths.begin(), paths.end());
  };
  const ReplayOptions standard;
  const ReplayRequest& request = options.request;
  if (!request.recording.empty()) line.push_back(request.recording);
  add("--out", options.out);
  if (!request.log.empty()) add("--log", request.log);
  if (!request.observation.empty()) add("--obs", request.observation);
  add_files("--nav", request.navigation);
  add_files("--sp3", request.precise_orbits);
  if (!request.map.empty()) add("--map", request.map);
  if (!options.scheme.empty()) add("--scheme", options.scheme);
  if (!options.systems.empty()) add("--systems", options.systems);
  if (request.broadcast_only) line.emplace_back("--broadcast");
  if (options.ionosphere != standard.ionosphere) add("--ionosphere", options.ionosphere);
  if (options.troposphere != standard.troposphere) add("--troposphere", options.troposphere);
  if (options.mask_deg != standard.mask_deg) add("--mask", NumberText(options.mask_deg));
  if (options.smallest_cn0_dbhz != standard.smallest_cn0_dbhz) {
    add("--min-cn0", NumberText(options.smallest_cn0_dbhz));
  }
  if (options.weight != standard.weight) add("--weight", options.weight);
  if (options.elevation_a_m) add("--elevation-a", NumberText(*options.elevation_a_m));
  if (options.elevation_b_m) add("--elevation-b", NumberText(*options.elevation_b_m));
  if (options.variance_components) line.emplace_back("--variance-components");
  if (options.zenith_delay) line.emplace_back("--zenith-delay");
  if (options.height_memory) line.emplace_back("--height-memory");
  if (options.fixed_biases) line.emplace_back("--fixed-biases");
  if (options.accept_unhealthy) line.emplace_back("--accept-unhealthy");
  add("--seed", std::to_string(options.seed));
  return line;
}

}  // namespace lodemark
