// A camera's pose for the terminal and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "lodemark/lodemark.h"

namespace lodemark {

// "good", "weak", "ambiguous", "too_few", "degenerate", "not_here".
std::string_view VerdictName(std::int32_t verdict);

// One sentence on why there is no pose and what to do.
std::string WhyNoPose(const lodemark_pose& pose, std::int32_t sights);

// Lines with labels; sights is how many there were.
std::string PoseText(const lodemark_pose& pose, std::int32_t sights);

nlohmann::ordered_json PoseJson(const lodemark_pose& pose, std::int32_t sights);

// "1.3 mm", "2.4 cm", "12.5 m".
std::string LengthText(double length_m);

}  // namespace lodemark
