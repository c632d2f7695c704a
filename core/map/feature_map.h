// The feature map: surveyed landmarks and what they look like, in one SQLite file. docs/formats.md
// has its tables. Maps are downloaded, so nothing in one is believed unchecked.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "core/map/descriptor.h"
#include "core/map/descriptor_index.h"

namespace lodemark {

// One per map. Landmarks lie in the east-north-up frame at the origin.
struct MapInfo {
  std::string id;           // 32 hexadecimal digits, different for every map made
  Geodetic origin;          // in the datum
  std::string datum;        // "WGS84 (G2139)", "ITRF2014", "CGCS2000" ...
  double epoch_year = 0.0;  // of the coordinates, as 2024.5; 0 unknown
  DescriptorKind descriptor_kind = DescriptorKind::kRootSift;
  std::string provenance;  // who made it, of what, how
  std::int64_t landmarks = 0;
  std::int64_t descriptors = 0;
  std::int64_t images = 0;
  std::int64_t building_parts = 0;
};

struct Landmark {
  std::uint32_t id = 0;
  Eigen::Vector3d position_in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  // east-north-up
};

// A photograph the map was made from.
struct DatabaseImage {
  std::uint32_t id = 0;
  std::string name;
  Eigen::Vector3d position_in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond camera_from_enu = Eigen::Quaterniond::Identity();
  bool pose_known = false;
};

// A convex part of a building: walls straight up over its footprint, from the base to a flat roof.
struct BuildingPart {
  std::uint32_t id = 0;
  std::string building;  // what it is a part of, by the name in its source; may be empty
  std::vector<Eigen::Vector2d> footprint_in_enu_m;  // convex, counterclockwise
  double base_m = 0.0;                              // up
  double top_m = 0.0;
  double top_sigma_m = 0.0;
  bool raised = false;  // open beneath, as a passage is; else it stands on the ground
};

struct MapFile;

// A map opened for reading. One thread at a time. Every value is checked where it is read: finite,
// within 100 km of the origin, covariances positive semidefinite. The file is mapped into memory,
// so nobody may overwrite it in place; a file put in its stead and FeatureMapWriter do no harm.
// When a writer has committed, all calls fail until the map is opened again.
class FeatureMap {
 public:
  // Reads the header and checks it; no time that grows with the map. Errors name the file and say
  // what it is instead: not a map, of a newer version, cut short, damaged.
  static Result<std::unique_ptr<FeatureMap>> Open(const std::string& path);
  // The same for a file that was read into memory; errors call it by the name.
  static Result<std::unique_ptr<FeatureMap>> OpenBytes(std::string name,
                                                       std::vector<std::uint8_t> bytes);
  ~FeatureMap();
  FeatureMap(const FeatureMap&) = delete;
  FeatureMap& operator=(const FeatureMap&) = delete;

  const MapInfo& info() const;
  const DescriptorQuantizer& quantizer() const;

  // All landmarks, or those with the given ids (ascending; unknown ids are left out), or those
  // within a distance of a place.
  Result<std::vector<Landmark>> Landmarks() const;
  Result<std::vector<Landmark>> LandmarksById(std::span<const std::uint32_t> ids) const;
  Result<std::vector<Landmark>> LandmarksWithin(const Eigen::Vector3d& place_in_enu_m,
                                                double distance_m) const;
  Result<std::vector<DatabaseImage>> Images() const;
  Result<std::vector<BuildingPart>> BuildingParts() const;

  // The largest id of a landmark plus one, at most 2^26.
  std::uint32_t landmark_id_limit() const;

  // Calls visit for each list asked for that exists, once for each of its parts: long lists are
  // stored in several, and a list's parts come one after another. The views are valid during the
  // call only, and the map must not be used in it. Ids in a view may be any number. Stops at a
  // damaged list with an error that names it.
  using ListVisitor = std::function<void(int list, const DescriptorListView& view)>;
  Status VisitLists(std::span<const int> lists, const ListVisitor& visit) const;

  // Reads everything there is and checks every value: the first things wrong, at most limit, or
  // none.
  std::vector<Error> Check(std::size_t limit) const;

  struct Database;

 private:
  explicit FeatureMap(std::unique_ptr<Database> database);
  static Result<std::unique_ptr<FeatureMap>> Finish(Result<MapFile> file);
  std::unique_ptr<Database> database_;
};

}  // namespace lodemark
