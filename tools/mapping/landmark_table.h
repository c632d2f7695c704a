// Landmarks that somebody else surveyed, with what they look like: a csv file and two raw ones.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/map/descriptor.h"
#include "tools/mapping/place_columns.h"
#include "tools/mapping/table_rows.h"

namespace lodemark {

struct TableLandmark {
  std::uint32_t id = 0;
  TablePlace place;
};

// Columns landmark_id and a place; plain or gzip. In ascending order of id, none twice, all global
// or all local.
Result<std::vector<TableLandmark>> ReadLandmarkTable(TableRows rows, const PlaceOptions& options);
Result<std::vector<TableLandmark>> ReadLandmarkTable(const std::string& path,
                                                     const PlaceOptions& options);

struct LandmarkDescriptors {
  std::vector<std::uint32_t> landmark_ids;  // one for each descriptor
  std::vector<std::uint8_t> descriptors;    // one after another
};

// descriptors_path holds the descriptors one after another, ids_path a 32-bit little-endian integer
// for each: the landmark_id of its landmark, which must be in the table.
Result<LandmarkDescriptors> ReadLandmarkDescriptors(const std::string& descriptors_path,
                                                    const std::string& ids_path,
                                                    DescriptorKind kind,
                                                    const std::vector<TableLandmark>& landmarks);

}  // namespace lodemark
