// Makes and changes feature maps.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/map/feature_map.h"

namespace lodemark {

// A map opened for writing. Changes become visible together, at Commit; a map that is closed
// without it keeps what it had. Nobody else may write the file meanwhile; readers see the old
// state.
class FeatureMapWriter {
 public:
  // A new map; the counts and the id in info are ignored. Error if the file exists.
  static Result<std::unique_ptr<FeatureMapWriter>> Create(const std::string& path,
                                                          const MapInfo& info);
  static Result<std::unique_ptr<FeatureMapWriter>> Open(const std::string& path);
  ~FeatureMapWriter();
  FeatureMapWriter(const FeatureMapWriter&) = delete;
  FeatureMapWriter& operator=(const FeatureMapWriter&) = delete;

  // Ids are the caller's and unique; of landmarks at most 2^26 - 1, because who looks up landmarks
  // keeps tables by id, of others at most 2^31 - 1. Error if the covariance is not positive
  // semidefinite, a footprint not convex and counterclockwise, or a value absurd: a map holds what
  // lies within 100 km of its origin. A map of version 1 takes no buildings.
  Status AddLandmark(const Landmark& landmark);
  Status AddImage(const DatabaseImage& image);
  Status AddBuildingPart(const BuildingPart& part);

  // Descriptors one after another, one for each origin. Their landmarks must be there by Commit.
  Status AddDescriptors(std::span<const DescriptorOrigin> origins,
                        std::span<const std::uint8_t> descriptors);

  // The image, the descriptors that came from it, and the landmarks that have no other descriptor.
  // Touches only the lists that held such descriptors.
  Status RemoveImage(std::uint32_t image_id);
  Status RemoveLandmarks(std::span<const std::uint32_t> ids);

  // Has Commit learn the look-up index anew from all the map holds then. Commit does this by itself
  // for a new map, and when the map has grown more than fourfold since; otherwise new descriptors
  // join the lists there are.
  Status Reindex(std::uint64_t seed);

  // Error, and nothing lost, if a landmark is missing or a reader is at work just then: mend that
  // and try again. After any other error the map is as it was and this writer is of no more use.
  Status Commit();

 private:
  struct Database;
  explicit FeatureMapWriter(std::unique_ptr<Database> database);
  std::unique_ptr<Database> database_;
};

}  // namespace lodemark
