// Guard pages on POSIX, Windows and systems without page protection.
#include "apps/conformance/guard_pages.h"

#include <cstdlib>
#include <new>

#include "apps/conformance/guarded_buffer.h"

#if defined(_WIN32)
#include <windows.h>
#elif !defined(__wasm__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace mien::conformance {
namespace {

[[maybe_unused]] std::size_t rounded_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

}  // namespace

#if defined(_WIN32)

bool have_guard_pages() { return true; }

static std::size_t page_bytes() {
  SYSTEM_INFO info;
  GetSystemInfo(&info);
  return info.dwPageSize;
}

// Reserved pages that are not committed are inaccessible.
std::span<std::byte> make_guarded_memory(std::size_t bytes) {
  const std::size_t page = page_bytes(), bytes_rounded = rounded_up(bytes, page);
  auto* first = static_cast<std::byte*>(
      VirtualAlloc(nullptr, bytes_rounded + 2 * page, MEM_RESERVE, PAGE_NOACCESS));
  if (first == nullptr ||
      VirtualAlloc(first + page, bytes_rounded, MEM_COMMIT, PAGE_READWRITE) == nullptr) {
    throw std::bad_alloc();
  }
  return {first + page, bytes_rounded};
}

void release_guarded_memory(std::span<std::byte> bytes_rounded) {
  VirtualFree(bytes_rounded.data() - page_bytes(), 0, MEM_RELEASE);
}

#elif defined(__wasm__)

bool have_guard_pages() { return false; }

std::span<std::byte> make_guarded_memory(std::size_t bytes) {
  constexpr std::size_t kAlignment = 64;
  const std::size_t bytes_rounded = rounded_up(bytes, kAlignment);
  auto* first = static_cast<std::byte*>(std::aligned_alloc(kAlignment, bytes_rounded));
  if (first == nullptr) {
    throw std::bad_alloc();
  }
  return {first, bytes_rounded};
}

void release_guarded_memory(std::span<std::byte> bytes_rounded) { std::free(bytes_rounded.data()); }

#else

bool have_guard_pages() { return true; }

static std::size_t page_bytes() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

std::span<std::byte> make_guarded_memory(std::size_t bytes) {
  const std::size_t page = page_bytes(), bytes_rounded = rounded_up(bytes, page);
  void* mapping =
      mmap(nullptr, bytes_rounded + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapping == MAP_FAILED) {
    throw std::bad_alloc();
  }
  auto* first = static_cast<std::byte*>(mapping) + page;
  if (mprotect(first, bytes_rounded, PROT_READ | PROT_WRITE) != 0) {
    throw std::bad_alloc();
  }
  return {first, bytes_rounded};
}

void release_guarded_memory(std::span<std::byte> bytes_rounded) {
  const std::size_t page = page_bytes();
  munmap(bytes_rounded.data() - page, bytes_rounded.size() + 2 * page);
}

#endif

}  // namespace mien::conformance
