// What a surveyor would bring home from the scene: points on walls, and where photographs show
// them.
#pragma once

#include <string>
#include <vector>

#include "core/camera/lens.h"
#include "tools/renderer/scene_renderer.h"
#include "tools/simulator/photo_plan.h"
#include "tools/simulator/scenario.h"

namespace lodemark {

struct SurveyTables {
  std::string survey;  // point,latitude_deg,longitude_deg,height_m,sigma_m
  std::string marks;   // image,point,x_px,y_px,sigma_px
};

// The distinct points that at least two of the photographs show, with the errors of a total station
// and of somebody who marks them.
SurveyTables SurveyPhotos(const Scenario& scenario, const std::vector<PlannedPhoto>& photos,
                          const Lens& lens, SceneRenderer* renderer);

}  // namespace lodemark
