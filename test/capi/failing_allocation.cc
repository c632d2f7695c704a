#include "test/capi/failing_allocation.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace lodemark::test {
namespace {

std::atomic<std::int64_t> made = 0;
std::atomic<std::int64_t> alive = 0;
std::atomic<std::int64_t> until_failure = -1;
std::atomic<bool> failed = false;

void* Allocate(std::size_t size, std::size_t alignment) {
  ++made;
  if (size == 0) size = 1;
  void* const memory =
      alignment == 0
          ? std::malloc(size)
          : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory != nullptr) ++alive;
  return memory;
}

void Free(void* memory) {
  if (memory == nullptr) return;
  --alive;
  std::free(memory);
}

void* AllocateOrThrow(std::size_t size, std::size_t alignment) {
  if (until_failure >= 0 && until_failure-- == 0) {
    failed = true;
    throw std::bad_alloc();
  }
  void* const memory = Allocate(size, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

std::int64_t AllocationsMade() { return made; }
std::int64_t AllocationsAlive() { return alive; }
void FailAllocation(std::int64_t n) {
  failed = false;
  until_failure = n;
}
bool AllocationFailed() { return failed; }

}  // namespace lodemark::test

using lodemark::test::Allocate;
using lodemark::test::AllocateOrThrow;
using lodemark::test::Free;

void* operator new(std::size_t size) { return AllocateOrThrow(size, 0); }
void* operator new[](std::size_t size) { return AllocateOrThrow(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return AllocateOrThrow(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return AllocateOrThrow(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return Allocate(size, 0); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return Allocate(size, 0); }
void operator delete(void* memory) noexcept { Free(memory); }
void operator delete[](void* memory) noexcept { Free(memory); }
void operator delete(void* memory, std::size_t) noexcept { Free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { Free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { Free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { Free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { Free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { Free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { Free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { Free(memory); }
