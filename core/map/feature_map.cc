#include "core/map/feature_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/map/feature_map_database.h"

namespace lodemark {
namespace {

// Says no more than the file could hold, whatever its first row claims.
constexpr std::int64_t kLeastLandmark_bytes = 16;

Result<MapFile> LoadForReading(Result<std::unique_ptr<SqliteConnection>> connection) {
  if (!connection) return connection.error();
  return LoadMapFile(*std::move(connection), MapAccess::kRead);
}

}  // namespace

FeatureMap::FeatureMap(std::unique_ptr<Database> database) : database_(std::move(database)) {}

FeatureMap::~FeatureMap() = default;

Result<std::unique_ptr<FeatureMap>> FeatureMap::Finish(Result<MapFile> file) {
  if (!file) return file.error();
  auto database = std::make_unique<Database>(*std::move(file));
  if (Status status = database->Prepared(); !status) return status.error();
  // Still in the transaction in which everything was read.
  const Result<std::int64_t> version = database->ContentVersion();
  if (!version) return version.error();
  database->content_version = *version;
  if (Status status = database->file.connection->Execute("ROLLBACK"); !status) {
    return status.error();
  }
  return std::unique_ptr<FeatureMap>(new FeatureMap(std::move(database)));
}

Result<std::unique_ptr<FeatureMap>> FeatureMap::Open(const std::string& path) {
  return Finish(LoadForReading(SqliteConnection::Open(path, SqliteConnection::Mode::kRead)));
}

Result<std::unique_ptr<FeatureMap>> FeatureMap::OpenBytes(std::string name,
                                                          std::vector<std::uint8_t> bytes) {
  return Finish(LoadForReading(SqliteConnection::OpenBytes(std::move(name), std::move(bytes))));
}

const MapInfo& FeatureMap::info() const { return database_->file.map.info; }

const DescriptorQuantizer& FeatureMap::quantizer() const { return *database_->file.quantizer; }

std::uint32_t FeatureMap::landmark_id_limit() const { return database_->file.landmark_id_limit; }

Result<std::vector<Landmark>> FeatureMap::Landmarks() const {
  const Reading reading(database_.get());
  if (!reading.status()) return reading.status().error();
  std::vector<Landmark> landmarks;
  landmarks.reserve(static_cast<std::size_t>(
      std::min(info().landmarks, database_->file.size_bytes / kLeastLandmark_bytes)));
  const Status status = database_->ForEachLandmark(
      0, kLargestLandmarkId, [&](const LandmarkRow& row) { landmarks.push_back(row.landmark); });
  if (!status) return status.error();
  return landmarks;
}

Result<std::vector<Landmark>> FeatureMap::LandmarksById(std::span<const std::uint32_t> ids) const {
  if (!std::is_sorted(ids.begin(), ids.end())) {
    return Error{ErrorCode::kInvalidArgument, "ids of landmarks do not ascend"};
  }
  const Reading reading(database_.get());
  if (!reading.status()) return reading.status().error();
  std::vector<Landmark> landmarks;
  for (const std::uint32_t id : ids) {
    if (id >= landmark_id_limit()) break;
    if (!landmarks.empty() && landmarks.back().id == id) continue;
    const Status status = database_->ForEachLandmark(
        id, id, [&](const LandmarkRow& row) { landmarks.push_back(row.landmark); });
    if (!status) return status.error();
  }
  return landmarks;
}

Result<std::vector<Landmark>> FeatureMap::LandmarksWithin(const Eigen::Vector3d& place_in_enu_m,
                                                          double distance_m) const {
  if (!place_in_enu_m.allFinite() || std::isnan(distance_m)) {
    return Error{ErrorCode::kInvalidArgument, "the place to look around is not a number"};
  }
  const Reading reading(database_.get());
  if (!reading.status()) return reading.status().error();
  std::vector<Landmark> landmarks;
  if (distance_m < 0.0) return landmarks;
  const Result<std::vector<std::uint32_t>> ids =
      database_->LandmarkIdsAround({place_in_enu_m, distance_m});
  if (!ids) return ids.error();
  for (const std::uint32_t id : *ids) {
    bool found = false;
    // The tree's boxes are of single precision and a little too large.
    const Status status = database_->ForEachLandmark(id, id, [&](const LandmarkRow& row) {
      found = true;
      const Eigen::Vector3d offset_m = row.landmark.position_in_enu_m - place_in_enu_m;
      if (offset_m.norm() <= distance_m) landmarks.push_back(row.landmark);
    });
    if (!status) return status.error();
    if (!found) {
      return database_->Bad("landmark_places: id " + std::to_string(id) +
                            ": there is no such landmark");
    }
  }
  return landmarks;
}

Result<std::vector<DatabaseImage>> FeatureMap::Images() const {
  const Reading reading(database_.get());
  if (!reading.status()) return reading.status().error();
  return database_->Images();
}

Result<std::vector<BuildingPart>> FeatureMap::BuildingParts() const {
  const Reading reading(database_.get());
  if (!reading.status()) return reading.status().error();
  return database_->BuildingParts();
}

Status FeatureMap::VisitLists(std::span<const int> lists, const ListVisitor& visit) const {
  const Reading reading(database_.get());
  if (!reading.status()) return reading.status();
  for (const int list : lists) {
    if (list < 0) return Error{ErrorCode::kInvalidArgument, "the number of a list is negative"};
    const Status status = database_->list_parts.ForEach(
        ListPartKey(list, 0), ListPartKey(list + std::int64_t{1}, 0) - 1,
        [&](std::int64_t, const DescriptorListView& view) { visit(list, view); });
    if (!status) return status;
  }
  return {};
}

}  // namespace lodemark
