// Gathers from run folders, and the truth where known, what the report page shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "tools/lodemark/truth.h"
#include "tools/report/report.h"

namespace lodemark {

class ProgressBar;

struct ReportContent {
  Report report;
  std::vector<std::string> remarks;  // for stderr: rows skipped and the like
  bool any_estimate = false;
};

// recording: where to look for photographs that no longer lie where the runs found them; may be
// empty.
Result<ReportContent> GatherReport(const std::vector<std::string>& run_paths,
                                   const std::optional<Truth>& truth, const std::string& recording,
                                   ProgressBar* progress);

}  // namespace lodemark
