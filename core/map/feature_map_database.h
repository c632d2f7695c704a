// What a feature map opened for reading keeps, for the files that implement it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/map/feature_map.h"
#include "core/map/list_parts.h"
#include "core/map/map_file.h"
#include "core/map/sqlite_statement.h"

namespace lodemark {

// What a search of places is asked, and answers besides ids.
struct PlaceQuery {
  Eigen::Vector3d place_in_enu_m = Eigen::Vector3d::Zero();
  double distance_m = 0.0;
  std::int64_t boxes_left = 0;  // a tree crafted to be endless has more than fit in the file
};

struct FeatureMap::Database {
  explicit Database(MapFile&& opened);

  // Whether every statement can be run. A failure here may have ended the transaction.
  Status Prepared() const;

  // What the version of the file's content is now, as this connection counts it.
  Result<std::int64_t> ContentVersion();

  Error Bad(std::string_view sentence) const {
    return file.connection->MakeError(ErrorCode::kBadData, sentence);
  }

  // Within a Reading. Ids come ascending, in the tables and in what is returned.
  Status ForEachLandmark(std::int64_t first_id, std::int64_t last_id,
                         const std::function<void(const LandmarkRow&)>& visit);
  Result<std::vector<DatabaseImage>> Images();
  Result<std::vector<BuildingPart>> BuildingParts();
  Result<std::vector<std::uint32_t>> LandmarkIdsAround(const PlaceQuery& query);

  MapFile file;
  std::int64_t content_version = 0;
  PlaceQuery place_query;       // where the R*Tree finds the one it serves
  int place_function_code = 0;  // of SQLite, when the R*Tree was told of place_query
  SqliteStatement content_version_row;
  SqliteStatement landmarks;
  SqliteStatement places;
  ListPartReader list_parts;
};

// One call's look at the file: all it reads is of one moment, the one the map was opened in.
class Reading {
 public:
  explicit Reading(FeatureMap::Database* database);
  ~Reading();
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

  const Status& status() const { return status_; }

 private:
  FeatureMap::Database* database_;
  Status status_;
};

}  // namespace lodemark
