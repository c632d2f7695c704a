// The photographs a run looked at and the buildings around it, for the report page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "tools/report/report.h"

namespace lodemark {

// Where they are: from the inputs that run.json names.
struct SceneFiles {
  std::string photo_list;  // cam0/data.csv; empty: none
  std::string map;         // empty: none
};

// Those of the first run that has them. A recording that was moved since is looked for in the
// folder named, where one is.
SceneFiles SceneFilesOf(const std::vector<std::string>& runs, const std::string& recording,
                        std::vector<std::string>* remarks);

struct ListedPhoto {
  std::int64_t time_gps_ns = 0;
  std::string name;
  std::string path;
};

// The photographs to draw, in order of time: those within the span, evenly chosen where there are
// too many for a page. None, with a remark, if the list cannot be read.
std::vector<ListedPhoto> PhotosToDraw(const std::string& photo_list, std::int64_t start_ns,
                                      std::int64_t end_ns, std::vector<std::string>* remarks);

// Small grey copies. One that cannot be read stays without a picture, with a remark.
std::vector<ReportPhoto> DrawnPhotos(const std::vector<ListedPhoto>& photos, std::int64_t start_ns,
                                     std::vector<std::string>* remarks);

// Parts of the map's buildings near the runs' estimates, seen from above, in the datum of fixes at
// the time. None, with a remark, if the map cannot be read.
std::vector<ReportBuilding> BuildingsNear(const std::string& map, const EnuFrame& frame,
                                          std::int64_t time_gps_ns,
                                          const std::vector<ReportRun>& runs,
                                          std::vector<std::string>* remarks);

}  // namespace lodemark
