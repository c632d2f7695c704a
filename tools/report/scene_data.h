// Photographs, landmarks and buildings as parts of the report's data.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/report/scene.h"

namespace lodemark {

// "scene":{...}
void AppendScene(const ReportScene& scene, std::string* json);

// "landmarks":"...","sights":[...] of a run; one state for each of the scene's landmarks.
void AppendSights(const std::vector<ReportSignalState>& landmarks,
                  const std::vector<ReportSights>& sights, std::string* json);

// Base64 of RFC 4648 section 4.
std::string Base64(std::string_view bytes);

}  // namespace lodemark
