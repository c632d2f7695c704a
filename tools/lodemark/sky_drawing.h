// A sky plot as one SVG file that needs nothing else: the roofs, the satellites coloured by how
// likely they are in plain sight, and how that changed with time.
#pragma once

#include <span>
#include <string>

#include "tools/lodemark/sky_view.h"

namespace lodemark {

// title: the recording's name, in any characters.
std::string DrawSky(const std::string& title, const SkyView& view,
                    std::span<const SkyMoment> moments);

}  // namespace lodemark
