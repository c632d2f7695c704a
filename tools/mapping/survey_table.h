// What surveyors measured and where photographs show it: tables of points and of image marks.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "tools/mapping/place_columns.h"
#include "tools/mapping/table_rows.h"

namespace lodemark {

struct SurveyedPoint {
  std::string name;
  TablePlace place;
};

// A surveyed point in a photograph. The centre of the upper left pixel is (0, 0).
struct ImageMark {
  std::string image;
  std::string point;
  double x_px = 0.0;
  double y_px = 0.0;
  double sigma_px = 0.0;  // zero: not said
};

// Columns point and a place, with sigmas where known. No point twice with different places: a table
// of marks that repeats each point's place is a table of points too.
Result<std::vector<SurveyedPoint>> ReadSurveyTable(const std::string& path,
                                                   const PlaceOptions& options);

// Columns image, point, x_px, y_px, and sigma_px where known.
Result<std::vector<ImageMark>> ReadImageMarks(const std::string& path);

}  // namespace lodemark
