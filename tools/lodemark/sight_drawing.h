// A photograph with its sights drawn in: which landmarks were used, and how far off they appear.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "lodemark/lodemark.h"
#include "tools/photos/photo_file.h"

namespace lodemark {

// A PNG or JPEG by the ending of path: sights used in green, the others in red, the residuals of
// those used as lines ten times their length. residuals may be empty: then all are drawn alike.
Status DrawSights(const Photo& photo, const std::vector<lodemark_sight>& sights,
                  const std::vector<lodemark_sight_residual>& residuals, const std::string& path);

}  // namespace lodemark
