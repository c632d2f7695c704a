#include "tools/lodemark/calibration_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/camera/opencv_camera_file.h"
#include "core/logs/camera_file.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/text_table.h"

namespace lodemark {
namespace {

using nlohmann::ordered_json;

struct Intrinsic {
  std::string name;
  double value = 0.0;
  double sigma = 0.0;
  bool is_pixels = false;
};

// Those that were estimated.
std::vector<Intrinsic> IntrinsicsOf(const Calibration& calibration) {
  const LensParameters& lens = calibration.lens;
  const std::vector<std::string> names = IntrinsicNames(lens.model);
  const std::array first = {lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px};
  std::vector<Intrinsic> intrinsics;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_pixels = i < first.size();
    if (!is_pixels && !IsFree(calibration.form, static_cast<int>(i - first.size()))) continue;
    const auto index = static_cast<Eigen::Index>(i);
    intrinsics.push_back({names[i], is_pixels ? first[i] : lens.coefficients[i - first.size()],
                          std::sqrt(calibration.covariance(index, index)), is_pixels});
  }
  return intrinsics;
}

// With the digits that the sigma leaves, two of its own.
std::string WithDigitsOf(double sigma, double value) {
  const int decimals =
      sigma > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, 9) : 6;
  return Format("%.*f", decimals, value);
}

ordered_json PhotosJson(const std::vector<CalibrationPhoto>& photos) {
  ordered_json list = ordered_json::array();
  for (const CalibrationPhoto& photo : photos) {
    ordered_json one = {{"name", photo.name}, {"corners", photo.corners}, {"used", photo.is_used}};
    if (photo.is_used) {
      one["rms_px"] = photo.rms_px;
    } else {
      one["reason"] = photo.reason;
    }
    list.push_back(std::move(one));
  }
  return list;
}

ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

}  // namespace

std::string CalibrationText(const Calibration& calibration,
                            const std::vector<CalibrationPhoto>& photos, bool decorate) {
  TextTable lens({"value", "sigma"});
  lens.AddSection(Format("Lens: %s, %d x %d px", NameOf(calibration.form).c_str(),
                         calibration.lens.width_px, calibration.lens.height_px));
  for (const Intrinsic& intrinsic : IntrinsicsOf(calibration)) {
    lens.AddRow(intrinsic.name,
                {WithDigitsOf(intrinsic.sigma, intrinsic.value),
                 WithDigitsOf(intrinsic.sigma, intrinsic.sigma)},
                intrinsic.is_pixels ? "px" : "");
  }

  TextTable fit({"value"});
  fit.AddSection("Fit");
  fit.AddRow("rms of the corners", {Format("%.3f", calibration.rms_px)}, "px");
  fit.AddRow("rms of photographs left out", {Format("%.3f", calibration.held_out_rms_px)}, "px");
  fit.AddRow("noise of a coordinate", {Format("%.3f", calibration.noise_px)}, "px");
  fit.AddRow("sigmas enlarged", {Format("%.1f", std::sqrt(calibration.view_scatter))},
             "times, by what the photographs disagree beyond their noise");
  fit.AddRow("photographs used", {std::to_string(calibration.views_used)},
             "of " + std::to_string(photos.size()));

  TextTable models({"rms px", "left out"});
  models.AddSection("Models");
  for (const LadderStep& step : calibration.ladder) {
    const bool is_chosen = step.form.model == calibration.form.model &&
                           step.form.free_coefficients == calibration.form.free_coefficients;
    // A pinhole is a Brown lens without coefficients, on the ladder of those.
    const bool is_pinhole = calibration.form.model == LensModel::kPinhole &&
                            step.form.model == LensModel::kBrown &&
                            step.form.free_coefficients == 0;
    models.AddRow(NameOf(step.form),
                  {step.rms_px > 0.0 ? Format("%.3f", step.rms_px) : "",
                   std::isfinite(step.held_out_rms_px) ? Format("%.3f", step.held_out_rms_px) : ""},
                  " " + step.verdict + (is_chosen || is_pinhole ? "; chosen" : ""));
  }

  TextTable list({"corners", "rms px"});
  list.AddSection("Photographs");
  for (const CalibrationPhoto& photo : photos) {
    list.AddRow(Printable(photo.name),
                {photo.corners > 0 ? std::to_string(photo.corners) : "",
                 photo.is_used ? Format("%.3f", photo.rms_px) : ""},
                photo.is_used ? "" : " not used: " + Printable(photo.reason));
  }
  return lens.Text(decorate) + "\n" + fit.Text(decorate) + "\n" + models.Text(decorate) + "\n" +
         list.Text(decorate);
}

std::string CalibrationJson(const Calibration& calibration,
                            const std::vector<CalibrationPhoto>& photos) {
  ordered_json json;
  json["model"] = NameOf(calibration.form);
  json["width_px"] = calibration.lens.width_px;
  json["height_px"] = calibration.lens.height_px;
  for (const Intrinsic& intrinsic : IntrinsicsOf(calibration)) {
    json["intrinsics"].push_back(
        {{"name", intrinsic.name}, {"value", intrinsic.value}, {"sigma", intrinsic.sigma}});
  }
  json["rms_px"] = calibration.rms_px;
  json["held_out_rms_px"] = NumberOrNull(calibration.held_out_rms_px);
  json["noise_px"] = calibration.noise_px;
  json["sigmas_enlarged"] = std::sqrt(calibration.view_scatter);
  json["photographs_used"] = calibration.views_used;
  for (const LadderStep& step : calibration.ladder) {
    json["models"].push_back({{"model", NameOf(step.form)},
                              {"rms_px", step.rms_px},
                              {"held_out_rms_px", NumberOrNull(step.held_out_rms_px)},
                              {"kept", step.is_kept},
                              {"verdict", step.verdict}});
  }
  json["images"] = PhotosJson(photos);
  json["warnings"] = calibration.warnings;
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

Result<std::string> CalibrationFile(const Calibration& calibration,
                                    const std::vector<CalibrationPhoto>& photos,
                                    const std::string& path) {
  if (path.ends_with(".yml") || path.ends_with(".yaml")) {
    return FormatOpenCvCameraFile(calibration.lens, OpenCvFileForm::kYaml);
  }
  if (path.ends_with(".xml")) {
    return FormatOpenCvCameraFile(calibration.lens, OpenCvFileForm::kXml);
  }
  CameraFile file;
  file.lens = calibration.lens;
  file.covariance = calibration.covariance;
  file.rms_px = calibration.rms_px;
  file.convention =
      "pixel centres at integer coordinates, x right, y down; coefficients in OpenCV order";
  Result<std::string> text = FormatCameraFile(file);
  if (!text) return text.error();
  const std::size_t end = text->rfind('}');
  const std::size_t last = text->find_last_not_of(" \n", end - 1);
  std::string images;
  for (const ordered_json& photo : PhotosJson(photos)) {
    images += (images.empty() ? "\n    " : ",\n    ") +
              photo.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  }
  return text->substr(0, last + 1) + ",\n  \"images\": [" + images + "\n  ]\n}\n";
}

}  // namespace lodemark
