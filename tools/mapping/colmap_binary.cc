// COLMAP's cameras.bin, images.bin and points3D.bin: little-endian, no padding.
#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "tools/mapping/colmap_camera_models.h"
#include "tools/mapping/colmap_model.h"

namespace lodemark {
namespace {

constexpr std::size_t kCameraBytes = 24;  // without parameters
constexpr std::size_t kImageBytes = 73;   // without name and features
constexpr std::size_t kFeatureBytes = 24;
constexpr std::size_t kPointBytes = 51;  // without sights
constexpr std::size_t kSightBytes = 8;

// Takes values from the front of the bytes. The first fault ends everything in an error.
class ByteReader {
 public:
  ByteReader(const std::string& name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  template <typename Value>
  bool Read(const char* field, Value* value) {
    if (left() < sizeof *value) return Fail(std::string("ends within ") + field);
    std::memcpy(value, bytes_.data() + at_, sizeof *value);
    at_ += sizeof *value;
    return true;
  }

  bool ReadNumber(const char* field, double* value) {
    if (!Read(field, value)) return false;
    return IsSoundColmapNumber(*value) || Fail(std::string(field) + " is out of range");
  }

  bool ReadPlace(const char* field, Eigen::Vector3d* place) {
    return ReadNumber(field, &place->x()) && ReadNumber(field, &place->y()) &&
           ReadNumber(field, &place->z());
  }

  // A count of things of at least so many bytes each, which must fit in what is left.
  bool ReadCount(const char* field, std::size_t least_bytes, std::uint64_t* count) {
    if (!Read(field, count)) return false;
    return *count <= left() / least_bytes || Fail(std::string("says ") + std::to_string(*count) +
                                                  " " + field + ", more than the file holds");
  }

  bool ReadName(std::string* name) {
    const std::string_view rest = bytes_.substr(at_, kLongestColmapName + 1);
    const std::size_t end = rest.find('\0');
    if (end == std::string_view::npos) return Fail("an image's name has no end");
    if (end == 0) return Fail("an image has no name");
    *name = rest.substr(0, end);
    at_ += end + 1;
    return true;
  }

  bool Fail(const std::string& what) {
    if (status_.ok()) {
      status_ = Error{ErrorCode::kBadData, name_ + ": byte " + std::to_string(at_) + ": " + what};
    }
    return false;
  }

  std::size_t left() const { return bytes_.size() - at_; }
  const Status& status() const { return status_; }

 private:
  const std::string& name_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  Status status_;
};

bool ReadCamera(ByteReader* bytes, ColmapCamera* camera) {
  std::int32_t number = 0;
  if (!bytes->Read("a camera", &camera->id) || !bytes->Read("a camera", &number)) return false;
  const ColmapCameraModel* const model = ColmapCameraModelByNumber(number);
  if (model == nullptr) {
    return bytes->Fail("camera model " + std::to_string(number) + " is not known");
  }
  camera->model = model->name;
  if (!bytes->Read("a camera", &camera->width_px) || !bytes->Read("a camera", &camera->height_px)) {
    return false;
  }
  camera->parameters.resize(model->parameters);
  for (double& parameter : camera->parameters) {
    if (!bytes->ReadNumber("a camera's parameter", &parameter)) return false;
  }
  return true;
}

bool ReadImage(ByteReader* bytes, ColmapImage* image) {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;
  if (!bytes->Read("an image", &image->id) ||
      !bytes->ReadNumber("an image's rotation", &rotation.w()) ||
      !bytes->ReadNumber("an image's rotation", &rotation.x()) ||
      !bytes->ReadNumber("an image's rotation", &rotation.y()) ||
      !bytes->ReadNumber("an image's rotation", &rotation.z()) ||
      !bytes->ReadPlace("an image's translation", &translation) ||
      !bytes->Read("an image", &image->camera_id) || !bytes->ReadName(&image->name)) {
    return false;
  }
  if (!(rotation.norm() > 1e-6)) return bytes->Fail("an image's rotation is no quaternion");
  image->camera_from_world = Rigid3(rotation, translation);
  std::uint64_t count = 0;
  if (!bytes->ReadCount("features", kFeatureBytes, &count)) return false;
  image->features.resize(count);
  for (ColmapFeature& feature : image->features) {
    if (!bytes->ReadNumber("a feature's place", &feature.x_px) ||
        !bytes->ReadNumber("a feature's place", &feature.y_px) ||
        !bytes->Read("a feature", &feature.point_id)) {
      return false;
    }
  }
  return true;
}

bool ReadPoint(ByteReader* bytes, ColmapPoint* point) {
  std::uint8_t color = 0;
  if (!bytes->Read("a point", &point->id) ||
      !bytes->ReadPlace("a point's place", &point->position) || !bytes->Read("a point", &color) ||
      !bytes->Read("a point", &color) || !bytes->Read("a point", &color) ||
      !bytes->ReadNumber("a point's error", &point->error_px)) {
    return false;
  }
  std::uint64_t count = 0;
  if (!bytes->ReadCount("sights", kSightBytes, &count)) return false;
  point->sights.resize(count);
  for (ColmapSight& sight : point->sights) {
    if (!bytes->Read("a sight", &sight.image_id) || !bytes->Read("a sight", &sight.feature)) {
      return false;
    }
  }
  return true;
}

template <typename Thing>
Result<std::vector<Thing>> ReadAll(const std::string& name, std::string_view content,
                                   const char* things, std::size_t least_bytes,
                                   bool (*read)(ByteReader*, Thing*)) {
  ByteReader bytes(name, content);
  std::uint64_t count = 0;
  if (!bytes.ReadCount(things, least_bytes, &count)) return bytes.status().error();
  std::vector<Thing> all;
  all.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    Thing thing;
    if (!read(&bytes, &thing)) return bytes.status().error();
    all.push_back(std::move(thing));
  }
  if (bytes.left() > 0) {
    bytes.Fail("has " + std::to_string(bytes.left()) + " bytes after the last of its " + things);
    return bytes.status().error();
  }
  return all;
}

}  // namespace

Result<std::vector<ColmapCamera>> ParseColmapCamerasBinary(const std::string& name,
                                                           std::string_view bytes) {
  return ReadAll<ColmapCamera>(name, bytes, "cameras", kCameraBytes, ReadCamera);
}

Result<std::vector<ColmapImage>> ParseColmapImagesBinary(const std::string& name,
                                                         std::string_view bytes) {
  return ReadAll<ColmapImage>(name, bytes, "images", kImageBytes, ReadImage);
}

Result<std::vector<ColmapPoint>> ParseColmapPointsBinary(const std::string& name,
                                                         std::string_view bytes) {
  return ReadAll<ColmapPoint>(name, bytes, "points", kPointBytes, ReadPoint);
}

}  // namespace lodemark
