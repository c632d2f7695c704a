// The members of a scenario that tell of photographs: scene, camera, days, photos.
#pragma once

#include "tools/simulator/photography.h"
#include "tools/simulator/scenario_fields.h"

namespace lodemark {

// What is wrong or contradictory becomes the failure of the fields.
void ReadPhotoFields(ScenarioFields* fields, Photography* photography);

}  // namespace lodemark
