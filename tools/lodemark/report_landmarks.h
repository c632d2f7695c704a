// The landmarks of runs, told by photograph, from the rows of landmarks.csv.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/geo/geodetic.h"
#include "tools/lodemark/run_folder.h"
#include "tools/report/report.h"

namespace lodemark {

// The landmarks of one run. Rows come in any order of time; those of one time belong together.
class RunLandmarks {
 public:
  // The times of the photographs to draw, ascending.
  explicit RunLandmarks(std::vector<std::int64_t> photo_times_gps_ns);

  void Add(const RunLandmark& row);
  // After the last row.
  void Finish();

  bool empty() const { return landmarks_.empty(); }

 private:
  friend class ReportLandmarks;

  struct Seen {
    Geodetic place;
    bool place_known = false;
    std::array<std::int32_t, kReportSignalStates> states{};
  };
  struct Sight {
    std::int64_t landmark_id = 0;
    ReportSight sight;
  };
  // The estimate nearest to a photograph that looked at it.
  struct Photo {
    std::optional<std::int64_t> distance_ns;
    std::vector<Sight> sights;
  };

  void FinishGroup();

  std::vector<std::int64_t> photo_times_gps_ns_;
  std::vector<Photo> photos_;  // one for each time
  std::map<std::int64_t, Seen> landmarks_;
  std::int64_t group_gps_ns_ = -1;
  std::vector<Sight> group_;
};

// Joins the runs' landmarks into the scene's, and gives each run its states and sights.
class ReportLandmarks {
 public:
  void Add(const RunLandmarks& run) { runs_.push_back(&run); }

  // One entry of runs for each run added.
  void Finish(const EnuFrame& frame, ReportScene* scene, std::vector<ReportRun>* runs) const;

 private:
  std::vector<const RunLandmarks*> runs_;
};

}  // namespace lodemark
