#include "core/map/map_rows.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "core/geo/polygon.h"

namespace lodemark {
namespace {

constexpr std::size_t kLongestName_bytes = 1'000;
constexpr std::size_t kLongestProvenance_bytes = 100'000;
constexpr float kFarthestSight_m = 201'000.0F;  // across the map, and rounded
constexpr double kUnitTolerance = 1e-6;         // of a quaternion's length
// Of a correlation and of the determinant of three: room for a covariance that was turned and
// rounded on its way here, of a place known a million times better along one line than along
// another.
constexpr double kCorrelationTolerance = 1e-6;

// Reads a row's columns one after another and keeps the first thing wrong.
class Fields {
 public:
  explicit Fields(const SqliteStatement& row) : row_(row) {}

  std::int64_t Integer(const char* field, std::int64_t least, std::int64_t most) {
    const std::optional<std::int64_t> value = row_.Integer(column_++);
    if (!value) {
      Keep(field, "is not an integer");
    } else if (*value < least || *value > most) {
      Keep(field, "is out of range");
    } else {
      return *value;
    }
    return least;
  }

  double Real(const char* field) {
    const std::optional<double> value = row_.Real(column_++);
    if (!value) {
      Keep(field, "is not a number");
    } else if (!std::isfinite(*value)) {
      Keep(field, "is not finite");
    } else {
      return *value;
    }
    return 0.0;
  }

  std::string Text(const char* field) {
    const std::optional<std::string_view> value = row_.Text(column_++);
    if (!value) Keep(field, "is not text");
    // As many bytes as WrongWith needs to see that there are too many.
    return std::string(value.value_or("").substr(0, kLongestProvenance_bytes + 1));
  }

  Eigen::Vector3d Place() {
    const double east_m = Real("east_m");
    const double north_m = Real("north_m");
    const double up_m = Real("up_m");
    return {east_m, north_m, up_m};
  }

  const std::string& wrong() const { return wrong_; }

 private:
  void Keep(const char* field, const char* why) {
    if (wrong_.empty()) wrong_.append(field).append(" ").append(why);
  }

  const SqliteStatement& row_;
  int column_ = 0;
  std::string wrong_;
};

// UTF-8 without control characters, which could do things to a terminal; lines may end.
bool IsPlainText(std::string_view text, bool many_lines) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t at) {
      return at < text.size() ? static_cast<std::uint8_t>(text[at]) : std::uint8_t{0};
    };
    const std::uint8_t first = byte(i);
    if (first < 0x80) {
      if (first == 0x7f) return false;
      if (first < 0x20 && !(many_lines && (first == '\n' || first == '\t'))) return false;
      ++i;
      continue;
    }
    const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
    if (first < 0xc2 || first > 0xf4) return false;
    std::uint32_t point = first & (0x3fU >> more);
    for (int k = 1; k <= more; ++k) {
      const std::uint8_t next = byte(i + static_cast<std::size_t>(k));
      if ((next & 0xc0) != 0x80) return false;
      point = (point << 6) | (next & 0x3fU);
    }
    constexpr std::uint32_t kLeast[] = {0, 0xa0, 0x800, 0x10000};  // C1 controls end at 0x9f
    if (point < kLeast[more] || point > 0x10ffff) return false;
    if (point >= 0xd800 && point <= 0xdfff) return false;
    i += static_cast<std::size_t>(more) + 1;
  }
  return true;
}

std::optional<std::string> WrongText(const char* field, std::string_view text, std::size_t longest,
                                     bool many_lines = false) {
  if (text.size() > longest) return std::string(field) + " is too long";
  if (!IsPlainText(text, many_lines)) return std::string(field) + " is not plain UTF-8 text";
  return std::nullopt;
}

// Positive semidefinite is what the correlations say; scales that differ by any factor then do no
// harm.
std::optional<std::string> WrongWithCovariance(const Eigen::Matrix3d& covariance_m2) {
  if (!covariance_m2.allFinite()) return "covariance is not finite";
  const Eigen::Vector3d variance_m2 = covariance_m2.diagonal();
  if (variance_m2.minCoeff() < 0.0) return "covariance is not positive";
  if (variance_m2.maxCoeff() > kLargestVariance_m2) return "covariance is above (1 km)^2";
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (i == k) continue;
      const double scale_m2 = std::sqrt(variance_m2[i]) * std::sqrt(variance_m2[k]);
      if (scale_m2 > 0.0) {
        correlation(i, k) = covariance_m2(i, k) / scale_m2;
      } else if (covariance_m2(i, k) != 0.0) {
        return "covariance is not positive";
      } else {
        correlation(i, k) = 0.0;
      }
    }
  }
  if ((correlation - correlation.transpose()).cwiseAbs().maxCoeff() > kCorrelationTolerance) {
    return "covariance is not symmetric";
  }
  if (correlation.cwiseAbs().maxCoeff() > 1.0 + kCorrelationTolerance ||
      correlation.determinant() < -kCorrelationTolerance) {
    return "covariance is not positive";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> WrongWith(const Eigen::Vector3d& position_in_enu_m) {
  if (!position_in_enu_m.allFinite()) return "position is not finite";
  // Each alone first: the norm of huge numbers is infinite, and that of NaN passes no comparison.
  if (position_in_enu_m.cwiseAbs().maxCoeff() > kFarthestFromOrigin_m ||
      position_in_enu_m.norm() > kFarthestFromOrigin_m) {
    return "position is more than 100 km from the origin";
  }
  return std::nullopt;
}

std::optional<std::string> WrongWith(const BuildingPart& part) {
  if (part.id > kLargestId) return "id is out of range";
  if (auto wrong = WrongText("building", part.building, kLongestName_bytes)) return wrong;
  const std::vector<Eigen::Vector2d>& footprint = part.footprint_in_enu_m;
  if (footprint.size() < 3) return "has fewer than three corners";
  if (static_cast<std::int64_t>(footprint.size()) > kMostCorners) return "has too many corners";
  for (const Eigen::Vector2d& corner : footprint) {
    for (const double up_m : {part.base_m, part.top_m}) {
      if (auto wrong = WrongWith(Eigen::Vector3d(corner.x(), corner.y(), up_m))) return wrong;
    }
  }
  if (!IsConvexCounterclockwise(footprint)) return "footprint is not convex and counterclockwise";
  if (!(part.top_m > part.base_m)) return "top is not above its base";
  if (!(part.top_m - part.base_m <= kTallestBuilding_m)) return "is taller than 1000 m";
  if (!(part.top_sigma_m >= 0.0 && part.top_sigma_m <= kTallestBuilding_m)) {
    return "top_sigma_m is out of range";
  }
  return std::nullopt;
}

std::optional<std::string> WrongWith(const Landmark& landmark) {
  if (landmark.id > kLargestLandmarkId) return "id is above " + std::to_string(kLargestLandmarkId);
  if (auto wrong = WrongWith(landmark.position_in_enu_m)) return wrong;
  return WrongWithCovariance(landmark.covariance_m2);
}

std::optional<std::string> WrongWith(const DatabaseImage& image) {
  if (image.id > kLargestId) return "id is above " + std::to_string(kLargestId);
  if (auto wrong = WrongText("name", image.name, kLongestName_bytes)) return wrong;
  if (auto wrong = WrongWith(image.position_in_enu_m)) return wrong;
  const double norm = image.camera_from_enu.norm();
  if (!(std::abs(norm - 1.0) <= kUnitTolerance)) return "attitude is not a unit quaternion";
  return std::nullopt;
}

std::optional<std::string> WrongWith(const DescriptorOrigin& origin) {
  if (origin.landmark_id > kLargestLandmarkId) return "landmark is out of range";
  if (origin.image_id > kLargestId) return "image is out of range";
  // The packed form rounds what it stores.
  constexpr float kRoundedUnitTolerance = 0.02F;
  const float norm = origin.direction_to_camera.norm();
  if (norm != 0.0F && !(std::abs(norm - 1.0F) <= kRoundedUnitTolerance)) {
    return "direction is not of unit length";
  }
  if (!(origin.distance_m >= 0.0F && origin.distance_m <= kFarthestSight_m)) {
    return "distance is out of range";
  }
  return std::nullopt;
}

std::optional<std::string> WrongWith(const MapInfo& info) {
  if (!(std::abs(info.origin.latitude_rad) <= std::numbers::pi / 2)) {
    return "latitude of the origin is out of range";
  }
  if (!(std::abs(info.origin.longitude_rad) <= 2 * std::numbers::pi)) {
    return "longitude of the origin is out of range";
  }
  // From the deepest trench to where nobody photographs landmarks.
  if (!(info.origin.height_m >= -12'000.0 && info.origin.height_m <= 100'000.0)) {
    return "height of the origin is out of range";
  }
  if (!(info.epoch_year == 0.0 || (info.epoch_year >= 1900.0 && info.epoch_year <= 2200.0))) {
    return "epoch is out of range";
  }
  if (info.descriptor_kind != DescriptorKind::kRootSift &&
      info.descriptor_kind != DescriptorKind::kOrb) {
    return "kind of the descriptors is unknown";
  }
  if (auto wrong = WrongText("datum", info.datum, kLongestName_bytes)) return wrong;
  return WrongText("provenance", info.provenance, kLongestProvenance_bytes, true);
}

Error InRow(const SqliteConnection& connection, ErrorCode code, const char* table, std::int64_t id,
            std::string_view wrong) {
  std::string where = table;
  where.append(": id ").append(std::to_string(id)).append(": ").append(wrong);
  return connection.MakeError(code, where);
}

std::int64_t IndexId(std::string_view map_id, std::span<const std::uint8_t> quantizer) {
  // FNV-1a, 64 bits (Fowler, Noll, Vo, RFC draft "The FNV non-cryptographic hash algorithm").
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&](std::uint8_t byte) { hash = (hash ^ byte) * 0x100000001b3U; };
  for (const char c : map_id) add(static_cast<std::uint8_t>(c));
  for (const std::uint8_t byte : quantizer) add(byte);
  return static_cast<std::int64_t>(hash);
}

Result<MapRow> ReadMapRow(const SqliteConnection& connection, const SqliteStatement& row) {
  Fields fields(row);
  MapRow map;
  MapInfo& info = map.info;
  const std::int64_t key = fields.Integer("one", 1, 1);
  info.id = fields.Text("id");
  info.origin.latitude_rad = fields.Real("origin_latitude_rad");
  info.origin.longitude_rad = fields.Real("origin_longitude_rad");
  info.origin.height_m = fields.Real("origin_height_m");
  info.datum = fields.Text("datum");
  info.epoch_year = fields.Real("epoch_year");
  const std::int64_t kind = fields.Integer("descriptor_kind", 1, 2);
  info.descriptor_kind = static_cast<DescriptorKind>(kind);
  info.provenance = fields.Text("provenance");
  info.landmarks = fields.Integer("landmarks", 0, kLargestId);
  info.descriptors = fields.Integer("descriptors", 0, kLargestId);
  info.images = fields.Integer("images", 0, kLargestId);
  info.building_parts = fields.Integer("building_parts", 0, kLargestId);
  map.index_id = fields.Integer("index_id", INT64_MIN, INT64_MAX);
  map.indexed_descriptors = fields.Integer("indexed_descriptors", 0, kLargestId);
  if (!fields.wrong().empty())
    return InRow(connection, ErrorCode::kBadData, "map", key, fields.wrong());
  if (auto wrong = WrongWith(info))
    return InRow(connection, ErrorCode::kBadData, "map", key, *wrong);
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (info.id.size() != 32 || !std::all_of(info.id.begin(), info.id.end(), is_hex)) {
    return InRow(connection, ErrorCode::kBadData, "map", key, "id is not 32 hexadecimal digits");
  }
  return map;
}

Result<LandmarkRow> ReadLandmark(const SqliteConnection& connection, const SqliteStatement& row) {
  Fields fields(row);
  LandmarkRow read;
  const std::int64_t id = fields.Integer("id", 0, kLargestLandmarkId);
  read.landmark.id = static_cast<std::uint32_t>(id);
  read.landmark.position_in_enu_m = fields.Place();
  Eigen::Matrix3d& covariance_m2 = read.landmark.covariance_m2;
  covariance_m2(0, 0) = fields.Real("covariance_ee_m2");
  covariance_m2(0, 1) = covariance_m2(1, 0) = fields.Real("covariance_en_m2");
  covariance_m2(1, 1) = fields.Real("covariance_nn_m2");
  covariance_m2(0, 2) = covariance_m2(2, 0) = fields.Real("covariance_eu_m2");
  covariance_m2(1, 2) = covariance_m2(2, 1) = fields.Real("covariance_nu_m2");
  covariance_m2(2, 2) = fields.Real("covariance_uu_m2");
  read.descriptors = fields.Integer("descriptors", 0, kLargestId);
  if (!fields.wrong().empty())
    return InRow(connection, ErrorCode::kBadData, "landmarks", id, fields.wrong());
  if (auto wrong = WrongWith(read.landmark))
    return InRow(connection, ErrorCode::kBadData, "landmarks", id, *wrong);
  return read;
}

Result<DatabaseImage> ReadImage(const SqliteConnection& connection, const SqliteStatement& row) {
  Fields fields(row);
  DatabaseImage image;
  const std::int64_t id = fields.Integer("id", 0, kLargestId);
  image.id = static_cast<std::uint32_t>(id);
  image.name = fields.Text("name");
  image.pose_known = fields.Integer("pose_known", 0, 1) == 1;
  image.position_in_enu_m = fields.Place();
  image.camera_from_enu.w() = fields.Real("camera_from_enu_w");
  image.camera_from_enu.x() = fields.Real("camera_from_enu_x");
  image.camera_from_enu.y() = fields.Real("camera_from_enu_y");
  image.camera_from_enu.z() = fields.Real("camera_from_enu_z");
  if (!fields.wrong().empty())
    return InRow(connection, ErrorCode::kBadData, "images", id, fields.wrong());
  if (auto wrong = WrongWith(image))
    return InRow(connection, ErrorCode::kBadData, "images", id, *wrong);
  return image;
}

Result<BuildingPart> ReadBuildingPart(const SqliteConnection& connection,
                                      const SqliteStatement& row) {
  Fields fields(row);
  BuildingPart part;
  const std::int64_t id = fields.Integer("id", 0, kLargestId);
  part.id = static_cast<std::uint32_t>(id);
  part.building = fields.Text("building");
  part.base_m = fields.Real("base_m");
  part.top_m = fields.Real("top_m");
  part.top_sigma_m = fields.Real("top_sigma_m");
  part.raised = fields.Integer("raised", 0, 1) == 1;
  if (!fields.wrong().empty()) {
    return InRow(connection, ErrorCode::kBadData, "building_parts", id, fields.wrong());
  }
  return part;
}

Result<CornerRow> ReadCorner(const SqliteConnection& connection, const SqliteStatement& row) {
  Fields fields(row);
  CornerRow corner;
  const std::int64_t id = fields.Integer("part_id", 0, kLargestId);
  corner.part_id = static_cast<std::uint32_t>(id);
  corner.corner = fields.Integer("corner", 0, kMostCorners - 1);
  corner.place_in_enu_m.x() = fields.Real("east_m");
  corner.place_in_enu_m.y() = fields.Real("north_m");
  if (!fields.wrong().empty()) {
    return InRow(connection, ErrorCode::kBadData, "building_part_corners", id, fields.wrong());
  }
  return corner;
}

}  // namespace lodemark
