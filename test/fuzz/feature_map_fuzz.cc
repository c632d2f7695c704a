// Any bytes as a feature map, opened in memory, read to its end, checked and searched.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/map/feature_map.h"

namespace {

void Require(bool law) {
  if (!law) std::abort();
}

template <typename Value>
bool Explained(const lodemark::Result<Value>& result) {
  return result.ok() || !result.error().message.empty();
}

void RequireSound(const std::vector<lodemark::Landmark>& landmarks, std::uint32_t id_limit) {
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const lodemark::Landmark& landmark = landmarks[i];
    Require(landmark.id < id_limit);
    Require(i == 0 || landmarks[i - 1].id < landmark.id);
    Require(landmark.position_in_enu_m.norm() <= 100'000.0);
    Require(landmark.covariance_m2.allFinite());
    Require(landmark.covariance_m2.diagonal().minCoeff() >= 0.0);
    Require(landmark.covariance_m2.diagonal().maxCoeff() <= 1e6);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto opened =
      lodemark::FeatureMap::OpenBytes("input", std::vector<std::uint8_t>(data, data + size));
  if (!opened) {
    Require(!opened.error().message.empty());
    return 0;
  }
  const lodemark::FeatureMap& map = **opened;
  const auto landmarks = map.Landmarks();
  Require(Explained(landmarks));
  if (landmarks) RequireSound(*landmarks, map.landmark_id_limit());
  const auto around = map.LandmarksWithin({0.0, 0.0, 0.0}, 300.0);
  Require(Explained(around));
  if (around) RequireSound(*around, map.landmark_id_limit());
  Require(Explained(map.Images()) && Explained(map.BuildingParts()));

  const std::vector<std::uint8_t> queries(3 * lodemark::DescriptorBytes(map.info().descriptor_kind),
                                          77);
  lodemark::DescriptorSearch search(map.quantizer(), queries, {});
  std::size_t visited = 0;
  const lodemark::Status status =
      map.VisitLists(search.lists(), [&](int list, const lodemark::DescriptorListView& view) {
        search.Visit(list, view, lodemark::SearchScope());
        visited += view.size();
      });
  Require(Explained(status));
  for (const lodemark::NearestLandmarks& nearest : search.nearest()) {
    Require(visited > 0 || nearest.landmark_id == lodemark::NearestLandmarks::kNone);
  }
  for (const lodemark::Error& error : map.Check(4)) Require(!error.message.empty());
  return 0;
}
