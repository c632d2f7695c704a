// The feature map: surveyed landmarks and what they look like, in one SQLite file. docs/formats.md
// has its tables. Maps are downloaded, so nothing in one is believed unchecked.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
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

// A convex part of a building: corners in the map's frame. Only stored, for the sight lines.
struct BuildingPart {
  std::uint32_t id = 0;
  std::vector<Eigen::Vector3d> corners_in_enu_m;
};

// A map opened for reading. One thread at a time.
class FeatureMap {
 public:
  // Reads the header and checks it; no time that grows with the map. Errors name the file and say
  // what it is instead: not a map, of a newer version, cut short, damaged.
  static Result<std::unique_ptr<FeatureMap>> Open(const std::string& path);
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

  // The largest id of a landmark plus one.
  std::uint32_t landmark_id_limit() const;

  // Calls visit(list, view) for each list asked for that exists. The views are valid during the
  // call only. Stops at a damaged list with an error that names it.
  template <typename Visit>
  Status VisitLists(std::span<const int> lists, Visit&& visit) const {
    for (const int list : lists) {
      Result<std::span<const std::uint8_t>> bytes = ListBytes(list);
      if (!bytes) return bytes.error();
      if (bytes->empty()) continue;
      Result<DescriptorListView> view = DescriptorListView::Parse(info().descriptor_kind, *bytes);
      if (!view) return InList(list, view.error());
      visit(list, *view);
    }
    return {};
  }

  // Reads everything there is and checks every value: the first things wrong, at most limit, or
  // none.
  std::vector<Error> Check(std::size_t limit) const;

 private:
  struct Database;
  explicit FeatureMap(std::unique_ptr<Database> database);
  // Where the list lies in the mapped file; empty if there is none. Valid until the next call.
  Result<std::span<const std::uint8_t>> ListBytes(int list) const;
  Error InList(int list, const Error& error) const;

  std::unique_ptr<Database> database_;
};

}  // namespace lodemark
