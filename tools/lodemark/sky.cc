// lodemark sky: what of the sky a receiver among the buildings of a map sees, from a recording.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/base/units.h"
#include "core/map/feature_map.h"
#include "core/session/map_buildings.h"
#include "core/session/map_frame.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/replay_diagnosis.h"
#include "tools/lodemark/replay_measurements.h"
#include "tools/lodemark/replay_options.h"
#include "tools/lodemark/replay_orbits.h"
#include "tools/lodemark/replay_session.h"
#include "tools/lodemark/replay_summary.h"
#include "tools/lodemark/row_writer.h"
#include "tools/lodemark/run_writer.h"
#include "tools/lodemark/sky_drawing.h"
#include "tools/lodemark/sky_view.h"
#include "tools/lodemark/subcommands.h"
#include "tools/lodemark/truth.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Farther away, even a tower of 170 m stands below the usual elevation mask of 5 degrees.
constexpr double kFarthest_m = 2000.0;

struct SkyOptions {
  ReplayOptions replay;
  std::string map;
  std::string at = "fix";
};

// What a recording says of the sky, before buildings come into it.
struct SkyEpoch {
  SkyPlace place;
  std::vector<SkySatellite> satellites;
};

struct Town {
  std::unique_ptr<FeatureMap> map;
  BuildingScene scene;
};

Result<Town> OpenTown(const std::string& path) {
  Result<std::unique_ptr<FeatureMap>> map = FeatureMap::Open(path);
  if (!map) return map.error();
  Result<BuildingScene> scene = BuildingsOf(**map);
  if (!scene) return Error{scene.error().code, path + ": " + scene.error().message};
  if (scene->part_count() == 0) {
    return Error{ErrorCode::kBadData,
                 path + ": holds no buildings; make it with 'lodemark map build --buildings'"};
  }
  return Town{std::move(*map), std::move(*scene)};
}

// A run or an earlier sky may be written to.
Status CheckOut(const std::string& folder) {
  std::error_code ignored;
  if (fs::exists(fs::path(folder) / "sky.csv", ignored)) return {};
  return CheckRunFolder(folder);
}

std::vector<SkySatellite> SatellitesOf(std::span<const lodemark_satellite> signals) {
  std::map<SatelliteId, SkySatellite> by_name;
  for (const lodemark_satellite& signal : signals) {
    if ((signal.present & LODEMARK_SATELLITE_HAS_DIRECTION) == 0) continue;
    SkySatellite satellite;
    satellite.satellite = {static_cast<System>(signal.system),
                           static_cast<std::uint8_t>(signal.satellite)};
    satellite.azimuth_rad = signal.azimuth_deg * kRadiansPerDegree;
    satellite.elevation_rad = signal.elevation_deg * kRadiansPerDegree;
    // All channels of GLONASS are as good as one here.
    const std::optional<double> frequency_hz =
        CarrierFrequency(satellite.satellite.system, signal.signal[0], 0);
    if (!frequency_hz || satellite.elevation_rad <= 0.0) continue;
    satellite.wavelength_m = kSpeedOfLight_mps / *frequency_hz;
    by_name.emplace(satellite.satellite, satellite);  // its first signal
  }
  std::vector<SkySatellite> satellites;
  for (const auto& [name, satellite] : by_name) satellites.push_back(satellite);
  return satellites;
}

std::optional<SkyPlace> PlaceOf(const lodemark_estimate& estimate, const Truth* truth) {
  SkyPlace place;
  place.time_gps_ns = estimate.time_gps_ns;
  if (truth != nullptr) {
    const std::optional<TrajectoryPoint> point = truth->At(estimate.time_gps_ns);
    if (!point || !point->has_position()) return std::nullopt;
    place.in_ecef = EcefFromGeodetic({*point->latitude_deg * kRadiansPerDegree,
                                      *point->longitude_deg * kRadiansPerDegree,
                                      point->height_m.value_or(0.0)});
    return place;
  }
  if ((estimate.present & LODEMARK_ESTIMATE_HAS_POSITION) == 0) return std::nullopt;
  place.in_ecef = Eigen::Map<const Eigen::Vector3d>(estimate.ecef_m);
  place.covariance_enu_m2 = Eigen::Map<const Eigen::Matrix3d>(estimate.covariance_enu_m2);
  return place;
}

struct Sky {
  std::vector<SkyEpoch> epochs;
  std::vector<std::string> remarks;
};

// Replays satellites alone, and keeps where they stood and where the receiver was.
Result<Sky> ReadSky(const ReplayOptions& options, const ReplayInputs& inputs, const Truth* truth,
                    ReplaySummary* summary, MeasurementCounts* counts) {
  const Result<lodemark_session_options> session_options = SessionOptionsOf(options);
  if (!session_options) return session_options.error();
  Result<std::unique_ptr<MeasurementSource>> source = OpenMeasurements(inputs);
  if (!source) return source.error();
  Result<ReplaySession> session = ReplaySession::Open(*session_options);
  if (!session) return session.error();
  Sky sky;
  sky.remarks = inputs.remarks;
  const Status orbits = PushOrbits(inputs, &*session, &sky.remarks);
  if (!orbits.ok()) return orbits.error();
  ProgressBar progress("Replaying", StderrIsTerminal());
  while ((*source)->PushNext(&*session)) {
    for (;;) {
      const Result<bool> processed = session->Process();
      if (!processed) return processed.error();
      if (!*processed) break;
      const lodemark_estimate& estimate = session->estimate();
      if (estimate.outcome == LODEMARK_OUTCOME_NO_DATA ||
          (estimate.present & LODEMARK_ESTIMATE_HAS_GPS_TIME) == 0) {
        continue;
      }
      summary->AddEpoch(estimate, session->satellites());
      const std::optional<SkyPlace> place = PlaceOf(estimate, truth);
      std::vector<SkySatellite> satellites = SatellitesOf(session->satellites());
      if (!place || satellites.empty()) continue;
      sky.epochs.push_back({*place, std::move(satellites)});
    }
    progress.Update((*source)->progress());
  }
  progress.Finish();
  *counts = (*source)->counts();
  const Status verdict = (*source)->Verdict();
  if (!verdict.ok()) return verdict.error();
  return sky;
}

Status WriteTable(const std::string& path, std::span<const SkyMoment> moments) {
  RowWriter rows;
  const Status opened = rows.Open(path);
  if (!opened.ok()) return opened;
  rows.Raw("time_gps_ns,satellite,azimuth_deg,elevation_deg,probability,skyline_deg\n");
  for (const SkyMoment& moment : moments) {
    for (const SkySatellite& satellite : moment.satellites) {
      rows.Field(moment.time_gps_ns);
      rows.Field(SatelliteName(satellite.satellite));
      rows.Field(satellite.azimuth_rad * kDegreesPerRadian, 2);
      rows.Field(satellite.elevation_rad * kDegreesPerRadian, 2);
      rows.Field(satellite.probability, 4);
      rows.Field(satellite.skyline_rad * kDegreesPerRadian, 2);
      rows.EndRow();
    }
    rows.FlushIfLarge();
  }
  rows.Flush();
  return rows.status();
}

// One satellite over the whole recording.
struct SatelliteSummary {
  SkySatellite last;
  std::int64_t epochs = 0;
  double probability = 0.0;  // sum
  double least = 1.0;
  double greatest = 0.0;
};

std::map<SatelliteId, SatelliteSummary> Summarise(std::span<const SkyMoment> moments) {
  std::map<SatelliteId, SatelliteSummary> summaries;
  for (const SkyMoment& moment : moments) {
    for (const SkySatellite& satellite : moment.satellites) {
      SatelliteSummary& summary = summaries[satellite.satellite];
      summary.last = satellite;
      ++summary.epochs;
      summary.probability += satellite.probability;
      summary.least = std::min(summary.least, satellite.probability);
      summary.greatest = std::max(summary.greatest, satellite.probability);
    }
  }
  return summaries;
}

std::int64_t CountInside(std::span<const SkyMoment> moments) {
  return std::count_if(moments.begin(), moments.end(),
                       [](const SkyMoment& moment) { return moment.inside_building; });
}

ordered_json JsonOf(const SkyOptions& options, const std::string& name,
                    std::span<const SkyMoment> moments, const ordered_json& files) {
  ordered_json satellites = ordered_json::array();
  for (const auto& [satellite, summary] : Summarise(moments)) {
    satellites.push_back({{"satellite", SatelliteName(satellite)},
                          {"epochs", summary.epochs},
                          {"azimuth_deg", summary.last.azimuth_rad * kDegreesPerRadian},
                          {"elevation_deg", summary.last.elevation_rad * kDegreesPerRadian},
                          {"skyline_deg", summary.last.skyline_rad * kDegreesPerRadian},
                          {"probability",
                           {{"mean", summary.probability / static_cast<double>(summary.epochs)},
                            {"least", summary.least},
                            {"greatest", summary.greatest}}}});
  }
  return {{"recording", name},
          {"map", options.map},
          {"at", options.at},
          {"epochs", moments.size()},
          {"epochs_inside_a_building", CountInside(moments)},
          {"satellites", satellites},
          {"files", files}};
}

std::string TextOf(const SkyOptions& options, const std::string& name,
                   std::span<const SkyMoment> moments) {
  std::string text = name + "\n" +
                     Format("  looked from the %s at %s", options.at.c_str(),
                            Counted(static_cast<std::int64_t>(moments.size()), "time").c_str());
  if (const std::int64_t inside = CountInside(moments); inside > 0) {
    text += Format(", %s of them inside a building", GroupDigits(inside).c_str());
  }
  text += "\n\n             at the end            in plain sight, %\n";
  text += "  satellite  azimuth  elevation  skyline   mean  least  most\n";
  for (const auto& [satellite, summary] : Summarise(moments)) {
    text += Format("  %-9s  %6.0f°  %8.0f°  %6.0f°  %5.0f  %5.0f  %4.0f\n",
                   SatelliteName(satellite).c_str(), summary.last.azimuth_rad * kDegreesPerRadian,
                   summary.last.elevation_rad * kDegreesPerRadian,
                   summary.last.skyline_rad * kDegreesPerRadian,
                   100.0 * summary.probability / static_cast<double>(summary.epochs),
                   100.0 * summary.least, 100.0 * summary.greatest);
  }
  return text;
}

int RunSky(const SkyOptions& options) {
  const std::string& out = options.replay.out;
  const Status writable = CheckOut(out);
  if (!writable.ok()) return ReportError(writable.error());
  const Result<Town> town = OpenTown(options.map);
  if (!town) return ReportError(town.error());
  const Result<ReplayInputs> inputs = FindReplayInputs(options.replay.request);
  if (!inputs) return ReportError(inputs.error());
  std::optional<Truth> truth;
  if (options.at == "truth") {
    Result<Truth> read = ReadTruth(options.replay.request.recording);
    if (!read) return ReportError(read.error());
    truth = std::move(*read);
  }
  ReplaySummary summary;
  MeasurementCounts counts;
  const Result<Sky> sky =
      ReadSky(options.replay, *inputs, truth ? &*truth : nullptr, &summary, &counts);
  if (!sky) return ReportError(sky.error());
  if (sky->epochs.empty()) {
    PrintMessage(truth && summary.answered() > 0
                     ? truth->file + ": says nothing of the time of the recording"
                     : WhyNoEstimate(*inputs, counts, summary));
    return kExitMissed;
  }

  const MapFrame frame =
      FrameForFix(town->map->info(), YearOfGps(sky->epochs.front().place.time_gps_ns));
  SkyView view(&town->scene, frame.frame);
  std::vector<SkyMoment> moments;
  moments.reserve(sky->epochs.size());
  for (const SkyEpoch& epoch : sky->epochs) {
    moments.push_back(view.Look(epoch.place, epoch.satellites));
  }
  if (view.nearest_building_m() > kFarthest_m) {
    return ReportError(
        {ErrorCode::kBadData,
         options.map + Format(": is of another town; its nearest building is %s km from where %s "
                              "was recorded",
                              GroupDigits(std::llround(1e-3 * view.nearest_building_m())).c_str(),
                              inputs->name.c_str())});
  }

  std::error_code failure;
  fs::create_directories(out, failure);
  if (failure) return ReportError({ErrorCode::kIo, out + ": cannot be made: " + failure.message()});
  const std::string table = (fs::path(out) / "sky.csv").string();
  const std::string drawing = (fs::path(out) / "sky.svg").string();
  Status written = WriteTable(table, moments);
  if (written.ok()) written = WriteFileWhole(drawing, DrawSky(inputs->name, view, moments));
  if (!written.ok()) return ReportError(written.error());
  if (options.replay.json) {
    PrintResult(JsonOf(options, inputs->name, moments, {table, drawing})
                    .dump(2, ' ', false, ordered_json::error_handler_t::replace) +
                "\n");
  } else {
    PrintResult(TextOf(options, inputs->name, moments) + "\n  written to " + out +
                ": sky.csv, sky.svg\n");
  }
  FlushResults();
  for (const std::string& remark : sky->remarks) PrintMessage(remark);
  if (!frame.remark.empty()) PrintMessage(options.map + ": " + frame.remark);
  return kExitGood;
}

}  // namespace

void AddSkyCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<SkyOptions>();
  options->replay.scheme = "gnss";
  CLI::App* command =
      app.add_subcommand("sky", "Which satellites the buildings of a map leave in sight");
  ReplayRequest& request = options->replay.request;
  command
      ->add_option("RECORDING", request.recording,
                   "Folder of a recording, with a manifest.json or without")
      ->required();
  command->add_option("--map", options->map, "Map with buildings: 'lodemark map build --buildings'")
      ->required();
  command->add_option("--out", options->replay.out, "Folder for sky.csv and sky.svg; may be a run")
      ->required();
  command->add_option("--at", options->at, "Look from the replayed fix, or from the truth")
      ->check(CLI::IsMember({"fix", "truth"}))
      ->capture_default_str();
  command->add_option("--nav", request.navigation, "RINEX navigation beside the recording's");
  command->add_option("--sp3", request.precise_orbits, "Precise orbits and clocks");
  command->add_flag("--json", options->replay.json, "Print the table as JSON");
  command->callback([options, exit_code] { *exit_code = RunSky(*options); });
}

}  // namespace lodemark
