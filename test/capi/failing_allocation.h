// Replaces operator new of the program it is linked into, and with glibc malloc, too, which Eigen,
// SQLite, zlib and OpenCV ask: counts allocations and fails the n-th. The sanitizers have a malloc
// of their own; under them it is operator new alone.
#pragma once

#include <cstdint>

namespace lodemark::test {

// Allocations since the program began, and those not yet freed.
std::int64_t AllocationsMade();
std::int64_t AllocationsAlive();

// Of those that OpenCV makes itself none fails: where one does, OpenCV 4.6 may end the process (a
// destructor of its BufferArea throws) or keep memory for good. The n-th of the others from now
// throws std::bad_alloc, or gives NULL where malloc was asked, once; 0 is the next. Below 0: none.
// Those of operator new that ask for no exception (std::stable_sort's buffer) know how to do
// without, and do not count.
void FailAllocation(std::int64_t n);
bool AllocationFailed();  // since FailAllocation

}  // namespace lodemark::test
