// The rows of a feature map's tables as values, each number checked: what a file says is refused
// where a map could not have it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/map/feature_map.h"
#include "core/map/sqlite_statement.h"

namespace lodemark {

constexpr double kFarthestFromOrigin_m = 100'000.0;
constexpr double kLargestVariance_m2 = 1e6;  // (1 km)^2
constexpr std::int64_t kLargestLandmarkId = (std::int64_t{1} << 26) - 1;
constexpr std::int64_t kLargestId = 0x7fffffff;
constexpr std::int64_t kMostCorners = 1'000;  // of one building part
constexpr double kTallestBuilding_m = 1'000.0;

// Why the value cannot be in a map: "covariance is not positive". Empty if it can.
std::optional<std::string> WrongWith(const MapInfo& info);
std::optional<std::string> WrongWith(const Landmark& landmark);
std::optional<std::string> WrongWith(const DatabaseImage& image);
std::optional<std::string> WrongWith(const Eigen::Vector3d& position_in_enu_m);
std::optional<std::string> WrongWith(const BuildingPart& part);
std::optional<std::string> WrongWith(const DescriptorOrigin& origin);

// "map.db: landmarks: id 812: covariance is not positive".
Error InRow(const SqliteConnection& connection, ErrorCode code, const char* table, std::int64_t id,
            std::string_view wrong);

// What the map's one row holds, and what only its makers need.
struct MapRow {
  MapInfo info;
  std::int64_t index_id = 0;             // IndexId of the quantiser the lists were made with
  std::int64_t indexed_descriptors = 0;  // that there were when the quantiser was trained
};

// A landmark, with the number of descriptors in the lists that are of it.
struct LandmarkRow {
  Landmark landmark;
  std::int64_t descriptors = 0;
};

// Tells one index from another, so that a list of one is not searched by another's tables.
std::int64_t IndexId(std::string_view map_id, std::span<const std::uint8_t> quantizer);

constexpr const char* kSelectMap =
    "SELECT one, id, origin_latitude_rad, origin_longitude_rad, origin_height_m, datum, "
    "epoch_year, descriptor_kind, provenance, landmarks, descriptors, images, building_parts, "
    "index_id, indexed_descriptors FROM map";

// Those from one id to another.
constexpr const char* kSelectLandmarks =
    "SELECT id, east_m, north_m, up_m, covariance_ee_m2, covariance_en_m2, covariance_nn_m2, "
    "covariance_eu_m2, covariance_nu_m2, covariance_uu_m2, descriptors FROM landmarks "
    "WHERE id BETWEEN ?1 AND ?2 ORDER BY id";
// Whatever their ids.
constexpr const char* kSelectAllLandmarks =
    "SELECT id, east_m, north_m, up_m, covariance_ee_m2, covariance_en_m2, covariance_nn_m2, "
    "covariance_eu_m2, covariance_nu_m2, covariance_uu_m2, descriptors FROM landmarks ORDER BY id";
constexpr const char* kSelectImages =
    "SELECT id, name, pose_known, east_m, north_m, up_m, camera_from_enu_w, camera_from_enu_x, "
    "camera_from_enu_y, camera_from_enu_z FROM images ORDER BY id";
constexpr const char* kSelectBuildingParts =
    "SELECT id, building, base_m, top_m, top_sigma_m, raised FROM building_parts ORDER BY id";
constexpr const char* kSelectCorners =
    "SELECT part_id, corner, east_m, north_m FROM building_part_corners "
    "ORDER BY part_id, corner";

// The row a statement of these columns stands on.
Result<MapRow> ReadMapRow(const SqliteConnection& connection, const SqliteStatement& row);
Result<LandmarkRow> ReadLandmark(const SqliteConnection& connection, const SqliteStatement& row);
Result<DatabaseImage> ReadImage(const SqliteConnection& connection, const SqliteStatement& row);

// Without its footprint.
Result<BuildingPart> ReadBuildingPart(const SqliteConnection& connection,
                                      const SqliteStatement& row);

struct CornerRow {
  std::uint32_t part_id = 0;
  std::int64_t corner = 0;
  Eigen::Vector2d place_in_enu_m = Eigen::Vector2d::Zero();
};
Result<CornerRow> ReadCorner(const SqliteConnection& connection, const SqliteStatement& row);

}  // namespace lodemark
