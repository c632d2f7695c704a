#include "test/capi/failing_allocation.h"

#include <link.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

// Compilers tell of sanitizers in two ways.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LODEMARK_SANITIZED
#endif
#endif
#if defined(__GLIBC__) && !defined(LODEMARK_SANITIZED) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define LODEMARK_REPLACES_MALLOC
// What glibc calls its own, for those who replace the others.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* __libc_realloc(void* memory, std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);
extern "C" void __libc_free(void* memory);
#endif

namespace lodemark::test {
namespace {

#if defined(LODEMARK_REPLACES_MALLOC)
void* Take(std::size_t size) { return __libc_malloc(size); }
void* TakeAligned(std::size_t alignment, std::size_t size) {
  return __libc_memalign(alignment, size);
}
void GiveBack(void* memory) { __libc_free(memory); }
#else
void* Take(std::size_t size) { return std::malloc(size); }
void* TakeAligned(std::size_t alignment, std::size_t size) {
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}
void GiveBack(void* memory) { std::free(memory); }
#endif

std::atomic<std::int64_t> made = 0;
std::atomic<std::int64_t> alive = 0;
std::atomic<std::int64_t> until_failure = -1;
std::atomic<bool> failed = false;

// Where the code of OpenCV's libraries lies.
struct Code {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
};
std::array<Code, 32> opencv = {};
std::size_t opencv_parts = 0;

int NoteOpenCv(dl_phdr_info* library, std::size_t, void*) {
  if (std::strstr(library->dlpi_name, "libopencv") == nullptr) return 0;
  for (int i = 0; i < library->dlpi_phnum && opencv_parts < opencv.size(); ++i) {
    const auto& part = library->dlpi_phdr[i];
    if (part.p_type != PT_LOAD) continue;
    const std::uintptr_t begin = library->dlpi_addr + part.p_vaddr;
    opencv[opencv_parts++] = {begin, begin + part.p_memsz};
  }
  return 0;
}

bool IsOpenCv(const void* caller) {
  const auto at = reinterpret_cast<std::uintptr_t>(caller);
  for (std::size_t i = 0; i < opencv_parts; ++i) {
    if (at >= opencv[i].begin && at < opencv[i].end) return true;
  }
  return false;
}

bool IsToFail(const void* caller) {
  if (until_failure < 0 || IsOpenCv(caller) || until_failure-- != 0) return false;
  failed = true;
  return true;
}

void* Allocate(std::size_t size, std::size_t alignment) {
  ++made;
  if (size == 0) size = 1;
  void* const memory = alignment == 0 ? Take(size) : TakeAligned(alignment, size);
  if (memory != nullptr) ++alive;
  return memory;
}

void Free(void* memory) {
  if (memory == nullptr) return;
  --alive;
  GiveBack(memory);
}

void* AllocateOrThrow(std::size_t size, std::size_t alignment, const void* caller) {
  if (IsToFail(caller)) throw std::bad_alloc();
  void* const memory = Allocate(size, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

#if defined(LODEMARK_REPLACES_MALLOC)
void* AllocateOrNull(std::size_t size, std::size_t alignment, const void* caller) {
  if (IsToFail(caller)) {
    errno = ENOMEM;
    return nullptr;
  }
  return Allocate(size, alignment);
}

void* Reallocate(void* memory, std::size_t size, const void* caller) {
  if (memory == nullptr) return AllocateOrNull(size, 0, caller);
  if (IsToFail(caller)) {
    errno = ENOMEM;
    return nullptr;
  }
  ++made;
  void* const moved = __libc_realloc(memory, size);
  if (moved == nullptr && size == 0) --alive;
  return moved;
}
#endif

}  // namespace

std::int64_t AllocationsMade() { return made; }
std::int64_t AllocationsAlive() { return alive; }
void FailAllocation(std::int64_t n) {
  failed = false;
  if (opencv_parts == 0) dl_iterate_phdr(NoteOpenCv, nullptr);
  until_failure = n;
}
bool AllocationFailed() { return failed; }

}  // namespace lodemark::test

#define LODEMARK_CALLER __builtin_return_address(0)

using lodemark::test::Allocate;
using lodemark::test::AllocateOrThrow;
using lodemark::test::Free;

void* operator new(std::size_t size) { return AllocateOrThrow(size, 0, LODEMARK_CALLER); }
void* operator new[](std::size_t size) { return AllocateOrThrow(size, 0, LODEMARK_CALLER); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return AllocateOrThrow(size, static_cast<std::size_t>(alignment), LODEMARK_CALLER);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return AllocateOrThrow(size, static_cast<std::size_t>(alignment), LODEMARK_CALLER);
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

#if defined(LODEMARK_REPLACES_MALLOC)
extern "C" {
void* malloc(std::size_t size) { return lodemark::test::AllocateOrNull(size, 0, LODEMARK_CALLER); }
void* calloc(std::size_t count, std::size_t size) {
  if (lodemark::test::IsToFail(LODEMARK_CALLER)) {
    errno = ENOMEM;
    return nullptr;
  }
  ++lodemark::test::made;
  void* const memory = __libc_calloc(count, size);
  if (memory != nullptr) ++lodemark::test::alive;
  return memory;
}
void* realloc(void* memory, std::size_t size) {
  return lodemark::test::Reallocate(memory, size, LODEMARK_CALLER);
}
void* memalign(std::size_t alignment, std::size_t size) {
  return lodemark::test::AllocateOrNull(size, alignment, LODEMARK_CALLER);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return lodemark::test::AllocateOrNull(size, alignment, LODEMARK_CALLER);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  void* const taken = lodemark::test::AllocateOrNull(size, alignment, LODEMARK_CALLER);
  if (taken == nullptr) return ENOMEM;
  *memory = taken;
  return 0;
}
void free(void* memory) { lodemark::test::Free(memory); }
}
#endif
