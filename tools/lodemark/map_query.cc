// lodemark map query: where a photograph was taken.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "lodemark/lodemark.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/lens_file.h"
#include "tools/lodemark/map_commands.h"
#include "tools/lodemark/pose_text.h"
#include "tools/lodemark/sight_drawing.h"
#include "tools/lodemark/sights_table.h"
#include "tools/lodemark/view_options.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

struct QueryOptions {
  std::string map;
  std::vector<std::string> photos;
  std::string camera;
  std::string draw;
  std::string sights;
  ViewOptions view;
  lodemark_query_options query = {};
  bool json = false;
};

struct MapCloser {
  void operator()(lodemark_map* map) const { lodemark_map_close(map); }
};
using MapHandle = std::unique_ptr<lodemark_map, MapCloser>;

Error LastError(lodemark_status status, const std::string& where) {
  const ErrorCode code = status == LODEMARK_ERROR_IO         ? ErrorCode::kIo
                         : status == LODEMARK_ERROR_BAD_DATA ? ErrorCode::kBadData
                         : status == LODEMARK_ERROR_INTERNAL ? ErrorCode::kInternal
                                                             : ErrorCode::kInvalidArgument;
  const std::string message = lodemark_last_error();
  return {code, where.empty() ? message : where + ": " + message};
}

// What one photograph gave.
struct Answer {
  lodemark_pose pose = {};
  std::vector<lodemark_sight> sights;
  std::vector<lodemark_sight_residual> residuals;
};

Result<Answer> Ask(lodemark_map* map, const Photo& photo, const LensFile& lens,
                   const std::optional<lodemark_view_prior>& prior, const QueryOptions& options) {
  Answer answer;
  answer.pose.struct_size = sizeof answer.pose;
  answer.sights.resize(LODEMARK_LARGEST_COUNT);
  answer.residuals.resize(LODEMARK_LARGEST_COUNT);
  answer.sights[0].struct_size = sizeof(lodemark_sight);
  answer.residuals[0].struct_size = sizeof(lodemark_sight_residual);
  std::int32_t count = 0;
  const lodemark_status status = lodemark_map_locate(
      map, &lens.lens, photo.pixels.data(), photo.width_px, prior ? &*prior : nullptr,
      &options.query, &lens.resect, &answer.pose, answer.sights.data(), answer.residuals.data(),
      LODEMARK_LARGEST_COUNT, &count);
  if (status < 0) return LastError(status, photo.path);
  answer.sights.resize(static_cast<std::size_t>(count));
  answer.residuals.resize(static_cast<std::size_t>(count));
  return answer;
}

// "a.png" for the only photograph; "a_0001.png" for the photograph 0001.jpg among several.
std::string PerPhoto(const std::string& path, const std::string& photo, bool several) {
  if (!several) return path;
  const std::size_t slash = photo.find_last_of('/');
  std::string stem = slash == std::string::npos ? photo : photo.substr(slash + 1);
  stem = stem.substr(0, stem.find_last_of('.'));
  const std::size_t dot = path.find_last_of('.');
  return dot == std::string::npos ? path + "_" + stem
                                  : path.substr(0, dot) + "_" + stem + path.substr(dot);
}

// Of a map that lies nowhere on the earth.
std::optional<EnuFrame> LocalFrame(const lodemark_map* map) {
  lodemark_map_info info = {};
  info.struct_size = sizeof info;
  if (lodemark_map_read_info(map, &info) != LODEMARK_OK ||
      std::string_view(info.datum) != "local") {
    return std::nullopt;
  }
  return EnuFrame({info.origin_geodetic[0] * kRadiansPerDegree,
                   info.origin_geodetic[1] * kRadiansPerDegree, info.origin_geodetic[2]});
}

int RunQuery(const QueryOptions& options) {
  const Result<LensFile> lens = ReadLensFile(options.camera);
  if (!lens) return ReportError(lens.error());
  const Result<std::optional<lodemark_view_prior>> prior = PriorFrom(options.view);
  if (!prior) {
    PrintMessage(prior.error().message);
    return kExitUsage;
  }
  lodemark_map* opened = nullptr;
  if (const lodemark_status status = lodemark_map_open(options.map.c_str(), &opened);
      status != LODEMARK_OK) {
    return ReportError(LastError(status, ""));
  }
  const MapHandle map(opened);
  const std::optional<EnuFrame> frame = LocalFrame(map.get());

  nlohmann::ordered_json answers = nlohmann::ordered_json::array();
  int exit_code = kExitGood;
  const bool several = options.photos.size() > 1;
  for (const std::string& path : options.photos) {
    const Result<Photo> photo = ReadPhoto(path);
    if (!photo) return ReportError(photo.error());
    const Result<LensFile> fitted = LensFor(*photo, *lens);
    if (!fitted) return ReportError(fitted.error());
    const Result<Answer> answer = Ask(map.get(), *photo, *fitted, *prior, options);
    if (!answer) return ReportError(answer.error());
    const auto sights = static_cast<std::int32_t>(answer->sights.size());
    if (options.json) {
      nlohmann::ordered_json json = {{"photo", path}};
      json.update(PoseJson(answer->pose, sights, frame ? &*frame : nullptr));
      answers.push_back(std::move(json));
    } else {
      PrintResult(path + "\n" + PoseText(answer->pose, sights, frame ? &*frame : nullptr));
    }
    const bool has_pose =
        answer->pose.verdict == LODEMARK_POSE_GOOD || answer->pose.verdict == LODEMARK_POSE_WEAK;
    if (!has_pose) {
      FlushResults();
      PrintMessage(path + ": " + WhyNoPose(answer->pose, sights));
      exit_code = kExitMissed;
    }
    if (!options.draw.empty()) {
      const std::string to = PerPhoto(options.draw, path, several);
      const Status drawn = DrawSights(*photo, answer->sights, answer->residuals, to);
      if (!drawn) return ReportError(drawn.error());
    }
    if (!options.sights.empty()) {
      const std::string to = PerPhoto(options.sights, path, several);
      const Status written = WriteFileWhole(to, SightsTable(answer->sights, answer->residuals));
      if (!written) return ReportError(written.error());
    }
  }
  if (options.json) {
    PrintResult(answers.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                "\n");
  }
  return exit_code;
}

}  // namespace

void AddMapQueryCommand(CLI::App& map, int* exit_code) {
  const auto options = std::make_shared<QueryOptions>();
  options->query.struct_size = sizeof options->query;
  CLI::App* command = map.add_subcommand("query", "Where photographs were taken");
  command->add_option("MAP", options->map, "A map that 'lodemark map' made")->required();
  command->add_option("PHOTO", options->photos, "Photographs of one camera")->required();
  command
      ->add_option("--camera", options->camera,
                   "Its lens: the camera.json of 'lodemark calibrate', or an OpenCV yml")
      ->required();
  AddViewOptions(*command, &options->view);
  command
      ->add_option("--features", options->query.most_features,
                   "Most features to detect (default 4000)")
      ->check(CLI::Range(1, LODEMARK_LARGEST_COUNT));
  command
      ->add_option("--longest-side", options->query.longest_side_px,
                   "Scale larger photographs down to this many pixels first (default 1600)")
      ->check(CLI::Range(16, 65'535));
  command->add_option("--draw", options->draw,
                      "Draw the sights into this .png or .jpg (a name is added for several)");
  command->add_option("--sights", options->sights, "Write the sights into this csv");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, exit_code] { *exit_code = RunQuery(*options); });
}

}  // namespace lodemark
