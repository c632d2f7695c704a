// Velocities and clocks of runs, and the truth's velocity, as the report page shows them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tools/lodemark/run_folder.h"
#include "tools/lodemark/truth.h"
#include "tools/report/report.h"

namespace lodemark {

// How fast the receiver truly was: as the truth states it, or where it states no velocity by the
// differences of its positions half a second before and after.
class TruthVelocity {
 public:
  explicit TruthVelocity(const Truth& truth);

  // East, north and, where known, up. Empty where the truth does not tell.
  struct Velocity {
    double east_mps = 0.0;
    double north_mps = 0.0;
    std::optional<double> up_mps;
  };
  std::optional<Velocity> At(std::int64_t time_gps_ns) const;

  bool by_differences() const { return by_differences_; }

 private:
  const Truth& truth_;
  bool by_differences_ = false;
};

// Speed, clock and sources of an estimate.
void AddMotion(const TrajectoryPoint& epoch, ReportEpoch* drawn);

// The truth's speed at one of its points.
void AddTruthSpeed(const TruthVelocity& truth, std::int64_t time_gps_ns, ReportTruthPoint* drawn);

// Of all epochs of the run that state a velocity where the truth has one.
ReportVelocityErrors VelocityErrorsOf(const RunFolder& run, const TruthVelocity& truth);

}  // namespace lodemark
