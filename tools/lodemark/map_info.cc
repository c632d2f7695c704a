// lodemark map info and check: what a map holds, and whether it is sound.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/units.h"
#include "core/map/feature_map.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/map_commands.h"
#include "tools/lodemark/text_table.h"

namespace lodemark {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostFaults = 20;

struct MapFileOptions {
  std::vector<std::string> maps;
  bool json = false;
};

// What the landmarks are like, beyond their number.
struct LandmarkSummary {
  Eigen::Vector3d least = Eigen::Vector3d::Zero();
  Eigen::Vector3d greatest = Eigen::Vector3d::Zero();
  double median_sigma_m = 0.0;  // root of the covariance's trace
  double worst_sigma_m = 0.0;
};

LandmarkSummary Summarise(const std::vector<Landmark>& landmarks) {
  LandmarkSummary summary;
  if (landmarks.empty()) return summary;
  std::vector<double> sigmas;
  sigmas.reserve(landmarks.size());
  summary.least = summary.greatest = landmarks.front().position_in_enu_m;
  for (const Landmark& landmark : landmarks) {
    summary.least = summary.least.cwiseMin(landmark.position_in_enu_m);
    summary.greatest = summary.greatest.cwiseMax(landmark.position_in_enu_m);
    sigmas.push_back(std::sqrt(std::max(0.0, landmark.covariance_m2.trace())));
  }
  const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
  std::nth_element(sigmas.begin(), middle, sigmas.end());
  summary.median_sigma_m = *middle;
  summary.worst_sigma_m = *std::max_element(sigmas.begin(), sigmas.end());
  return summary;
}

std::int64_t FileSize(const std::string& path) {
  std::error_code failure;
  const auto size = std::filesystem::file_size(path, failure);
  return failure ? 0 : static_cast<std::int64_t>(size);
}

const char* KindName(DescriptorKind kind) {
  return kind == DescriptorKind::kOrb ? "ORB, 32 bytes" : "SIFT, 128 bytes, root normalised";
}

std::string InfoText(const std::string& path, const FeatureMap& map, const LandmarkSummary& summary,
                     bool decorate) {
  const MapInfo& info = map.info();
  std::string text = decorate ? "\033[1m" + Printable(path) + "\033[0m\n" : Printable(path) + "\n";
  const bool local = info.datum == "local";
  if (local) {
    text += "  frame        local, nowhere on the earth\n";
  } else {
    text +=
        Format("  origin       %.9f, %.9f, %.3f m\n", info.origin.latitude_rad * kDegreesPerRadian,
               info.origin.longitude_rad * kDegreesPerRadian, info.origin.height_m);
    text += "  datum        " + Printable(info.datum);
    if (info.epoch_year > 0.0) text += Format(", epoch %.2f", info.epoch_year);
    text += "\n";
  }
  text += "  descriptors  " + GroupDigits(info.descriptors) + " of " +
          std::string(KindName(info.descriptor_kind)) + "\n";
  text += "  landmarks    " + GroupDigits(info.landmarks);
  if (info.landmarks > 0) {
    text += summary.worst_sigma_m > 0.0 ? Format(", sigma %.3f m in the middle, %.3f m at worst",
                                                 summary.median_sigma_m, summary.worst_sigma_m)
                                        : ", no sigma stated";
  }
  text += "\n";
  if (info.landmarks > 0) {
    const Eigen::Vector3d extent = summary.greatest - summary.least;
    text += Format("  extent       %.1f m east, %.1f m north, %.1f m up\n", extent.x(), extent.y(),
                   extent.z());
  }
  text += "  images       " + GroupDigits(info.images) + "\n";
  if (info.building_parts > 0) {
    text += "  buildings    " + Counted(info.building_parts, "part") + "\n";
  }
  text += "  index        " + Counted(map.quantizer().list_count(), "list") + "\n";
  text += Format("  size         %.1f MB", static_cast<double>(FileSize(path)) / 1e6);
  if (info.descriptors > 0) {
    text += Format(", %.0f bytes a descriptor",
                   static_cast<double>(FileSize(path)) / static_cast<double>(info.descriptors));
  }
  text += "\n  id           " + Printable(info.id) + "\n";
  text += "  provenance   " + Printable(info.provenance) + "\n";
  return text;
}

ordered_json InfoJson(const std::string& path, const FeatureMap& map,
                      const LandmarkSummary& summary) {
  const MapInfo& info = map.info();
  ordered_json json = {{"file", path}, {"id", info.id}, {"local", info.datum == "local"}};
  if (info.datum != "local") {
    json["origin"] = {{"latitude_deg", info.origin.latitude_rad * kDegreesPerRadian},
                      {"longitude_deg", info.origin.longitude_rad * kDegreesPerRadian},
                      {"height_m", info.origin.height_m}};
    json["datum"] = info.datum;
    if (info.epoch_year > 0.0) json["epoch_year"] = info.epoch_year;
  }
  json["descriptor_kind"] = info.descriptor_kind == DescriptorKind::kOrb ? "orb" : "sift";
  json["landmarks"] = info.landmarks;
  json["descriptors"] = info.descriptors;
  json["images"] = info.images;
  json["building_parts"] = info.building_parts;
  json["lists"] = map.quantizer().list_count();
  json["bytes"] = FileSize(path);
  json["median_sigma_m"] = summary.median_sigma_m;
  json["worst_sigma_m"] = summary.worst_sigma_m;
  const auto corner = [](const Eigen::Vector3d& at) {
    return ordered_json::array({at.x(), at.y(), at.z()});
  };
  json["least_enu_m"] = corner(summary.least);
  json["greatest_enu_m"] = corner(summary.greatest);
  json["provenance"] = info.provenance;
  return json;
}

void PrintJson(const ordered_json& list) {
  PrintResult(list.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

int RunMapInfo(const MapFileOptions& options) {
  int exit_code = kExitGood;
  ordered_json list = ordered_json::array();
  for (const std::string& path : options.maps) {
    const Result<std::unique_ptr<FeatureMap>> map = FeatureMap::Open(path);
    const Result<std::vector<Landmark>> landmarks =
        map ? (*map)->Landmarks() : Result<std::vector<Landmark>>(map.error());
    if (!landmarks) {
      exit_code = std::max(exit_code, ReportError(landmarks.error()));
      list.push_back({{"file", path}, {"error", landmarks.error().message}});
      continue;
    }
    const LandmarkSummary summary = Summarise(*landmarks);
    if (options.json) {
      list.push_back(InfoJson(path, **map, summary));
    } else {
      PrintResult(InfoText(path, **map, summary, StdoutIsTerminal()));
    }
  }
  if (options.json) PrintJson(list);
  return exit_code;
}

int RunMapCheck(const MapFileOptions& options) {
  int exit_code = kExitGood;
  ordered_json list = ordered_json::array();
  for (const std::string& path : options.maps) {
    std::vector<Error> faults;
    const Result<std::unique_ptr<FeatureMap>> map = FeatureMap::Open(path);
    if (map) {
      faults = (*map)->Check(kMostFaults);
    } else {
      faults.push_back(map.error());
    }
    ordered_json row = {{"file", path}, {"sound", faults.empty()}};
    row["faults"] = ordered_json::array();
    std::string text;
    for (const Error& fault : faults) {
      row["faults"].push_back(fault.message);
      text += Printable(fault.message) + "\n";
    }
    if (faults.empty()) {
      text = Printable(path) + ": sound: " + Counted((*map)->info().landmarks, "landmark") + ", " +
             Counted((*map)->info().descriptors, "descriptor") + "\n";
    } else {
      text += Printable(path) + ": of no use" +
              (faults.size() == kMostFaults ? ", and maybe more is wrong\n" : "\n");
      exit_code = kExitInput;
    }
    list.push_back(row);
    if (!options.json) PrintResult(text);
  }
  if (options.json) PrintJson(list);
  return exit_code;
}

void AddMapFileCommand(CLI::App& map, const char* name, const char* what,
                       int (*run)(const MapFileOptions&), int* exit_code) {
  const auto options = std::make_shared<MapFileOptions>();
  CLI::App* command = map.add_subcommand(name, what);
  command->add_option("MAP", options->maps, "Map files")->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, exit_code, run] { *exit_code = run(*options); });
}

}  // namespace

void AddMapInfoCommand(CLI::App& map, int* exit_code) {
  AddMapFileCommand(map, "info", "What maps hold: place, landmarks, descriptors", RunMapInfo,
                    exit_code);
}

void AddMapCheckCommand(CLI::App& map, int* exit_code) {
  AddMapFileCommand(map, "check",
                    "Whether every value of maps is sound; exits with 2 if one is not", RunMapCheck,
                    exit_code);
}

}  // namespace lodemark
