#include "core/vision/look_up.h"

#include <cmath>
#include <cstddef>
#include <span>

#include "core/vision/unique_matches.h"
#include "core/vision/view_scope.h"

namespace lodemark {

Result<std::vector<LandmarkMatch>> LookUp(const FeatureMap& map, const Features& features,
                                          const Lens& lens, const std::optional<ViewPrior>& prior,
                                          const LookUpOptions& options) {
  if (const Status status = CheckFeatures(map, features); !status) return status.error();
  std::optional<ViewScope> in_view;
  if (prior) {
    Result<ViewScope> scope = ViewScope::Of(map, lens, *prior, options);
    if (!scope) return scope.error();
    if (scope->size() == 0) return std::vector<LandmarkMatch>{};
    in_view = std::move(scope).value();
  }
  if (features.keypoints.empty()) return std::vector<LandmarkMatch>{};

  const SearchScope scope = in_view ? in_view->search_scope() : SearchScope{};
  DescriptorSearch search(map.quantizer(), features.descriptors, options.search);
  const Status visited = map.VisitLists(
      search.lists(),
      [&](int list, const DescriptorListView& view) { search.Visit(list, view, scope); });
  if (!visited) return visited.error();

  std::vector<MatchCandidate> candidates;
  const std::span<const NearestLandmarks> nearest = search.nearest();
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const std::optional<double> ratio =
        AcceptedRatio(features.kind, nearest[i], options.largest_ratio);
    if (!ratio) continue;
    candidates.push_back(
        {static_cast<std::uint32_t>(i), nearest[i].landmark_id, nearest[i].distance, *ratio});
  }
  return UniqueMatches(map, features, std::move(candidates));
}

}  // namespace lodemark
