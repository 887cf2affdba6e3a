#include "support/allocation_counter.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>

// Sanitizers replace the allocator themselves; clang and gcc each say in their own way that one is
// on.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SDO_COUNT_ALLOCATIONS 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SDO_COUNT_ALLOCATIONS 0
#endif
#endif
#ifndef SDO_COUNT_ALLOCATIONS
#define SDO_COUNT_ALLOCATIONS 1
#endif

namespace {

std::atomic<std::size_t> count{0};

}  // namespace

#if SDO_COUNT_ALLOCATIONS
// glibc's own allocator under its internal names; Eigen and operator new end up in these.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}

void* calloc(std::size_t items, std::size_t size) {
  ++count;
  return __libc_calloc(items, size);
}

void* realloc(void* memory, std::size_t size) {
  ++count;
  return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++count;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++count;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}
#endif

namespace sampled_data_observers::test {

bool allocations_are_counted() { return SDO_COUNT_ALLOCATIONS != 0; }

std::size_t allocations() { return count; }

}  // namespace sampled_data_observers::test
