// lodemark resect: a camera's pose from landmarks and the pixels they were seen at.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/lens_file.h"
#include "tools/lodemark/pose_text.h"
#include "tools/lodemark/sight_drawing.h"
#include "tools/lodemark/sights_table.h"
#include "tools/lodemark/subcommands.h"
#include "tools/lodemark/view_options.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

struct ResectCommandOptions {
  std::string sights;
  std::string camera;
  std::string photo;
  std::string draw;
  std::string residuals;
  std::vector<double> origin_geodetic;
  ViewOptions view;
  double threshold_px = 0.0;
  std::uint64_t seed = 0;
  std::int32_t focal = LODEMARK_FOCAL_KNOWN;
  bool json = false;
};

// The camera's place in the local frame the landmarks were given in.
std::optional<std::vector<double>> LocalPlace(const lodemark_pose& pose, const SightsFile& file,
                                              const double (&origin_geodetic)[3]) {
  if (file.frame != LandmarkFrame::kLocal) return std::nullopt;
  std::vector<double> local(3);
  if (lodemark_enu_from_ecef(origin_geodetic, pose.ecef_m, local.data()) != LODEMARK_OK) {
    return std::nullopt;
  }
  return local;
}

int RunResect(const ResectCommandOptions& options) {
  const Result<LensFile> lens = ReadLensFile(options.camera);
  if (!lens) return ReportError(lens.error());
  double origin_geodetic[3] = {};
  std::copy(options.origin_geodetic.begin(), options.origin_geodetic.end(), origin_geodetic);
  const Result<SightsFile> file = ReadSights(options.sights, origin_geodetic);
  if (!file) return ReportError(file.error());
  const Result<std::optional<lodemark_view_prior>> prior = PriorFrom(options.view);
  if (!prior) {
    PrintMessage(prior.error().message);
    return kExitUsage;
  }

  const auto count = static_cast<std::int32_t>(file->sights.size());
  lodemark_pose pose = {};
  pose.struct_size = sizeof pose;
  std::vector<lodemark_sight_residual> residuals(file->sights.size());
  residuals[0].struct_size = sizeof(lodemark_sight_residual);
  lodemark_resect_options resect = lens->resect;
  resect.inlier_threshold_px = options.threshold_px;
  resect.seed = options.seed;
  resect.focal = options.focal;
  const lodemark_status status =
      lodemark_pose_resect(&lens->lens, file->sights.data(), count, *prior ? &**prior : nullptr,
                           &resect, &pose, residuals.data(), nullptr);
  if (status < 0) {
    PrintMessage(options.sights + ": " + lodemark_last_error());
    return status == LODEMARK_ERROR_INTERNAL ? kExitBug : kExitInput;
  }

  const bool has_pose = status == LODEMARK_OK;
  const std::optional<std::vector<double>> local =
      has_pose ? LocalPlace(pose, *file, origin_geodetic) : std::nullopt;
  if (options.json) {
    nlohmann::ordered_json json = PoseJson(pose, count, nullptr);
    if (local) json["local_enu_m"] = *local;
    PrintResult(json.dump(2) + "\n");
  } else {
    PrintResult(PoseText(pose, count, nullptr));
    if (local) {
      PrintResult(Format("  local        east %.4f, north %.4f, up %.4f m\n", (*local)[0],
                         (*local)[1], (*local)[2]));
    }
  }
  FlushResults();
  if (file->report.rows_skipped > 0) {
    PrintMessage(options.sights + ": " + Counted(file->report.rows_skipped, "malformed row") +
                 " skipped, the first is " +
                 FormatProblem(options.sights, file->report.problems.front()));
  }
  if (!has_pose) PrintMessage(options.sights + ": " + WhyNoPose(pose, count));
  if (!options.residuals.empty()) {
    const Status written = WriteFileWhole(options.residuals, SightsTable(file->sights, residuals));
    if (!written) return ReportError(written.error());
  }
  if (!options.draw.empty()) {
    const Result<Photo> photo = ReadPhoto(options.photo);
    if (!photo) return ReportError(photo.error());
    const Status drawn = DrawSights(*photo, file->sights, residuals, options.draw);
    if (!drawn) return ReportError(drawn.error());
  }
  return has_pose ? kExitGood : kExitMissed;
}

}  // namespace

void AddResectCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<ResectCommandOptions>();
  CLI::App* command =
      app.add_subcommand("resect", "A camera's pose from landmarks and where they were seen");
  command
      ->add_option(
          "SIGHTS", options->sights,
          "csv: x_px,y_px and latitude_deg,longitude_deg,height_m or x_m,y_m,z_m (ECEF) or "
          "east_m,north_m,up_m; optionally sigma_px,landmark_sigma_m,quality")
      ->required();
  command
      ->add_option("--camera", options->camera,
                   "The lens: the camera.json of 'lodemark calibrate', or an OpenCV yml")
      ->required();
  command
      ->add_option("--origin", options->origin_geodetic,
                   "Of east_m,north_m,up_m: LATITUDE,LONGITUDE,HEIGHT (default 0,0,0)")
      ->delimiter(',')
      ->expected(3);
  const std::map<std::string, std::int32_t> focal = {{"known", LODEMARK_FOCAL_KNOWN},
                                                     {"unknown", LODEMARK_FOCAL_UNKNOWN}};
  command
      ->add_option("--focal", options->focal,
                   "known (default), or unknown: found with the pose, the rest of the lens is kept")
      ->transform(CLI::CheckedTransformer(focal).description("{known,unknown}"));
  AddViewOptions(*command, &options->view);
  command
      ->add_option("--threshold", options->threshold_px,
                   "Pixels beyond which a sight is mistaken (default 5)")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "Of the random samples (default 1)");
  command->add_option("--residuals", options->residuals,
                      "Write the sights with their residuals and ranges into this csv");
  CLI::Option* photo = command->add_option("--photo", options->photo, "The photograph, to draw on");
  command
      ->add_option("--draw", options->draw,
                   "Draw the sights on the photograph into this .png or .jpg")
      ->needs(photo);
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, exit_code] { *exit_code = RunResect(*options); });
}

}  // namespace lodemark
