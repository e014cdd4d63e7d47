#include "tests/support/allocation_hook.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

namespace nearfit::test {
namespace {

thread_local constinit bool isCounting = false;
constinit std::atomic<std::uint64_t> counted{0};

void count() noexcept {
  if (isCounting) counted.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

void startCountingAllocations() noexcept {
  isCounting = true;
}
void stopCountingAllocations() noexcept {
  isCounting = false;
}
std::uint64_t countedAllocations() noexcept {
  return counted.load(std::memory_order_relaxed);
}
void resetAllocationCount() noexcept {
  counted.store(0, std::memory_order_relaxed);
}

/// For the replacements below.
void countAllocation() noexcept {
  count();
}

}  // namespace nearfit::test

#ifdef NEARFIT_SANITIZED

// The allocator is the sanitizer's own, and tells.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*onMalloc)(const volatile void*, std::size_t),
                                                         void (*onFree)(const volatile void*));

namespace {

[[maybe_unused]] const int kHooks = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { nearfit::test::countAllocation(); },
    [](const volatile void* memory) {
      if (memory != nullptr) nearfit::test::countAllocation();
    });

}  // namespace

#else

// The C library's own names for them, so that the replacements have something to call.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): glibc exports them under these names.
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) noexcept {
  nearfit::test::countAllocation();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  nearfit::test::countAllocation();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  nearfit::test::countAllocation();
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  nearfit::test::countAllocation();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  nearfit::test::countAllocation();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  nearfit::test::countAllocation();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) noexcept {
  if (memory != nullptr) nearfit::test::countAllocation();
  __libc_free(memory);
}
}

#endif
