#include "test/capi/failing_lives.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "test/capi/failing_allocation.h"

namespace lodemark::test {
namespace {

// All of the first thirty failures are tried, then ever fewer: some most_lives in all.
std::int64_t StepAt(std::int64_t n, std::int64_t of, int most_lives) {
  if (of <= most_lives) return 1;
  return n < 30 ? 1 : 1 + n * of / (most_lives * (n + of / 8));
}

struct Failures {
  std::function<void(std::int64_t)> fail;
  std::function<std::int64_t()> made;
  lodemark_status told;
};

void ExpectToSurvive(const Life& life, int most_lives, const Failures& failures) {
  Account first;
  life(&first);  // libraries set up what they keep
  const std::int64_t before = failures.made();
  Account expected;
  life(&expected);
  const std::int64_t possible = failures.made() - before;
  ASSERT_EQ(expected.OtherErrorThan(LODEMARK_OK, LODEMARK_OK), LODEMARK_OK)
      << lodemark_last_error();
  ASSERT_TRUE(first == expected);
  ASSERT_GT(possible, 0);
  int told = 0;
  for (std::int64_t n = 0; n < possible; n += StepAt(n, possible, most_lives)) {
    const auto live = [&](Account* account) {
      const std::int64_t alive = AllocationsAlive();
      failures.fail(n);
      life(account);
      failures.fail(-1);
      return AllocationsAlive() - alive;
    };
    Account account;
    std::int64_t kept = live(&account);
    const lodemark_status other =
        account.OtherErrorThan(failures.told, LODEMARK_ERROR_OUT_OF_ORDER);
    EXPECT_EQ(other, LODEMARK_OK) << "failure " << n << ": " << lodemark_last_error();
    EXPECT_TRUE(account == expected || account.ToldOf(failures.told))
        << "failure " << n << " changed the answer without a word";
    told += account.ToldOf(failures.told) ? 1 : 0;
    // What a library keeps for good, it keeps once.
    for (int again = 0; again < 2 && kept != 0; ++again) {
      Account unread;
      kept = live(&unread);
    }
    EXPECT_EQ(kept, 0) << "leak after failure " << n;
  }
  EXPECT_GT(told, 0);
}

}  // namespace

void Account::SawEvents(const lodemark_session* session) {
  static std::array<lodemark_event, 16> events;
  events[0].struct_size = sizeof(lodemark_event);
  std::int32_t count = 0;
  if (Saw(lodemark_session_events(session, events.data(), 16, &count)) != LODEMARK_OK) return;
  for (std::int32_t i = 0; i < std::min(count, 16); ++i) {
    if (events[static_cast<std::size_t>(i)].kind == LODEMARK_EVENT_PHOTO_FAILED) {
      photograph_failed_ = true;
    }
  }
}

bool Account::ToldOf(lodemark_status error) const {
  const auto end = statuses_.begin() + static_cast<std::ptrdiff_t>(calls_);
  return photograph_failed_ || std::find(statuses_.begin(), end, error) != end;
}

bool Account::operator==(const Account& other) const {
  return calls_ == other.calls_ && given_ == other.given_ && statuses_ == other.statuses_ &&
         numbers_ == other.numbers_ && photograph_failed_ == other.photograph_failed_;
}

lodemark_status Account::OtherErrorThan(lodemark_status error, lodemark_status consequence) const {
  for (std::size_t i = 0; i < calls_; ++i) {
    const lodemark_status status = statuses_[i];
    if (status < 0 && status != error && status != consequence) return status;
  }
  return LODEMARK_OK;
}

void ExpectToSurviveFailedAllocations(const Life& life, int most_lives) {
  ExpectToSurvive(life, most_lives,
                  {FailAllocation, AllocationsMade, LODEMARK_ERROR_OUT_OF_MEMORY});
}

void ExpectToSurviveFailedImages(const Life& life, int most_lives,
                                 const std::function<void(std::int64_t)>& fail,
                                 const std::function<std::int64_t()>& made) {
  ExpectToSurvive(life, most_lives, {fail, made, LODEMARK_ERROR_OUT_OF_MEMORY});
}

void ExpectToSurviveFailedReads(const Life& life, int most_lives,
                                const std::function<void(std::int64_t)>& fail,
                                const std::function<std::int64_t()>& made) {
  ExpectToSurvive(life, most_lives, {fail, made, LODEMARK_ERROR_IO});
}

}  // namespace lodemark::test
