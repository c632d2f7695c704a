#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/map/feature_map.h"
#include "core/map/feature_map_database.h"

namespace lodemark {
namespace {

// An R*Tree rounds to single precision, whose steps at 100 km are 8 mm.
constexpr double kWidestPoint_m = 0.04;

// Reads a whole map within one Reading and notes what is wrong.
class MapCheck {
 public:
  MapCheck(FeatureMap::Database* database, std::size_t limit)
      : database_(*database), limit_(limit) {}

  std::vector<Error> Run() {
    CheckLandmarks();
    // SQLite from 3.44 walks the R*Tree with the pages, and would not stop in one without end.
    if (CheckTree()) {
      CheckPages();
      CheckPlaces();
    }
    CheckImagesAndBuildings();
    CheckLists();
    CheckImageLists();
    return std::move(errors_);
  }

 private:
  // What a look at every descriptor tells of a landmark.
  struct Known {
    std::uint32_t id = 0;
    Eigen::Vector3d position_in_enu_m = Eigen::Vector3d::Zero();
    std::int64_t descriptors_left = 0;  // that should be in the lists and were not met yet
  };

  bool Full() const { return errors_.size() >= limit_; }
  void Add(Error error) {
    if (!Full()) errors_.push_back(std::move(error));
  }
  void Add(const std::string& sentence) { Add(database_.Bad(sentence)); }
  void Add(const Status& status) {
    if (!status) Add(status.error());
  }

  // Visits every row a statement gives, until there are errors enough.
  template <typename Visit>
  void ForEachRow(const char* sql, Visit&& visit) {
    database_.file.connection->AllowWork(database_.file.size_bytes);
    SqliteStatement rows(database_.file.connection.get(), sql);
    while (!Full() && rows.Step()) visit(rows);
    Add(rows.status());
  }

  Known* Find(std::int64_t id) {
    const auto at =
        std::lower_bound(landmarks_.begin(), landmarks_.end(), id,
                         [](const Known& known, std::int64_t value) { return known.id < value; });
    return at != landmarks_.end() && at->id == id ? &*at : nullptr;
  }

  void CheckCount(const char* what, std::int64_t said, std::size_t found) {
    if (said == static_cast<std::int64_t>(found)) return;
    Add("map: id 1: " + std::string(what) + ": says " + std::to_string(said) + ", there are " +
        std::to_string(found));
  }

  void CheckPages() {
    ForEachRow("PRAGMA integrity_check(20)", [&](const SqliteStatement& row) {
      const std::string_view finding = row.Text(0).value_or("");
      if (finding != "ok") Add("is damaged: " + std::string(finding));
    });
  }

  void CheckLandmarks() {
    SqliteConnection& connection = *database_.file.connection;
    std::size_t count = 0;
    ForEachRow(kSelectAllLandmarks, [&](const SqliteStatement& row) {
      ++count;
      const Result<LandmarkRow> read = ReadLandmark(connection, row);
      if (!read) {
        Add(read.error());
      } else if (!landmarks_.empty() && read->landmark.id <= landmarks_.back().id) {
        Add("landmarks: id " + std::to_string(read->landmark.id) + ": is out of order");
      } else {
        landmarks_.push_back(
            {read->landmark.id, read->landmark.position_in_enu_m, read->descriptors});
      }
    });
    if (!Full()) CheckCount("landmarks", database_.file.map.info.landmarks, count);
  }

  // Whether the R*Tree can be walked to its end.
  bool CheckTree() {
    const Result<std::vector<std::uint32_t>> ids = database_.LandmarkIdsAround(
        {Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()});
    if (!ids) {
      Add(ids.error());
      return false;
    }
    auto id = ids->begin();
    for (const Known& known : landmarks_) {
      while (id != ids->end() && *id < known.id) ++id;
      if (id == ids->end() || *id != known.id) {
        Add("landmark_places: id " + std::to_string(known.id) + ": is missing");
      }
    }
    if (ids->size() > landmarks_.size()) Add("landmark_places: has places of no landmark");
    return true;
  }

  void CheckPlaces() {
    ForEachRow("SELECT rtreecheck('main', 'landmark_places')", [&](const SqliteStatement& row) {
      const std::string_view finding = row.Text(0).value_or("");
      if (finding != "ok") Add("landmark_places: is damaged: " + std::string(finding));
    });
    ForEachRow(
        "SELECT id, least_east_m, greatest_east_m, least_north_m, greatest_north_m, least_up_m, "
        "greatest_up_m FROM landmark_places",
        [&](const SqliteStatement& row) {
          const Known* landmark = Find(row.Integer(0).value_or(-1));
          if (landmark == nullptr) return;
          for (int axis = 0; axis < 3; ++axis) {
            const double least_m =
                row.Real(2 * axis + 1).value_or(std::numeric_limits<double>::infinity());
            const double greatest_m =
                row.Real(2 * axis + 2).value_or(-std::numeric_limits<double>::infinity());
            const double at_m = landmark->position_in_enu_m[axis];
            if (least_m <= at_m && at_m <= greatest_m && greatest_m - least_m <= kWidestPoint_m) {
              continue;
            }
            Add("landmark_places: id " + std::to_string(landmark->id) +
                ": is not where the landmark is");
            return;
          }
        });
  }

  void CheckImagesAndBuildings() {
    if (Full()) return;
    database_.file.connection->AllowWork(database_.file.size_bytes);
    const Result<std::vector<DatabaseImage>> images = database_.Images();
    if (images) {
      CheckCount("images", database_.file.map.info.images, images->size());
    } else {
      Add(images.error());
    }
    const Result<std::vector<BuildingPart>> parts = database_.BuildingParts();
    if (parts) {
      CheckCount("building_parts", database_.file.map.info.building_parts, parts->size());
    } else {
      Add(parts.error());
    }
  }

  void CheckLists() {
    if (Full()) return;
    database_.file.connection->AllowWork(database_.file.size_bytes);
    std::size_t count = 0;
    const Status status =
        database_.list_parts.ForEach(0, std::numeric_limits<std::int64_t>::max(),
                                     [&](std::int64_t key, const DescriptorListView& view) {
                                       count += view.size();
                                       if (!Full()) CheckPart(key, view);
                                     });
    Add(status);
    if (!status || Full()) return;
    CheckCount("descriptors", database_.file.map.info.descriptors, count);
    for (const Known& known : landmarks_) {
      if (known.descriptors_left == 0) continue;
      Add("landmarks: id " + std::to_string(known.id) + ": descriptors: the lists have " +
          (known.descriptors_left > 0 ? "fewer" : "more"));
    }
  }

  void CheckPart(std::int64_t key, const DescriptorListView& view) {
    const auto bad = [&](std::size_t i, const std::string& sentence) {
      Add("descriptor_lists: list " + std::to_string(ListOfKey(key)) + " part " +
          std::to_string(PartOfKey(key)) + ": descriptor " + std::to_string(i) + ": " + sentence);
    };
    if (view.size() == 0) return bad(0, "is missing");
    const DescriptorQuantizer& quantizer = *database_.file.quantizer;
    // Of the others the search would notice as little.
    if (quantizer.ListOf(view.descriptor(0)) != ListOfKey(key)) bad(0, "is in the wrong list");
    std::vector<std::uint32_t> images;
    images.reserve(view.size());
    for (std::size_t i = 0; i < view.size(); ++i) {
      const DescriptorOrigin origin = view.origin(i);
      images.push_back(origin.image_id);
      if (auto wrong = WrongWith(origin)) {
        bad(i, *wrong);
      } else if (Known* landmark = Find(origin.landmark_id)) {
        --landmark->descriptors_left;
      } else {
        bad(i, "is of landmark " + std::to_string(origin.landmark_id) + ", which is not there");
      }
    }
    std::sort(images.begin(), images.end());
    images.erase(std::unique(images.begin(), images.end()), images.end());
    for (const std::uint32_t image : images) image_parts_.emplace_back(image, key);
  }

  void CheckImageLists() {
    if (Full()) return;
    std::sort(image_parts_.begin(), image_parts_.end());
    auto expected = image_parts_.begin();
    ForEachRow("SELECT image_id, list_part FROM image_lists ORDER BY image_id, list_part",
               [&](const SqliteStatement& row) {
                 const std::pair<std::int64_t, std::int64_t> noted = {row.Integer(0).value_or(-1),
                                                                      row.Integer(1).value_or(-1)};
                 if (expected != image_parts_.end() && *expected == noted) {
                   ++expected;
                   return;
                 }
                 Add("image_lists: image_id " + std::to_string(noted.first) +
                     ": is not what the lists hold");
               });
    if (expected != image_parts_.end()) {
      Add("image_lists: image_id " + std::to_string(expected->first) + ": a part is missing");
    }
  }

  FeatureMap::Database& database_;
  std::size_t limit_;
  std::vector<Error> errors_;
  std::vector<Known> landmarks_;                                    // by id
  std::vector<std::pair<std::int64_t, std::int64_t>> image_parts_;  // image and part's key
};

}  // namespace

std::vector<Error> FeatureMap::Check(std::size_t limit) const {
  const Reading reading(database_.get());
  if (!reading.status()) return {reading.status().error()};
  return MapCheck(database_.get(), limit).Run();
}

}  // namespace lodemark
