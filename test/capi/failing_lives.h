// What must hold when any allocation or any read of a series of calls fails.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "lodemark/lodemark.h"

namespace lodemark::test {

// What a series of calls gave, kept without the heap.
class Account {
 public:
  lodemark_status Saw(lodemark_status status) {
    if (calls_ < statuses_.size()) statuses_[calls_++] = status;
    return status;
  }
  void Gave(double number) {
    if (given_ < numbers_.size()) numbers_[given_++] = number;
  }
  // Failures that no status tells, but an event of the session.
  void SawEvents(const lodemark_session* session);

  bool ToldOf(lodemark_status error) const;  // by a status, or of a photograph by an event
  bool operator==(const Account& other) const;
  // The first error that is neither; 0 if there is none.
  lodemark_status OtherErrorThan(lodemark_status error, lodemark_status consequence) const;

 private:
  std::array<lodemark_status, 96> statuses_ = {};
  std::array<double, 512> numbers_ = {};
  std::size_t calls_ = 0;
  std::size_t given_ = 0;
  bool photograph_failed_ = false;
};

// One series of calls from opening to closing. Allocates nothing itself between its calls.
using Life = std::function<void(Account*)>;

// Lives it once for each failure tried, at most about most_lives times: the first ones one by one,
// then ever farther apart. An answer that hides a failure must be that of a life without; nothing
// may stay allocated, but what libraries keep for good.
void ExpectToSurviveFailedAllocations(const Life& life, int most_lives);

// The same where something else fails in the n-th place, of which fail(n) lets one and made()
// counts those made: memory for an image, the read of a file.
void ExpectToSurviveFailedImages(const Life& life, int most_lives,
                                 const std::function<void(std::int64_t)>& fail,
                                 const std::function<std::int64_t()>& made);
void ExpectToSurviveFailedReads(const Life& life, int most_lives,
                                const std::function<void(std::int64_t)>& fail,
                                const std::function<std::int64_t()>& made);

}  // namespace lodemark::test
