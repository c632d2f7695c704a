#include "core/logs/camera_file.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/logs/text_source.h"

namespace lodemark {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr int kDeepest = 16;  // a camera needs 3
constexpr std::size_t kMostBytes = 1 << 20;
constexpr std::size_t kLongestText = 1000;

// Relative rounding that a covariance survives when it is written with nine digits.
constexpr double kCovarianceRounding = 1e-6;

struct ModelName {
  LensModel model;
  std::string_view name;
};
constexpr std::array<ModelName, 4> kModelNames = {{
    {LensModel::kPinhole, "PINHOLE"},
    {LensModel::kBrown, "OPENCV"},
    {LensModel::kFisheye, "OPENCV_FISHEYE"},
    {LensModel::kThinPrismFisheye, "THIN_PRISM_FISHEYE"},
}};

// Where OpenCV's list of coefficients may end.
constexpr std::array kBrownCounts = {0, 4, 5, 8, 12, 14};

constexpr std::string_view kConvention =
    "pixel centres at integer coordinates, x right, y down; coefficients in OpenCV order";

bool IsCount(LensModel model, std::size_t count) {
  if (model != LensModel::kBrown) return count == static_cast<std::size_t>(CoefficientCount(model));
  return std::any_of(kBrownCounts.begin(), kBrownCounts.end(),
                     [count](int known) { return count == static_cast<std::size_t>(known); });
}

// Printable, and short enough for a message.
std::string Plain(std::string_view text) {
  std::string plain(text.substr(0, kLongestText));
  std::replace_if(
      plain.begin(), plain.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; }, '?');
  return plain;
}

// Whether a symmetric matrix could be a covariance: no negative variance in any direction, each
// quantity counted in its own sigma.
bool IsCovariance(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite() || matrix.diagonal().minCoeff() < 0.0) return false;
  Eigen::VectorXd per_sigma = matrix.diagonal().cwiseSqrt();
  for (double& value : per_sigma) value = value > 0.0 ? 1.0 / value : 0.0;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const bool fixed = per_sigma[i] == 0.0;
    if (fixed && !(matrix.row(i).isZero(0.0) && matrix.col(i).isZero(0.0))) return false;
  }
  const Eigen::MatrixXd correlation = per_sigma.asDiagonal() * matrix * per_sigma.asDiagonal();
  if (!correlation.allFinite()) return false;
  const double asymmetry = (correlation - correlation.transpose()).cwiseAbs().maxCoeff();
  if (!(asymmetry <= kCovarianceRounding)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation, Eigen::EigenvaluesOnly);
  return eigen.info() == Eigen::Success && eigen.eigenvalues()[0] >= -kCovarianceRounding;
}

// Reads member after member; the first that is wrong stays as the error.
class CameraReader {
 public:
  CameraReader(const std::string& path, const Json& json) : path_(path), json_(json) {}

  Result<CameraFile> Read() {
    ReadModel();
    file_.lens.width_px = WholeNumber("width_px");
    file_.lens.height_px = WholeNumber("height_px");
    file_.lens.fx_px = Number("fx_px");
    file_.lens.fy_px = Number("fy_px");
    file_.lens.cx_px = Number("cx_px");
    file_.lens.cy_px = Number("cy_px");
    ReadCoefficients();
    if (json_.contains("rms_px")) ReadRms();
    if (json_.contains("intrinsics_covariance")) ReadCovariance();
    ReadConvention();
    if (!status_.ok()) return status_.error();
    const Result<Lens> lens = Lens::Create(file_.lens);
    if (!lens.ok()) return Error{ErrorCode::kBadData, path_ + ": " + lens.error().message};
    return std::move(file_);
  }

 private:
  void Complain(const std::string& member, const std::string& what) {
    if (!status_.ok()) return;
    status_ = Error{ErrorCode::kBadData, path_ + ": " + member + " " + what};
  }

  void ReadModel() {
    const auto member = json_.find("model");
    const auto* name = member == json_.end() ? nullptr : member->get_ptr<const std::string*>();
    if (name == nullptr) return Complain("model", "is missing or no text");
    for (const ModelName& known : kModelNames) {
      if (known.name != *name) continue;
      file_.lens.model = known.model;
      return;
    }
    Complain("model", "'" + Plain(*name) +
                          "' is none of PINHOLE, OPENCV, OPENCV_FISHEYE, THIN_PRISM_FISHEYE");
  }

  double Number(const char* key) {
    const auto member = json_.find(key);
    if (member == json_.end() || !member->is_number()) {
      Complain(key, "is missing or no number");
      return 0.0;
    }
    return member->get<double>();
  }

  int WholeNumber(const char* key) {
    const auto member = json_.find(key);
    if (member == json_.end() || !member->is_number_integer()) {
      Complain(key, "is missing or no whole number");
      return 0;
    }
    // Lens::Create has the narrower range.
    const auto value = member->get<double>();
    if (!(value >= 1.0 && value <= 1e6)) {
      Complain(key, "is no size of an image");
      return 0;
    }
    return static_cast<int>(value);
  }

  void ReadCoefficients() {
    if (!status_.ok()) return;
    const auto member = json_.find("coefficients");
    if (member == json_.end() && file_.lens.model == LensModel::kPinhole) return;
    if (member == json_.end() || !member->is_array()) {
      return Complain("coefficients", "are missing or no list");
    }
    count_ = member->size();
    if (!IsCount(file_.lens.model, count_)) {
      return Complain("coefficients",
                      "are " + std::to_string(count_) + ", which the model does not have");
    }
    for (std::size_t i = 0; i < count_; ++i) {
      if (!(*member)[i].is_number()) {
        return Complain("coefficients", "have something other than numbers");
      }
      file_.lens.coefficients[i] = (*member)[i].get<double>();
    }
  }

  void ReadRms() {
    const double rms_px = Number("rms_px");
    if (!(rms_px >= 0.0 && std::isfinite(rms_px))) return Complain("rms_px", "is negative");
    file_.rms_px = rms_px;
  }

  void ReadCovariance() {
    if (!status_.ok()) return;
    const char* const key = "intrinsics_covariance";
    const Json& rows = *json_.find(key);
    const std::size_t size = 4 + count_;
    const Eigen::Index full = 4 + CoefficientCount(file_.lens.model);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(full, full);
    const std::string form =
        "is not " + std::to_string(size) + " rows of " + std::to_string(size) + " numbers";
    if (!rows.is_array() || rows.size() != size) return Complain(key, form);
    for (std::size_t i = 0; i < size; ++i) {
      if (!rows[i].is_array() || rows[i].size() != size) return Complain(key, form);
      for (std::size_t j = 0; j < size; ++j) {
        if (!rows[i][j].is_number()) return Complain(key, form);
        covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            rows[i][j].get<double>();
      }
    }
    if (!IsCovariance(covariance)) return Complain(key, "is no covariance");
    file_.covariance = std::move(covariance);
  }

  void ReadConvention() {
    const auto member = json_.find("convention");
    if (member == json_.end()) return;
    const auto* text = member->get_ptr<const std::string*>();
    if (text == nullptr) return Complain("convention", "is no text");
    if (text->size() > kLongestText) return Complain("convention", "is too long");
    file_.convention = *text;
  }

  const std::string& path_;
  const Json& json_;
  CameraFile file_;
  std::size_t count_ = 0;
  Status status_;
};

// The shortest list that leaves nothing out.
std::size_t WrittenCount(const CameraFile& file) {
  const LensModel model = file.lens.model;
  if (model != LensModel::kBrown) return static_cast<std::size_t>(CoefficientCount(model));
  for (const int count : kBrownCounts) {
    if (count == 0) continue;
    const auto first = file.lens.coefficients.begin() + count;
    const bool unset = std::all_of(first, file.lens.coefficients.end(), [](double value) {
      return value == 0.0 && !std::signbit(value);
    });
    const Eigen::Index rest = CoefficientCount(model) - count;
    const bool fixed = !file.covariance || (file.covariance->bottomRows(rest).isZero(0.0) &&
                                            file.covariance->rightCols(rest).isZero(0.0));
    if (unset && fixed) return static_cast<std::size_t>(count);
  }
  return kMostLensCoefficients;
}

}  // namespace

Result<CameraFile> ParseCameraFile(const std::string& path, std::string_view text) {
  if (text.size() > kMostBytes) {
    return Error{ErrorCode::kBadData, path + ": is too long for the description of a camera"};
  }
  bool too_deep = false;
  const auto watch_depth = [&too_deep](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  const Json json = Json::parse(text.begin(), text.end(), watch_depth, false);
  if (too_deep) return Error{ErrorCode::kBadData, path + ": is nested too deeply"};
  if (json.is_discarded() || !json.is_object()) {
    return Error{ErrorCode::kBadData, path + ": is not a JSON object"};
  }
  return CameraReader(path, json).Read();
}

Result<CameraFile> ReadCameraFile(const std::string& path) {
  Result<TextSource> source = TextSource::Open(path);
  if (!source.ok()) return source.error();
  std::string text(kMostBytes + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const std::size_t read = source->Read(text.data() + size, text.size() - size);
    if (read == 0) break;
    size += read;
  }
  if (!source->status().ok()) return source->status().error();
  text.resize(size);
  return ParseCameraFile(path, text);
}

Result<std::string> FormatCameraFile(const CameraFile& file) {
  const std::string path = "camera.json";
  const Result<Lens> lens = Lens::Create(file.lens);
  if (!lens.ok()) return lens.error();
  const Eigen::Index full = 4 + CoefficientCount(file.lens.model);
  if (file.covariance && (file.covariance->rows() != full || file.covariance->cols() != full ||
                          !IsCovariance(*file.covariance))) {
    return Error{ErrorCode::kInvalidArgument, path + ": intrinsics_covariance is no covariance"};
  }
  const LensParameters& p = file.lens;
  OrderedJson json;
  for (const ModelName& known : kModelNames) {
    if (known.model == p.model) json["model"] = known.name;
  }
  json["width_px"] = p.width_px;
  json["height_px"] = p.height_px;
  json["fx_px"] = p.fx_px;
  json["fy_px"] = p.fy_px;
  json["cx_px"] = p.cx_px;
  json["cy_px"] = p.cy_px;
  const std::size_t count = WrittenCount(file);
  json["coefficients"] = std::vector<double>(
      p.coefficients.begin(), p.coefficients.begin() + static_cast<std::ptrdiff_t>(count));
  if (file.rms_px) {
    if (!(*file.rms_px >= 0.0 && std::isfinite(*file.rms_px))) {
      return Error{ErrorCode::kInvalidArgument, path + ": rms_px is negative or no number"};
    }
    json["rms_px"] = *file.rms_px;
  }
  if (file.covariance) {
    OrderedJson rows = OrderedJson::array();
    for (std::size_t i = 0; i < 4 + count; ++i) {
      std::vector<double> row;
      for (std::size_t j = 0; j < 4 + count; ++j) {
        row.push_back(
            (*file.covariance)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
      rows.push_back(row);
    }
    json["intrinsics_covariance"] = std::move(rows);
  }
  if (file.convention.size() > kLongestText) {
    return Error{ErrorCode::kInvalidArgument, path + ": convention is too long"};
  }
  json["convention"] = file.convention.empty() ? std::string(kConvention) : file.convention;
  // What is no UTF-8 is replaced rather than thrown at.
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace lodemark
