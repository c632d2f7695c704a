// Sights in a csv: what 'lodemark resect' reads and 'lodemark map query --sights' writes.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"
#include "lodemark/lodemark.h"

namespace lodemark {

// How the landmarks of a table are given.
enum class LandmarkFrame { kGeodetic, kEcef, kLocal };

struct SightsFile {
  std::vector<lodemark_sight> sights;
  LandmarkFrame frame = LandmarkFrame::kGeodetic;
  ReadReport report;
};

// Columns by the header line: x_px, y_px and one of latitude_deg,longitude_deg,height_m or
// x_m,y_m,z_m (ECEF) or east_m,north_m,up_m (local: about the origin given); optional sigma_px,
// landmark_sigma_m, quality. Rows that are malformed, or hold what lodemark_pose_resect would
// refuse, are counted and skipped; more than LODEMARK_LARGEST_COUNT rows, or none, are an error.
Result<SightsFile> ReadSights(const std::string& path, const double (&origin_geodetic)[3]);
Result<SightsFile> ReadSights(LineReader lines, const double (&origin_geodetic)[3]);

// The table with a header line; residuals are left out where they are empty.
std::string SightsTable(const std::vector<lodemark_sight>& sights,
                        const std::vector<lodemark_sight_residual>& residuals);

}  // namespace lodemark
