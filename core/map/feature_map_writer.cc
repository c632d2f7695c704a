#include "core/map/feature_map_writer.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "core/map/list_parts.h"
#include "core/map/map_file.h"
#include "core/map/sqlite_statement.h"

namespace lodemark {
namespace {

constexpr std::int64_t kGrowthBeforeReindex = 4;

}  // namespace

struct FeatureMapWriter::Database {
  Database(MapFile&& opened, bool is_new);
  ~Database();

  // Before every change: whether there still is a transaction to make it in.
  Status Ready();
  // Keeps an error after which the transaction cannot be trusted.
  Status Keep(Status status);

  Error Wrong(const char* table, std::int64_t id, std::string_view wrong) const {
    return InRow(*file.connection, ErrorCode::kInvalidArgument, table, id, wrong);
  }
  Result<bool> Has(SqliteStatement& select, std::int64_t id);
  Status RemoveLandmark(std::uint32_t id);
  Status AddToDescriptorCount(std::uint32_t landmark_id, std::int64_t count);
  Status RemoveImage(std::uint32_t image_id, bool noted);

  Status AddStaged();
  Status Learn(std::uint64_t seed);
  Status PutMapRow();

  MapFile file;
  bool never_committed;
  std::int64_t content_version = 0;
  std::optional<Error> broken;
  std::optional<std::uint64_t> reindex_seed;
  DescriptorBatch staged;
  std::size_t bytes_each;

  ListPartWriter lists;
  SqliteStatement content_version_row;
  SqliteStatement select_landmark;
  SqliteStatement select_image;
  SqliteStatement select_part;
  SqliteStatement insert_landmark;
  SqliteStatement insert_place;
  SqliteStatement insert_image;
  SqliteStatement insert_part;
  SqliteStatement insert_corner;
  SqliteStatement delete_landmark;
  SqliteStatement delete_place;
  SqliteStatement delete_image;
  SqliteStatement update_count;
};

FeatureMapWriter::Database::Database(MapFile&& opened, bool is_new)
    : file(std::move(opened)),
      never_committed(is_new),
      bytes_each(DescriptorBytes(file.map.info.descriptor_kind)),
      lists(&file),
      content_version_row(file.connection.get(), "PRAGMA data_version"),
      select_landmark(file.connection.get(), "SELECT descriptors FROM landmarks WHERE id = ?1"),
      select_image(file.connection.get(), "SELECT id FROM images WHERE id = ?1"),
      select_part(file.connection.get(), "SELECT id FROM building_parts WHERE id = ?1"),
      insert_landmark(file.connection.get(),
                      "INSERT INTO landmarks VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, 0)"),
      insert_place(file.connection.get(),
                   "INSERT INTO landmark_places VALUES (?1, ?2, ?2, ?3, ?3, ?4, ?4)"),
      insert_image(file.connection.get(),
                   "INSERT INTO images VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)"),
      insert_part(file.connection.get(),
                  "INSERT INTO building_parts VALUES (?1, ?2, ?3, ?4, ?5, ?6)"),
      insert_corner(file.connection.get(),
                    "INSERT INTO building_part_corners VALUES (?1, ?2, ?3, ?4)"),
      delete_landmark(file.connection.get(), "DELETE FROM landmarks WHERE id = ?1"),
      delete_place(file.connection.get(), "DELETE FROM landmark_places WHERE id = ?1"),
      delete_image(file.connection.get(), "DELETE FROM images WHERE id = ?1"),
      update_count(file.connection.get(),
                   "UPDATE landmarks SET descriptors = max(0, descriptors + ?2) WHERE id = ?1") {
  if (content_version_row.Step()) content_version = content_version_row.Integer(0).value_or(0);
  content_version_row.Reset();
}

FeatureMapWriter::Database::~Database() {
  // The lock is held still, so that nobody else can have begun to use the file.
  if (never_committed) std::remove(file.connection->name().c_str());
}

Status FeatureMapWriter::Database::Ready() {
  if (broken) return *broken;
  if (file.connection->InTransaction()) return {};
  if (Status status = Begin(*file.connection, MapAccess::kWrite); !status) return status;
  const bool same =
      content_version_row.Step() && content_version_row.Integer(0).value_or(-1) == content_version;
  const Status status = content_version_row.status();
  content_version_row.Reset();
  if (!status) return Keep(status);
  if (same) return {};
  return Keep(file.connection->MakeError(
      ErrorCode::kIo, "was changed by another since it was opened; open it again"));
}

Status FeatureMapWriter::Database::Keep(Status status) {
  if (!status && !broken) broken = status.error();
  return status;
}

Result<bool> FeatureMapWriter::Database::Has(SqliteStatement& select, std::int64_t id) {
  select.Bind(1, id);
  const bool found = select.Step();
  Status status = select.status();
  select.Reset();
  if (!status) return Keep(status).error();
  return found;
}

Result<std::unique_ptr<FeatureMapWriter>> FeatureMapWriter::Create(const std::string& path,
                                                                   const MapInfo& info) {
  if (auto wrong = WrongWith(info)) {
    return Error{ErrorCode::kInvalidArgument, path + ": map: " + *wrong};
  }
  if (path.empty() || path.find('\0') != std::string::npos) {
    return Error{ErrorCode::kInvalidArgument, "the map's path is no name for a file"};
  }
  // Makes the file only where there is none, in one step.
  std::FILE* made = std::fopen(path.c_str(), "wbx");
  if (made == nullptr) {
    return Error{ErrorCode::kIo,
                 errno == EEXIST
                     ? path + ": exists already; choose another name"
                     : path + ": cannot be made: " + std::generic_category().message(errno)};
  }
  std::fclose(made);

  const auto prepare = [&]() -> Result<MapFile> {
    MapFile file;
    auto connection = SqliteConnection::Open(path, SqliteConnection::Mode::kWrite);
    if (!connection) return connection.error();
    file.connection = *std::move(connection);
    if (Status status = CreateMapTables(*file.connection); !status) return status.error();
    SqliteStatement id(file.connection.get(), "SELECT lower(hex(randomblob(16)))");
    file.map.info = info;
    file.map.info.id = id.Step() ? id.Text(0).value_or("") : "";
    if (Status status = id.status(); !status) return status.error();
    file.map.info.landmarks = 0;
    file.map.info.descriptors = 0;
    file.map.info.images = 0;
    file.map.info.building_parts = 0;
    return file;
  };
  Result<MapFile> file = prepare();
  if (!file) {
    std::remove(path.c_str());
    return file.error();
  }
  return std::unique_ptr<FeatureMapWriter>(
      new FeatureMapWriter(std::make_unique<Database>(*std::move(file), true)));
}

Result<std::unique_ptr<FeatureMapWriter>> FeatureMapWriter::Open(const std::string& path) {
  auto connection = SqliteConnection::Open(path, SqliteConnection::Mode::kWrite);
  if (!connection) return connection.error();
  Result<MapFile> file = LoadMapFile(*std::move(connection), MapAccess::kWrite);
  if (!file) return file.error();
  return std::unique_ptr<FeatureMapWriter>(
      new FeatureMapWriter(std::make_unique<Database>(*std::move(file), false)));
}

FeatureMapWriter::FeatureMapWriter(std::unique_ptr<Database> database)
    : database_(std::move(database)) {}

FeatureMapWriter::~FeatureMapWriter() = default;

Status FeatureMapWriter::AddLandmark(const Landmark& landmark) {
  Database& database = *database_;
  if (Status status = database.Ready(); !status) return status;
  const std::int64_t id = landmark.id;
  if (auto wrong = WrongWith(landmark)) return database.Wrong("landmarks", id, *wrong);
  const Result<bool> there = database.Has(database.select_landmark, id);
  if (!there) return there.error();
  if (*there) return database.Wrong("landmarks", id, "is there already");

  const Eigen::Matrix3d& covariance_m2 = landmark.covariance_m2;
  const std::array<double, 9> values = {landmark.position_in_enu_m.x(),
                                        landmark.position_in_enu_m.y(),
                                        landmark.position_in_enu_m.z(),
                                        covariance_m2(0, 0),
                                        covariance_m2(0, 1),
                                        covariance_m2(1, 1),
                                        covariance_m2(0, 2),
                                        covariance_m2(1, 2),
                                        covariance_m2(2, 2)};
  database.insert_landmark.Bind(1, id);
  for (std::size_t i = 0; i < values.size(); ++i) {
    database.insert_landmark.Bind(static_cast<int>(i) + 2, values[i]);
  }
  if (Status status = database.Keep(database.insert_landmark.Run()); !status) return status;
  database.insert_place.Bind(1, id);
  for (int axis = 0; axis < 3; ++axis) {
    database.insert_place.Bind(axis + 2, landmark.position_in_enu_m[axis]);
  }
  ++database.file.map.info.landmarks;
  return database.Keep(database.insert_place.Run());
}

Status FeatureMapWriter::AddImage(const DatabaseImage& image) {
  Database& database = *database_;
  if (Status status = database.Ready(); !status) return status;
  const std::int64_t id = image.id;
  if (auto wrong = WrongWith(image)) return database.Wrong("images", id, *wrong);
  const Result<bool> there = database.Has(database.select_image, id);
  if (!there) return there.error();
  if (*there) return database.Wrong("images", id, "is there already");

  const Eigen::Quaterniond& attitude = image.camera_from_enu;
  const std::array<double, 7> values = {image.position_in_enu_m.x(),
                                        image.position_in_enu_m.y(),
                                        image.position_in_enu_m.z(),
                                        attitude.w(),
                                        attitude.x(),
                                        attitude.y(),
                                        attitude.z()};
  database.insert_image.Bind(1, id);
  database.insert_image.Bind(2, std::string_view(image.name));
  database.insert_image.Bind(3, std::int64_t{image.pose_known ? 1 : 0});
  for (std::size_t i = 0; i < values.size(); ++i) {
    database.insert_image.Bind(static_cast<int>(i) + 4, values[i]);
  }
  ++database.file.map.info.images;
  return database.Keep(database.insert_image.Run());
}

Status FeatureMapWriter::AddBuildingPart(const BuildingPart& part) {
  Database& database = *database_;
  if (Status status = database.Ready(); !status) return status;
  if (database.file.version == 1) {
    return database.file.connection->MakeError(
        ErrorCode::kUnsupported,
        "is a feature map of version 1, which takes no buildings; make the map again");
  }
  const std::int64_t id = part.id;
  if (auto wrong = WrongWith(part)) return database.Wrong("building_parts", id, *wrong);
  const Result<bool> there = database.Has(database.select_part, id);
  if (!there) return there.error();
  if (*there) return database.Wrong("building_parts", id, "is there already");

  database.insert_part.Bind(1, id);
  database.insert_part.Bind(2, std::string_view(part.building));
  database.insert_part.Bind(3, part.base_m);
  database.insert_part.Bind(4, part.top_m);
  database.insert_part.Bind(5, part.top_sigma_m);
  database.insert_part.Bind(6, std::int64_t{part.raised ? 1 : 0});
  if (Status status = database.Keep(database.insert_part.Run()); !status) return status;
  for (std::size_t i = 0; i < part.footprint_in_enu_m.size(); ++i) {
    database.insert_corner.Bind(1, id);
    database.insert_corner.Bind(2, static_cast<std::int64_t>(i));
    database.insert_corner.Bind(3, part.footprint_in_enu_m[i].x());
    database.insert_corner.Bind(4, part.footprint_in_enu_m[i].y());
    if (Status status = database.Keep(database.insert_corner.Run()); !status) return status;
  }
  ++database.file.map.info.building_parts;
  return {};
}

Status FeatureMapWriter::AddDescriptors(std::span<const DescriptorOrigin> origins,
                                        std::span<const std::uint8_t> descriptors) {
  Database& database = *database_;
  if (Status status = database.Ready(); !status) return status;
  if (descriptors.size() != origins.size() * database.bytes_each) {
    return database.file.connection->MakeError(
        ErrorCode::kInvalidArgument, std::to_string(origins.size()) + " descriptors are not " +
                                         std::to_string(descriptors.size()) + " bytes");
  }
  for (const DescriptorOrigin& origin : origins) {
    if (auto wrong = WrongWith(origin)) {
      return database.Wrong("descriptor of landmark", origin.landmark_id, *wrong);
    }
  }
  DescriptorBatch& staged = database.staged;
  staged.origins.insert(staged.origins.end(), origins.begin(), origins.end());
  staged.descriptors.insert(staged.descriptors.end(), descriptors.begin(), descriptors.end());
  return {};
}

Status FeatureMapWriter::Database::RemoveLandmark(std::uint32_t id) {
  for (SqliteStatement* remove : {&delete_landmark, &delete_place}) {
    remove->Bind(1, static_cast<std::int64_t>(id));
    if (Status status = remove->Run(); !status) return status;
  }
  --file.map.info.landmarks;
  return {};
}

Status FeatureMapWriter::Database::AddToDescriptorCount(std::uint32_t landmark_id,
                                                        std::int64_t count) {
  update_count.Bind(1, static_cast<std::int64_t>(landmark_id));
  update_count.Bind(2, count);
  file.map.info.descriptors += count;
  return update_count.Run();
}

Status FeatureMapWriter::RemoveImage(std::uint32_t image_id) {
  Database& database = *database_;
  if (Status status = database.Ready(); !status) return status;
  const Result<bool> noted = database.Has(database.select_image, image_id);
  if (!noted) return noted.error();
  return database.RemoveImage(image_id, *noted);
}

Status FeatureMapWriter::Database::RemoveImage(std::uint32_t image_id, bool noted) {
  const auto of_image = [&](const DescriptorOrigin& origin) { return origin.image_id == image_id; };
  const Result<std::vector<std::int64_t>> parts = lists.PartsOfImage(image_id);
  if (!parts) return Keep(parts.error());
  const bool any_staged = std::any_of(staged.origins.begin(), staged.origins.end(), of_image);
  if (!noted && parts->empty() && !any_staged) {
    return Wrong("images", image_id, "there is no such image");
  }
  std::map<std::uint32_t, std::int64_t> gone_of_landmark;
  for (const std::int64_t part : *parts) {
    if (Status status = Keep(lists.Remove(part, of_image, &gone_of_landmark)); !status) {
      return status;
    }
  }
  for (const auto& [landmark, count] : gone_of_landmark) {
    if (Status status = Keep(AddToDescriptorCount(landmark, -count)); !status) return status;
  }
  if (any_staged) {
    for (const DescriptorOrigin& origin : staged.origins) {
      if (of_image(origin)) gone_of_landmark.try_emplace(origin.landmark_id, 0);
    }
    staged.RemoveIf(bytes_each, of_image);
  }
  std::set<std::uint32_t> still_staged;
  for (const DescriptorOrigin& origin : staged.origins) still_staged.insert(origin.landmark_id);
  for (const auto& [landmark, count] : gone_of_landmark) {
    if (still_staged.contains(landmark)) continue;
    select_landmark.Bind(1, static_cast<std::int64_t>(landmark));
    const bool bare = select_landmark.Step() && select_landmark.Integer(0) == 0;
    const Status status = select_landmark.status();
    select_landmark.Reset();
    if (!status) return Keep(status);
    if (!bare) continue;
    if (Status removed = Keep(RemoveLandmark(landmark)); !removed) return removed;
  }
  if (!noted) return {};
  --file.map.info.images;
  delete_image.Bind(1, static_cast<std::int64_t>(image_id));
  return Keep(delete_image.Run());
}

Status FeatureMapWriter::RemoveLandmarks(std::span<const std::uint32_t> ids) {
  Database& database = *database_;
  if (Status status = database.Ready(); !status) return status;
  const std::set<std::uint32_t> going(ids.begin(), ids.end());
  for (const std::uint32_t id : going) {
    const Result<bool> there = database.Has(database.select_landmark, id);
    if (!there) return there.error();
    if (!*there) return database.Wrong("landmarks", id, "there is no such landmark");
  }
  const auto of_landmarks = [&](const DescriptorOrigin& origin) {
    return going.contains(origin.landmark_id);
  };
  const Result<std::vector<std::int64_t>> parts = database.lists.AllParts();
  if (!parts) return database.Keep(parts.error());
  std::map<std::uint32_t, std::int64_t> gone_of_landmark;
  for (const std::int64_t part : *parts) {
    const Status status =
        database.Keep(database.lists.Remove(part, of_landmarks, &gone_of_landmark));
    if (!status) return status;
  }
  for (const auto& [landmark, count] : gone_of_landmark) {
    database.file.map.info.descriptors -= count;
  }
  database.staged.RemoveIf(database.bytes_each, of_landmarks);
  for (const std::uint32_t id : going) {
    if (Status status = database.Keep(database.RemoveLandmark(id)); !status) return status;
  }
  return {};
}

Status FeatureMapWriter::Reindex(std::uint64_t seed) {
  if (Status status = database_->Ready(); !status) return status;
  database_->reindex_seed = seed;
  return {};
}

Status FeatureMapWriter::Database::Learn(std::uint64_t seed) {
  DescriptorBatch all;
  if (file.quantizer) {
    if (Status status = lists.TakeAll(&all); !status) return status;
  }
  all.origins.insert(all.origins.end(), staged.origins.begin(), staged.origins.end());
  all.descriptors.insert(all.descriptors.end(), staged.descriptors.begin(),
                         staged.descriptors.end());
  DescriptorQuantizer::Options options;
  options.seed = seed;
  file.quantizer.emplace(
      DescriptorQuantizer::Train(file.map.info.descriptor_kind, all.descriptors, options));
  const std::vector<std::uint8_t> bytes = file.quantizer->Serialize();
  file.map.index_id = IndexId(file.map.info.id, bytes);
  file.map.indexed_descriptors = static_cast<std::int64_t>(all.origins.size());
  SqliteStatement put(file.connection.get(),
                      "INSERT OR REPLACE INTO descriptor_quantizer VALUES (1, ?1)");
  put.Bind(1, std::span<const std::uint8_t>(bytes));
  if (Status status = put.Run(); !status) return status;
  return lists.Insert(all);
}

// What was staged joins the lists, or an index of its own.
Status FeatureMapWriter::Database::AddStaged() {
  std::map<std::uint32_t, std::int64_t> added_of_landmark;
  for (const DescriptorOrigin& origin : staged.origins) ++added_of_landmark[origin.landmark_id];
  for (const auto& [landmark, count] : added_of_landmark) {
    const Result<bool> there = Has(select_landmark, landmark);
    if (!there) return there.error();
    if (!*there) return Wrong("landmarks", landmark, "has descriptors but was not added");
  }
  for (const auto& [landmark, count] : added_of_landmark) {
    if (Status status = Keep(AddToDescriptorCount(landmark, count)); !status) return status;
  }
  const bool outgrown =
      !staged.origins.empty() &&
      file.map.info.descriptors > kGrowthBeforeReindex * file.map.indexed_descriptors;
  Status status;
  if (!file.quantizer || outgrown || reindex_seed) {
    status = Learn(reindex_seed.value_or(DescriptorQuantizer::Options().seed));
  } else {
    status = lists.Insert(staged);
  }
  if (!status) return Keep(status);
  staged = {};
  reindex_seed.reset();
  return {};
}

Status FeatureMapWriter::Database::PutMapRow() {
  const MapInfo& info = file.map.info;
  SqliteStatement put(file.connection.get(),
                      "INSERT OR REPLACE INTO map VALUES (1, ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, "
                      "?10, ?11, ?12, ?13, ?14)");
  put.Bind(1, std::string_view(info.id));
  put.Bind(2, info.origin.latitude_rad);
  put.Bind(3, info.origin.longitude_rad);
  put.Bind(4, info.origin.height_m);
  put.Bind(5, std::string_view(info.datum));
  put.Bind(6, info.epoch_year);
  put.Bind(7, static_cast<std::int64_t>(info.descriptor_kind));
  put.Bind(8, std::string_view(info.provenance));
  put.Bind(9, info.landmarks);
  put.Bind(10, info.descriptors);
  put.Bind(11, info.images);
  put.Bind(12, info.building_parts);
  put.Bind(13, file.map.index_id);
  put.Bind(14, file.map.indexed_descriptors);
  return Keep(put.Run());
}

Status FeatureMapWriter::Commit() {
  Database& database = *database_;
  if (Status status = database.Ready(); !status) return status;
  if (Status status = database.AddStaged(); !status) return status;
  if (Status status = database.PutMapRow(); !status) return status;
  const Status status = database.file.connection->Execute("COMMIT");
  if (!status) {
    // As long as the transaction stands, it can be tried again: a reader was at work.
    return database.file.connection->InTransaction() ? status : database.Keep(status);
  }
  database.never_committed = false;
  return {};
}

}  // namespace lodemark
