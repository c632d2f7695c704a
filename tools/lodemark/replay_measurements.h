// The measurements of a recording, pushed into a session epoch by epoch.
#pragma once

#include <cstdint>
#include <memory>

#include "core/base/result.h"
#include "core/logs/read_report.h"
#include "tools/lodemark/replay_inputs.h"
#include "tools/lodemark/replay_session.h"

namespace lodemark {

struct MeasurementCounts {
  std::int64_t epochs = 0;          // pushed
  std::int64_t epochs_refused = 0;  // that the session would not take
  std::string first_refusal;        // why
  std::int64_t unknown_constellation = 0;
  std::int64_t broadcast_taken = 0;  // messages of Nav rows
  std::int64_t broadcast_refused = 0;
};

class MeasurementSource {
 public:
  virtual ~MeasurementSource() = default;

  // Pushes the next epoch, and what was broadcast before it. False at the end.
  virtual bool PushNext(ReplaySession* session) = 0;

  const MeasurementCounts& counts() const { return counts_; }
  virtual const ReadReport& report() const = 0;
  virtual double progress() const = 0;
  // Time of the epoch pushed last, 0 if it has none.
  virtual std::int64_t time_gps_ns() const = 0;
  // Why the file ended early, or why all of it gave nothing. Ask after the end.
  virtual Status Verdict() const = 0;

 protected:
  // Counts an epoch by what became of it.
  void Count(const Status& pushed);

  MeasurementCounts counts_;
};

Result<std::unique_ptr<MeasurementSource>> OpenMeasurements(const ReplayInputs& inputs);

}  // namespace lodemark
