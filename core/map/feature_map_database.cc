#include "core/map/feature_map_database.h"

#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodemark {
namespace {

// Each box of the R*Tree takes a key and six floats.
constexpr std::int64_t kLeastBox_bytes = 32;

// Whether a box of the R*Tree reaches into the sphere that is asked for. Runs within SQLite.
int BoxWithin(sqlite3_rtree_query_info* box) {
  PlaceQuery& query = *static_cast<PlaceQuery*>(box->pContext);
  if (box->nCoord != 6 || --query.boxes_left < 0) return SQLITE_CORRUPT_VTAB;
  double squared_distance_m2 = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double least_m = box->aCoord[2 * axis];
    const double greatest_m = box->aCoord[2 * axis + 1];
    const double at_m = query.place_in_enu_m[axis];
    const double away_m = std::max({least_m - at_m, at_m - greatest_m, 0.0});
    squared_distance_m2 += away_m * away_m;
  }
  const bool within = squared_distance_m2 <= query.distance_m * query.distance_m;
  box->eWithin = within ? PARTLY_WITHIN : NOT_WITHIN;
  box->rScore = 0.0;  // in any order
  return SQLITE_OK;
}

// The statement that finds the landmarks around the query's place; makes its function known first,
// of which code tells.
const char* SelectPlaces(sqlite3* handle, PlaceQuery* query, int* code) {
  *code = sqlite3_rtree_query_callback(handle, "reached", BoxWithin, query, nullptr);
  return "SELECT id FROM landmark_places WHERE id MATCH reached()";
}

}  // namespace

FeatureMap::Database::Database(MapFile&& opened)
    : file(std::move(opened)),
      content_version_row(file.connection.get(), "PRAGMA data_version"),
      landmarks(file.connection.get(), kSelectLandmarks),
      places(file.connection.get(),
             SelectPlaces(file.connection->handle(), &place_query, &place_function_code)),
      list_parts(&file) {}

Status FeatureMap::Database::Prepared() const {
  if (place_function_code != SQLITE_OK) return file.connection->Explain(place_function_code);
  Status prepared = list_parts.status();
  for (const SqliteStatement* statement : {&content_version_row, &landmarks, &places}) {
    if (prepared) prepared = statement->status();
  }
  if (prepared || file.connection->InTransaction()) return prepared;
  // Whatever it calls the failure, SQLite gives a reader's transaction up for want of memory alone.
  return file.connection->Explain(SQLITE_NOMEM);
}

Result<std::int64_t> FeatureMap::Database::ContentVersion() {
  const bool row = content_version_row.Step();
  const std::int64_t version = row ? content_version_row.Integer(0).value_or(0) : 0;
  const Status status = content_version_row.status();
  content_version_row.Reset();
  if (!status) return status.error();
  return version;
}

Reading::Reading(FeatureMap::Database* database) : database_(database) {
  SqliteConnection& connection = *database->file.connection;
  connection.AllowWork(database->file.size_bytes);
  status_ = Begin(connection, MapAccess::kRead);
  if (!status_) return;
  const Result<std::int64_t> version = database->ContentVersion();
  if (!version) {
    status_ = version.error();
  } else if (*version != database->content_version) {
    status_ =
        connection.MakeError(ErrorCode::kIo, "was changed since it was opened; open it again");
  }
}

Reading::~Reading() {
  // A statement that is not reset would keep the file locked.
  database_->landmarks.Reset();
  database_->places.Reset();
  database_->list_parts.Reset();
  SqliteConnection& connection = *database_->file.connection;
  if (!connection.InTransaction()) return;
  connection.AllowWork(database_->file.size_bytes);
  static_cast<void>(connection.Execute("ROLLBACK").ok());
}

Status FeatureMap::Database::ForEachLandmark(std::int64_t first_id, std::int64_t last_id,
                                             const std::function<void(const LandmarkRow&)>& visit) {
  landmarks.Bind(1, first_id);
  landmarks.Bind(2, last_id);
  std::int64_t previous = -1;
  while (landmarks.Step()) {
    const Result<LandmarkRow> row = ReadLandmark(*file.connection, landmarks);
    if (!row) return row.error();
    if (row->landmark.id <= previous || row->landmark.id >= file.landmark_id_limit) {
      return Bad("landmarks: is damaged: ids do not ascend");
    }
    previous = row->landmark.id;
    visit(*row);
  }
  Status status = landmarks.status();
  landmarks.Reset();
  return status;
}

Result<std::vector<DatabaseImage>> FeatureMap::Database::Images() {
  SqliteStatement rows(file.connection.get(), kSelectImages);
  std::vector<DatabaseImage> images;
  while (rows.Step()) {
    Result<DatabaseImage> image = ReadImage(*file.connection, rows);
    if (!image) return image.error();
    if (!images.empty() && image->id <= images.back().id) {
      return Bad("images: is damaged: ids do not ascend");
    }
    images.push_back(*std::move(image));
  }
  if (Status status = rows.status(); !status) return status.error();
  return images;
}

Result<std::vector<BuildingPart>> FeatureMap::Database::BuildingParts() {
  std::vector<BuildingPart> parts;
  if (file.version == 1) {
    if (file.map.info.building_parts == 0) return parts;
    return file.connection->MakeError(
        ErrorCode::kUnsupported,
        "holds buildings in the form of version 1, which had no use; make the map again");
  }
  SqliteStatement rows(file.connection.get(), kSelectBuildingParts);
  while (rows.Step()) {
    Result<BuildingPart> part = ReadBuildingPart(*file.connection, rows);
    if (!part) return part.error();
    if (!parts.empty() && part->id <= parts.back().id) {
      return Bad("building_parts: is damaged: ids do not ascend");
    }
    parts.push_back(*std::move(part));
  }
  if (Status status = rows.status(); !status) return status.error();

  SqliteStatement corners(file.connection.get(), kSelectCorners);
  auto part = parts.begin();
  while (corners.Step()) {
    const Result<CornerRow> corner = ReadCorner(*file.connection, corners);
    if (!corner) return corner.error();
    while (part != parts.end() && part->id < corner->part_id) ++part;
    if (part == parts.end() || part->id != corner->part_id ||
        static_cast<std::int64_t>(part->footprint_in_enu_m.size()) != corner->corner) {
      return Bad("building_part_corners: part_id " + std::to_string(corner->part_id) + ": corner " +
                 std::to_string(corner->corner) +
                 " is of no part or does not follow the one before");
    }
    part->footprint_in_enu_m.push_back(corner->place_in_enu_m);
  }
  if (Status status = corners.status(); !status) return status.error();
  for (const BuildingPart& each : parts) {
    if (auto wrong = WrongWith(each)) {
      return InRow(*file.connection, ErrorCode::kBadData, "building_parts", each.id, *wrong);
    }
  }
  return parts;
}

Result<std::vector<std::uint32_t>> FeatureMap::Database::LandmarkIdsAround(
    const PlaceQuery& query) {
  place_query = query;
  place_query.boxes_left = file.size_bytes / kLeastBox_bytes + 1;
  std::vector<std::uint32_t> ids;
  while (places.Step()) {
    const std::int64_t id = places.Integer(0).value_or(-1);
    if (id < 0 || id > kLargestLandmarkId) {
      return Bad("landmark_places: id " + std::to_string(id) + ": id is out of range");
    }
    ids.push_back(static_cast<std::uint32_t>(id));
  }
  if (Status status = places.status(); !status) return status.error();
  places.Reset();
  std::sort(ids.begin(), ids.end());
  if (const auto twice = std::adjacent_find(ids.begin(), ids.end()); twice != ids.end()) {
    return Bad("landmark_places: id " + std::to_string(*twice) + ": is there twice");
  }
  return ids;
}

}  // namespace lodemark
