// What lodemark map build and import share: options of a new map, writing it, saying what it holds.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/units.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/map_commands.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/text_table.h"
#include "tools/mapping/compression.h"

namespace lodemark {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

// "20%" or "20".
Result<double> ShareToKeep(const std::string& text) {
  if (text.empty()) return 1.0;
  const char* end = text.data() + text.size();
  if (text.back() == '%') --end;
  double percent = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), end, percent);
  if (error != std::errc() || stop != end || !(percent > 0.0) || !(percent <= 100.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "--keep " + Printable(text) + ": is no share between 0% and 100%"};
  }
  return percent / 100.0;
}

// "registered by 9 of 11 places" and how well, for people who use the map years later.
std::string RegistrationSentence(const Georegistration& registration) {
  const Eigen::Vector3d sigma_m = registration.covariance.diagonal().head<3>().cwiseSqrt();
  return Format(
      "; laid on the earth by %d of %zu places, sigma %.3f m east, %.3f m north, "
      "%.3f m up",
      registration.used, registration.residuals.size(), sigma_m.x(), sigma_m.y(), sigma_m.z());
}

std::string RegistrationText(const BuiltMap& built, bool decorate) {
  const Georegistration& found = *built.registration;
  TextTable table({"east m", "north m", "up m", "sigmas", "used"});
  for (std::size_t i = 0; i < found.residuals.size(); ++i) {
    const TieResidual& residual = found.residuals[i];
    table.AddRow(Printable(built.tie_names[i]),
                 {Format("%.3f", residual.enu_m.x()), Format("%.3f", residual.enu_m.y()),
                  Format("%.3f", residual.enu_m.z()), Format("%.1f", residual.sigmas),
                  residual.used ? "yes" : "no"});
  }
  const Eigen::Matrix<double, 7, 1> sigma = found.covariance.diagonal().cwiseSqrt();
  std::string text = table.Text(decorate);
  text += Format("scale %.6f (sigma %.1e), residuals %.2f of their sigmas\n",
                 found.enu_from_model.scale, sigma(6), found.unit_sigma);
  text += Format(
      "the map lies on the earth within %.3f m east, %.3f m north, %.3f m up, and turned "
      "within %.3f, %.3f, %.3f degrees (1 sigma)\n",
      sigma(0), sigma(1), sigma(2), sigma(3) * kDegreesPerRadian, sigma(4) * kDegreesPerRadian,
      sigma(5) * kDegreesPerRadian);
  return text;
}

ordered_json RegistrationJson(const BuiltMap& built) {
  const Georegistration& found = *built.registration;
  ordered_json ties = ordered_json::array();
  for (std::size_t i = 0; i < found.residuals.size(); ++i) {
    const TieResidual& residual = found.residuals[i];
    ties.push_back(
        {{"name", built.tie_names[i]},
         {"residual_enu_m", {residual.enu_m.x(), residual.enu_m.y(), residual.enu_m.z()}},
         {"sigmas", residual.sigmas},
         {"used", residual.used}});
  }
  ordered_json covariance = ordered_json::array();
  for (int row = 0; row < 7; ++row) {
    ordered_json line = ordered_json::array();
    for (int column = 0; column < 7; ++column) line.push_back(found.covariance(row, column));
    covariance.push_back(line);
  }
  const Similarity3& similarity = found.enu_from_model;
  const Eigen::Vector3d& shift = similarity.translation;
  return {{"scale", similarity.scale},
          {"rotation_wxyz",
           {similarity.rotation.w(), similarity.rotation.x(), similarity.rotation.y(),
            similarity.rotation.z()}},
          {"translation_enu_m", {shift.x(), shift.y(), shift.z()}},
          {"unit_sigma", found.unit_sigma},
          {"covariance", covariance},
          {"places", ties}};
}

double MedianSigma(const std::vector<Landmark>& landmarks) {
  std::vector<double> sigmas;
  for (const Landmark& landmark : landmarks) {
    sigmas.push_back(std::sqrt(std::max(0.0, landmark.covariance_m2.trace())));
  }
  if (sigmas.empty()) return 0.0;
  const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
  std::nth_element(sigmas.begin(), middle, sigmas.end());
  return *middle;
}

}  // namespace

void AddNewMapOptions(CLI::App& command, NewMapOptions* options) {
  command.add_option("--out", options->out, "Map file to write")->required();
  command.add_option("--origin", options->origin,
                     "LATITUDE,LONGITUDE,HEIGHT of the map's frame; default: the middle");
  command.add_flag("--local", options->local, "The frame lies nowhere on the earth");
  command.add_option(
      "--grid", options->grid,
      "Of eastings and northings: utm11N, or tm:MERIDIAN[,SCALE[,EASTING[,NORTHING]]]");
  command.add_option("--datum", options->datum, "Of the coordinates")->capture_default_str();
  command.add_option("--epoch", options->epoch_year, "Of the coordinates, as 2024.5");
  command.add_option("--keep", options->keep, "Share of the landmarks to keep, as 20%");
  command.add_option("--provenance", options->provenance, "Who made the map, of what");
  command.add_flag("--overwrite", options->overwrite, "Replace the map if there is one");
  command.add_flag("--json", options->json, "Print JSON");
}

Result<FrameOptions> FrameOptionsFrom(const NewMapOptions& options) {
  FrameOptions frame;
  frame.local = options.local;
  if (options.origin.empty()) return frame;
  if (options.local) {
    return Error{ErrorCode::kInvalidArgument, "--origin and --local exclude each other"};
  }
  frame.origin = ParseGeodetic(options.origin);
  if (frame.origin) return frame;
  return Error{ErrorCode::kInvalidArgument,
               "--origin " + Printable(options.origin) +
                   ": is no LATITUDE,LONGITUDE,HEIGHT in degrees and m"};
}

Result<PlaceOptions> PlaceOptionsFrom(const NewMapOptions& options) {
  PlaceOptions places;
  places.local = options.local;
  if (options.grid.empty()) return places;
  places.grid = GridByName(options.grid);
  if (places.grid) return places;
  return Error{ErrorCode::kInvalidArgument,
               "--grid " + Printable(options.grid) + ": is no grid; write utm11N or tm:9,0.9996"};
}

StageProgress StageBars() {
  struct State {
    const char* stage = nullptr;
    std::unique_ptr<ProgressBar> bar;
  };
  const auto state = std::make_shared<State>();
  return [state](const char* stage, double share) {
    if (state->stage != stage) {
      state->stage = stage;
      state->bar = std::make_unique<ProgressBar>(stage, StderrIsTerminal());
    }
    state->bar->Update(share);
    if (share >= 1.0) state->bar->Finish();
  };
}

int FinishMap(const NewMapOptions& options, const std::string& how, BuiltMap built) {
  const Result<double> keep = ShareToKeep(options.keep);
  if (!keep) return ReportError(keep.error());
  for (const std::string& note : built.notes) PrintMessage(Printable(note));
  const std::size_t before = built.content.landmarks.size();
  if (*keep < 1.0) KeepBestLandmarks(*keep, &built.content);

  built.info.provenance = options.provenance.empty() ? how : options.provenance + "; " + how;
  if (built.registration) built.info.provenance += RegistrationSentence(*built.registration);
  if (*keep < 1.0) {
    built.info.provenance +=
        Format("; %zu of %zu landmarks kept", built.content.landmarks.size(), before);
  }
  std::error_code ignored;
  if (options.overwrite) {
    // Written beside, so that the old map stays until the new one is whole.
    fs::remove(options.out + ".new", ignored);
  }
  const std::string written = options.overwrite ? options.out + ".new" : options.out;
  const StageProgress bars = StageBars();
  const Status status =
      WriteMap(written, built.info, built.content, [&](double share) { bars("Writing", share); });
  if (!status.ok()) return ReportError(status.error());
  if (options.overwrite) {
    std::error_code failure;
    fs::rename(written, options.out, failure);
    if (failure) return ReportError({ErrorCode::kIo, options.out + ": " + failure.message()});
  }

  const auto landmarks = static_cast<std::int64_t>(built.content.landmarks.size());
  const auto descriptors = static_cast<std::int64_t>(built.content.origins.size());
  const auto images = static_cast<std::int64_t>(built.content.images.size());
  const auto parts = static_cast<std::int64_t>(built.content.building_parts.size());
  const auto buildings = static_cast<std::int64_t>(built.buildings);
  if (options.json) {
    ordered_json json = {{"map", options.out},
                         {"landmarks", landmarks},
                         {"descriptors", descriptors},
                         {"images", images},
                         {"buildings", buildings},
                         {"building_parts", parts},
                         {"median_sigma_m", MedianSigma(built.content.landmarks)}};
    if (built.noise_px > 0.0) json["noise_px"] = built.noise_px;
    if (built.registration) json["registration"] = RegistrationJson(built);
    json["notes"] = built.notes;
    PrintResult(json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
    return kExitGood;
  }
  std::string text;
  if (built.registration) text += RegistrationText(built, StdoutIsTerminal());
  text += Printable(options.out) + ": ";
  if (landmarks > 0 || buildings == 0) {
    text += Counted(landmarks, "landmark") + " with " + Counted(descriptors, "descriptor") +
            " from " + Counted(images, "image") +
            Format(", sigma %.3f m in the middle", MedianSigma(built.content.landmarks));
    if (built.noise_px > 0.0) text += Format(", features within %.2f px", built.noise_px);
    if (buildings > 0) text += "; ";
  }
  if (buildings > 0) {
    text += Counted(buildings, "building") + " in " + Counted(parts, "convex part");
  }
  PrintResult(text + "\n");
  return kExitGood;
}

}  // namespace lodemark
