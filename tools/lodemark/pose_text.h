// A camera's pose for the terminal and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "core/geo/geodetic.h"
#include "lodemark/lodemark.h"

namespace lodemark {

// "good", "weak", "ambiguous", "too_few", "degenerate", "not_here".
std::string_view VerdictName(std::int32_t verdict);

// One sentence on why there is no pose and what to do.
std::string WhyNoPose(const lodemark_pose& pose, std::int32_t sights);

// Lines with labels; sights is how many there were. frame: of a map that lies nowhere on the earth,
// in which the place is then told; null otherwise.
std::string PoseText(const lodemark_pose& pose, std::int32_t sights, const EnuFrame* frame);

nlohmann::ordered_json PoseJson(const lodemark_pose& pose, std::int32_t sights,
                                const EnuFrame* frame);

// "1.3 mm", "2.4 cm", "12.5 m".
std::string LengthText(double length_m);

}  // namespace lodemark
