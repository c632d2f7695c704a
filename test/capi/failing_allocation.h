// Replaces operator new of the program it is linked into: counts allocations and fails the n-th.
#pragma once

#include <cstdint>

namespace lodemark::test {

// Allocations since the program began, and those not yet freed.
std::int64_t AllocationsMade();
std::int64_t AllocationsAlive();

// The n-th allocation from now throws std::bad_alloc, once; 0 is the next. Below 0: none. Those
// that ask for no exception (std::stable_sort's buffer) know how to do without, and do not count.
void FailAllocation(std::int64_t n);
bool AllocationFailed();  // since FailAllocation

}  // namespace lodemark::test
