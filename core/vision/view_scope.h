// Which landmarks a camera can have in view.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "core/map/descriptor_index.h"
#include "core/map/feature_map.h"
#include "core/vision/look_up.h"

namespace lodemark {

// Landmarks admitted to a search, by id.
class ViewScope {
 public:
  // None. Error if the map's ids are so sparse that a table of them would be out of proportion.
  static Result<ViewScope> Empty(const FeatureMap& map);

  // Those the prior lets the lens have in view, and that options do not call hidden. Error if the
  // prior is no prior.
  static Result<ViewScope> Of(const FeatureMap& map, const Lens& lens, const ViewPrior& prior,
                              const LookUpOptions& options);

  void Admit(const Landmark& landmark);
  bool admits(std::uint32_t id) const { return id < allowed_.size() && allowed_[id] != 0; }
  std::size_t size() const { return size_; }

  // Valid as long as this is.
  SearchScope search_scope() const;

 private:
  std::vector<std::uint8_t> allowed_;
  std::vector<Eigen::Vector3f> positions_m_;
  Eigen::Vector3f camera_in_enu_m_ = Eigen::Vector3f::Zero();
  float camera_sigma_m_ = 0.0F;
  std::size_t size_ = 0;
};

// Largest angle between the optical axis and what the image shows, in radians; pi where the lens
// does not tell.
double HalfFieldOfView(const Lens& lens);

}  // namespace lodemark
