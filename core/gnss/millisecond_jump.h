// Whole-millisecond jumps of a receiver's clock: found, repaired and reported.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/gnss/observation.h"

namespace lodemark {

struct MillisecondJump {
  // What moved together. The time of transmission that a pseudorange stands for, tag minus range,
  // is right before and after in each case: a receiver that resets its clock by k ms either shows
  // it in the tag, or keeps tags on whole seconds and measures k ms away from where it did.
  enum class Kind : std::uint8_t {
    kTagCodeAndPhase,
    kTagAndCode,
    kCodeAndPhase,  // the tag keeps its interval
    kCode,
    kPhase,  // phases alone: all slip by the same whole milliseconds
  };
  std::int64_t time_gps_ns = 0;   // tag, as the receiver gave it, of the first epoch after
  std::int32_t milliseconds = 0;  // by which the clock jumped ahead: ranges grew
  Kind kind = Kind::kCode;
};

// Makes one receiver's tags, codes and phases continuous again. A jump is a step of the codes
// against their Dopplers (against nothing where there are none) of a whole number of milliseconds
// that most signals share. From then on tag, code and, if it stepped too, phase are moved back by
// it.
//
// A receiver whose clock drifts and is reset again and again would so be moved ever further: past
// 10 ms in all the tag and code are given as received again, with clock_discontinuity.
class MillisecondJumpRepair {
 public:
  // Changes *epoch in place; the jump, if one lies between it and the epoch before. No jump is
  // looked for across a clock_discontinuity, time that does not advance, or a gap of a minute.
  // Allocates only while the number of signals grows.
  std::optional<MillisecondJump> Repair(ObservationEpoch* epoch);

  void Reset();

 private:
  // A signal as received.
  struct Last {
    SatelliteId satellite;
    SignalCode signal;
    std::uint32_t present = 0;
    double range_m = 0.0;
    double phase_m = 0.0;
    double rate_mps = 0.0;
  };

  // Whole milliseconds that most of steps_ms_ share; 0 if none.
  std::int32_t SharedStep(double tolerance_ms);
  std::optional<MillisecondJump> Find(const ObservationEpoch& epoch);
  void Keep(const ObservationEpoch& epoch);

  std::vector<Last> last_;
  std::vector<double> steps_ms_;
  std::int64_t last_time_ns_ = 0;
  std::int64_t interval_ns_ = 0;  // between the last two tags, without the jump between them
  bool has_last_ = false;
  std::int64_t moved_ms_ = 0;        // taken from tag and code
  std::int64_t phase_moved_ms_ = 0;  // taken from phase
};

}  // namespace lodemark
