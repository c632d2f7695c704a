#include "tools/mapping/landmark_table.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "tools/mapping/whole_file.h"

namespace lodemark {
namespace {

enum Field : int { kId = kFirstOwnField };

constexpr ColumnName kOwnNames[] = {{"landmark_id", kId}, {"id", kId}};
constexpr auto kNames = WithPlaceColumns(kOwnNames);

constexpr std::size_t kMostRows = 100'000'000;
constexpr std::size_t kLargestFile_bytes = std::size_t{32} << 30;
constexpr double kLargestId = std::numeric_limits<std::int32_t>::max();

}  // namespace

Result<std::vector<TableLandmark>> ReadLandmarkTable(TableRows rows, const PlaceOptions& options) {
  const std::array<int, 1> required = {kId};
  const Status complete = rows.Require(required);
  if (!complete.ok()) return complete.error();
  const Result<PlaceReader> places = PlaceReader::For(rows, options);
  if (!places) return places.error();

  std::vector<TableLandmark> landmarks;
  while (rows.Next() && landmarks.size() < kMostRows) {
    TableLandmark landmark;
    landmark.id =
        static_cast<std::uint32_t>(rows.Integer(kId, 0, static_cast<std::int64_t>(kLargestId)));
    landmark.place = places->Read(&rows);
    landmarks.push_back(landmark);
  }
  if (!rows.status().ok()) return rows.status().error();
  if (landmarks.empty()) return Error{ErrorCode::kBadData, rows.name() + ": holds no landmark"};

  const auto by_id = [](const TableLandmark& a, const TableLandmark& b) { return a.id < b.id; };
  std::sort(landmarks.begin(), landmarks.end(), by_id);
  const auto twice = std::adjacent_find(
      landmarks.begin(), landmarks.end(),
      [](const TableLandmark& a, const TableLandmark& b) { return a.id == b.id; });
  if (twice != landmarks.end()) {
    return Error{ErrorCode::kBadData,
                 rows.name() + ": landmark " + std::to_string(twice->id) + " is there twice"};
  }
  return landmarks;
}

Result<std::vector<TableLandmark>> ReadLandmarkTable(const std::string& path,
                                                     const PlaceOptions& options) {
  Result<TableRows> rows = TableRows::Open(path, kNames);
  if (!rows) return rows.error();
  return ReadLandmarkTable(std::move(rows).value(), options);
}

Result<LandmarkDescriptors> ReadLandmarkDescriptors(const std::string& descriptors_path,
                                                    const std::string& ids_path,
                                                    DescriptorKind kind,
                                                    const std::vector<TableLandmark>& landmarks) {
  const Result<std::string> ids = ReadWholeFile(ids_path, kLargestFile_bytes);
  if (!ids) return ids.error();
  const Result<std::string> bytes = ReadWholeFile(descriptors_path, kLargestFile_bytes);
  if (!bytes) return bytes.error();
  const std::size_t size = DescriptorBytes(kind);
  if (ids->size() % 4 != 0) {
    return Error{ErrorCode::kBadData, ids_path + ": its " + std::to_string(ids->size()) +
                                          " bytes are no 32-bit numbers"};
  }
  const std::size_t count = ids->size() / 4;
  if (bytes->size() != count * size) {
    return Error{ErrorCode::kBadData,
                 descriptors_path + ": holds " + std::to_string(bytes->size()) + " bytes, but " +
                     std::to_string(count) + " descriptors of " + std::to_string(size) +
                     " bytes belong to the numbers in " + ids_path};
  }

  LandmarkDescriptors result;
  result.landmark_ids.resize(count);
  std::memcpy(result.landmark_ids.data(), ids->data(), ids->size());
  result.descriptors.assign(bytes->begin(), bytes->end());
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t id = result.landmark_ids[i];
    const auto at = std::lower_bound(
        landmarks.begin(), landmarks.end(), id,
        [](const TableLandmark& landmark, std::uint32_t x) { return landmark.id < x; });
    if (at != landmarks.end() && at->id == id) continue;
    return Error{ErrorCode::kBadData, ids_path + ": descriptor " + std::to_string(i) +
                                          " belongs to landmark " +
                                          std::to_string(static_cast<std::int32_t>(id)) +
                                          ", which the table of landmarks lacks"};
  }
  return result;
}

}  // namespace lodemark
