// COLMAP's cameras.txt, images.txt and points3D.txt.
#include <charconv>
#include <cstring>
#include <limits>
#include <utility>

#include "tools/mapping/colmap_camera_models.h"
#include "tools/mapping/colmap_model.h"

namespace lodemark {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// Walks over lines, and words within a line. The first wrong word ends everything in an error.
class WordReader {
 public:
  WordReader(const std::string& name, std::string_view text) : name_(name), rest_(text) {}

  // The next line that is no comment; with skip_empty, that holds a word. False at the end.
  bool NextLine(bool skip_empty) {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_number_;
      SkipBlanks();
      if (!line_.empty() && line_.front() == '#') continue;
      if (line_.empty() && skip_empty) continue;
      return true;
    }
    return false;
  }

  bool AtLineEnd() {
    SkipBlanks();
    return line_.empty();
  }

  std::string_view Word() {
    SkipBlanks();
    std::size_t size = 0;
    while (size < line_.size() && !IsBlank(line_[size])) ++size;
    const std::string_view word = line_.substr(0, size);
    line_.remove_prefix(size);
    return word;
  }

  // What is left of the line, without the blanks around it.
  std::string_view RestOfLine() {
    SkipBlanks();
    std::string_view text = line_;
    while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
    line_ = {};
    return text;
  }

  template <typename Number>
  bool Read(const char* field, Number* value) {
    const std::string_view word = Word();
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, *value);
    if (!word.empty() && error == std::errc() && stop == end) return true;
    std::string quoted;
    for (const char c : word.substr(0, 24)) quoted += c >= ' ' && c <= '~' ? c : '?';
    return Fail(std::string(field) + (word.empty() ? " is missing" : " '" + quoted + "' is none"));
  }

  bool ReadNumber(const char* field, double* value) {
    if (!Read(field, value)) return false;
    return IsSoundColmapNumber(*value) || Fail(std::string(field) + " is out of range");
  }

  bool ReadPlace(const char* field, Eigen::Vector3d* place) {
    return ReadNumber(field, &place->x()) && ReadNumber(field, &place->y()) &&
           ReadNumber(field, &place->z());
  }

  // Notes the first fault; false, so that it can be returned.
  bool Fail(const std::string& what) {
    if (status_.ok()) {
      status_ =
          Error{ErrorCode::kBadData, name_ + ":" + std::to_string(line_number_) + ": " + what};
    }
    return false;
  }

  const Status& status() const { return status_; }

 private:
  void SkipBlanks() {
    while (!line_.empty() && IsBlank(line_.front())) line_.remove_prefix(1);
  }

  const std::string& name_;
  std::string_view rest_;
  std::string_view line_;
  std::int64_t line_number_ = 0;
  Status status_;
};

bool ReadCamera(WordReader* words, ColmapCamera* camera) {
  if (!words->Read("CAMERA_ID", &camera->id)) return false;
  const std::string_view name = words->Word();
  const ColmapCameraModel* const model = ColmapCameraModelByName(name);
  if (model == nullptr) {
    return words->Fail("camera model '" + std::string(name.substr(0, 40)) + "' is not known");
  }
  camera->model = model->name;
  if (!words->Read("WIDTH", &camera->width_px) || !words->Read("HEIGHT", &camera->height_px)) {
    return false;
  }
  camera->parameters.resize(model->parameters);
  for (double& parameter : camera->parameters) {
    if (!words->ReadNumber("PARAMS", &parameter)) return false;
  }
  return words->AtLineEnd() ||
         words->Fail("has more parameters than the model " + camera->model + " takes");
}

bool ReadImage(WordReader* words, ColmapImage* image) {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;
  if (!words->Read("IMAGE_ID", &image->id) || !words->ReadNumber("QW", &rotation.w()) ||
      !words->ReadNumber("QX", &rotation.x()) || !words->ReadNumber("QY", &rotation.y()) ||
      !words->ReadNumber("QZ", &rotation.z()) || !words->ReadPlace("T", &translation) ||
      !words->Read("CAMERA_ID", &image->camera_id)) {
    return false;
  }
  if (!(rotation.norm() > 1e-6)) return words->Fail("the rotation is no quaternion");
  image->camera_from_world = Rigid3(rotation, translation);
  image->name = words->RestOfLine();
  if (image->name.empty()) return words->Fail("NAME is missing");
  if (image->name.size() > kLongestColmapName) return words->Fail("NAME is too long");
  return true;
}

bool ReadFeatures(WordReader* words, ColmapImage* image) {
  while (!words->AtLineEnd()) {
    ColmapFeature feature;
    std::int64_t point_id = 0;
    if (!words->ReadNumber("POINTS2D X", &feature.x_px) ||
        !words->ReadNumber("POINTS2D Y", &feature.y_px) ||
        !words->Read("POINTS2D POINT3D_ID", &point_id)) {
      return false;
    }
    if (point_id >= 0) feature.point_id = static_cast<std::uint64_t>(point_id);
    image->features.push_back(feature);
  }
  return true;
}

bool ReadPoint(WordReader* words, ColmapPoint* point) {
  std::uint32_t color = 0;
  if (!words->Read("POINT3D_ID", &point->id) || !words->ReadPlace("X, Y or Z", &point->position)) {
    return false;
  }
  for (int i = 0; i < 3; ++i) {
    if (!words->Read("R, G or B", &color)) return false;
  }
  if (!words->ReadNumber("ERROR", &point->error_px)) return false;
  while (!words->AtLineEnd()) {
    ColmapSight sight;
    if (!words->Read("TRACK IMAGE_ID", &sight.image_id) ||
        !words->Read("TRACK POINT2D_IDX", &sight.feature)) {
      return false;
    }
    point->sights.push_back(sight);
  }
  return true;
}

}  // namespace

Result<std::vector<ColmapCamera>> ParseColmapCamerasText(const std::string& name,
                                                         std::string_view text) {
  std::vector<ColmapCamera> cameras;
  WordReader words(name, text);
  while (words.NextLine(true)) {
    ColmapCamera camera;
    if (!ReadCamera(&words, &camera)) return words.status().error();
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

Result<std::vector<ColmapImage>> ParseColmapImagesText(const std::string& name,
                                                       std::string_view text) {
  std::vector<ColmapImage> images;
  WordReader words(name, text);
  while (words.NextLine(true)) {
    ColmapImage image;
    if (!ReadImage(&words, &image)) return words.status().error();
    // The line of features may be empty, and at the end of the file absent.
    if (words.NextLine(false) && !ReadFeatures(&words, &image)) return words.status().error();
    images.push_back(std::move(image));
  }
  return images;
}

Result<std::vector<ColmapPoint>> ParseColmapPointsText(const std::string& name,
                                                       std::string_view text) {
  std::vector<ColmapPoint> points;
  WordReader words(name, text);
  while (words.NextLine(true)) {
    ColmapPoint point;
    if (!ReadPoint(&words, &point)) return words.status().error();
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace lodemark
