// Everything that goes into a feature map, in the map's frame, before it is written.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/map/descriptor.h"
#include "core/map/feature_map.h"
#include "tools/mapping/landmark_table.h"
#include "tools/mapping/reconstruction.h"
#include "tools/mapping/similarity3.h"

namespace lodemark {

struct MapContent {
  std::vector<Landmark> landmarks;    // in ascending order of id
  std::vector<DatabaseImage> images;  // in ascending order of id, from 1; 0 means no image
  std::vector<BuildingPart> building_parts;
  std::vector<DescriptorOrigin> origins;  // one for each descriptor
  std::vector<std::uint8_t> descriptors;  // one after another
  // Where the feature was in its image, 0 .. 1 across and down; one for each descriptor, or none.
  std::vector<Eigen::Vector2f> places_in_image;
};

// Landmarks are numbered in the order of the points, descriptors follow their landmarks.
MapContent ContentFrom(const Reconstruction& reconstruction, const Similarity3& enu_from_world);

// landmarks_in_enu_m[i] and covariances_m2[i] belong to landmarks[i], whose ids stay. No images.
MapContent ContentFrom(const std::vector<TableLandmark>& landmarks,
                       const std::vector<Eigen::Vector3d>& landmarks_in_enu_m,
                       const std::vector<Eigen::Matrix3d>& covariances_m2,
                       LandmarkDescriptors descriptors);

// Notes for each descriptor from where its landmark was seen, as far as the image's pose is known.
void NoteViewingDirections(MapContent* content);

// A new map file. Fails if there is one; leaves none behind when it fails.
Status WriteMap(const std::string& path, const MapInfo& info, const MapContent& content,
                const Progress& progress);

}  // namespace lodemark
