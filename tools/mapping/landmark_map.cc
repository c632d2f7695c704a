#include "tools/mapping/landmark_map.h"

#include <utility>
#include <vector>

#include "tools/mapping/landmark_table.h"

namespace lodemark {

MapInfo InfoFor(const MapFrame& frame, const MapLabels& labels, DescriptorKind kind) {
  MapInfo info;
  info.origin = frame.origin();
  info.datum = frame.is_local() ? "local" : labels.datum;
  info.epoch_year = labels.epoch_year;
  info.descriptor_kind = kind;
  return info;
}

Result<BuiltMap> BuildLandmarkMap(const LandmarkMapInput& input, const StageProgress& progress) {
  progress("Reading", 0.0);
  PlaceOptions options = input.places;
  options.local = input.frame.local;
  const Result<std::vector<TableLandmark>> landmarks = ReadLandmarkTable(input.landmarks, options);
  if (!landmarks) return landmarks.error();
  progress("Reading", 0.5);
  Result<LandmarkDescriptors> descriptors =
      ReadLandmarkDescriptors(input.descriptors, input.descriptor_ids, input.kind, *landmarks);
  if (!descriptors) return descriptors.error();

  std::vector<TablePlace> places;
  for (const TableLandmark& landmark : *landmarks) places.push_back(landmark.place);
  const Result<MapFrame> frame = MapFrame::Choose(input.frame, places);
  if (!frame) return frame.error();
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Matrix3d> covariances;
  for (const TablePlace& place : places) {
    positions.push_back(frame->InEnu(place));
    covariances.push_back(CovarianceOf(place, input.default_sigma_m));
  }
  BuiltMap built;
  built.info = InfoFor(*frame, input.labels, input.kind);
  built.content = ContentFrom(*landmarks, positions, covariances, std::move(descriptors).value());
  progress("Reading", 1.0);
  return built;
}

}  // namespace lodemark
