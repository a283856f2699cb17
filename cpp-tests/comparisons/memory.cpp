#include "memory.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <malloc.h>

// The names under which glibc has its allocator where a program brings a `malloc` of its own.
extern "C" {
void *__libc_malloc(std::size_t);
void *__libc_calloc(std::size_t, std::size_t);
void *__libc_realloc(void *, std::size_t);
void *__libc_memalign(std::size_t, std::size_t);
void __libc_free(void *);
}

namespace {

std::atomic<std::size_t> allocated{0};
std::atomic<std::size_t> peak{0};

void *counted(void *block) {
    // A null pointer's usable size is zero.
    const std::size_t size = malloc_usable_size(block);
    const std::size_t now = allocated.fetch_add(size, std::memory_order_relaxed) + size;
    std::size_t highest = peak.load(std::memory_order_relaxed);
    while (now > highest && !peak.compare_exchange_weak(highest, now, std::memory_order_relaxed)) {
    }
    return block;
}

void forget(std::size_t size) { allocated.fetch_sub(size, std::memory_order_relaxed); }

} // namespace

extern "C" {

void *malloc(std::size_t size) { return counted(__libc_malloc(size)); }

void *calloc(std::size_t count, std::size_t size) { return counted(__libc_calloc(count, size)); }

// A block that moves is two for a while. Large ones, which alone matter here, are remapped by the
// system and are not.
void *realloc(void *block, std::size_t size) {
    const std::size_t before = malloc_usable_size(block);
    void *moved = __libc_realloc(block, size);
    if (moved == nullptr && size != 0)
        return nullptr;
    forget(before);
    return counted(moved);
}

void *memalign(std::size_t alignment, std::size_t size) { return counted(__libc_memalign(alignment, size)); }

void *aligned_alloc(std::size_t alignment, std::size_t size) {
    return counted(__libc_memalign(alignment, size));
}

int posix_memalign(void **block, std::size_t alignment, std::size_t size) {
    void *aligned = counted(__libc_memalign(alignment, size));
    if (aligned == nullptr)
        return ENOMEM;
    *block = aligned;
    return 0;
}

void free(void *block) {
    forget(malloc_usable_size(block));
    __libc_free(block);
}
}

namespace comparison {

std::size_t allocated_bytes() { return allocated.load(std::memory_order_relaxed); }

std::size_t peak_bytes() { return peak.load(std::memory_order_relaxed); }

void reset_peak_bytes() { peak.store(allocated_bytes(), std::memory_order_relaxed); }

} // namespace comparison
