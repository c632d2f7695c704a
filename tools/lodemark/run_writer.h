// Writes a run folder while a replay goes on (docs/formats.md): every epoch is on disk soon after
// it was processed.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "core/logs/trajectory.h"
#include "lodemark/lodemark.h"
#include "tools/lodemark/row_writer.h"

namespace lodemark {

// The words of the files for outcomes, verdicts and kinds of events.
const char* OutcomeWord(std::int32_t outcome);
const char* VerdictWord(std::int32_t verdict);
const char* EventWord(std::int32_t kind);

// A folder that is missing, empty, or holds an earlier run may be written to.
Status CheckRunFolder(const std::string& folder);

class RunWriter {
 public:
  // Makes the folder where needed, and takes out what an earlier run left.
  Status Open(const std::string& folder, bool with_landmarks);

  // An estimate with a GPS time, and the signals and landmarks it was made from.
  void WriteEpoch(const lodemark_estimate& estimate, std::span<const lodemark_satellite> signals,
                  std::span<const lodemark_landmark> landmarks);
  void WriteEvents(std::span<const lodemark_event> events);

  // Puts these estimates in place of those that were written, as far as they have a GPS time.
  Status RewriteTrajectory(std::span<const lodemark_estimate> estimates);

  // The first failure to write.
  Status Finish();
  bool ok();

 private:
  using Clock = std::chrono::steady_clock;

  Status OpenTrajectory();
  void WriteTrajectory(const lodemark_estimate& estimate);
  void WritePlace(const lodemark_estimate& estimate);
  void WriteLandmarks(const lodemark_estimate& estimate,
                      std::span<const lodemark_landmark> landmarks);
  void FlushNowAndThen();
  void FlushAll();
  template <typename Visit>
  void ForEachFile(const Visit& visit);

  std::string folder_;
  RowWriter trajectory_;
  RowWriter places_;  // trajectory.tum
  RowWriter satellites_;
  std::optional<RowWriter> landmarks_;
  RowWriter events_;
  TrajectoryPoint point_;
  std::optional<EnuFrame> frame_;  // at the first estimate
  Clock::time_point flushed_;
};

}  // namespace lodemark
