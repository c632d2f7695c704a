// The errors of a run against the truth of its recording.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "tools/lodemark/compare_statistics.h"
#include "tools/lodemark/run_folder.h"
#include "tools/lodemark/truth.h"

namespace lodemark {

struct RunErrors {
  std::vector<EpochError> errors;    // of the answered epochs with truth, in the run's order
  std::int64_t expected_epochs = 0;  // epochs of the run at which the truth is known
  std::int64_t epochs_without_truth = 0;
};

// Fails with one sentence if the truth cannot be this run's: no common time, or every estimate
// more than 50 km away from it.
Result<RunErrors> ErrorsAgainst(const RunFolder& run, const Truth& truth);

}  // namespace lodemark
