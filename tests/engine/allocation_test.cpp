// Running and resetting a session allocates nothing. Counts every heap call of this program and of
// the libraries linked into it: the linker redirects malloc and related functions here (--wrap),
// and operator new is replaced.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/engine/mini_model.h"

namespace {
// Atomic, because compilers assume that malloc and new change nothing that a program can see.
std::atomic<long> heap_calls = 0;
}  // namespace

extern "C" {
void* __real_malloc(std::size_t bytes);
void* __real_calloc(std::size_t count, std::size_t bytes);
void* __real_realloc(void* memory, std::size_t bytes);
void* __real_aligned_alloc(std::size_t alignment, std::size_t bytes);
void __real_free(void* memory);

void* __wrap_malloc(std::size_t bytes) {
  ++heap_calls;
  return __real_malloc(bytes);
}
void* __wrap_calloc(std::size_t count, std::size_t bytes) {
  ++heap_calls;
  return __real_calloc(count, bytes);
}
void* __wrap_realloc(void* memory, std::size_t bytes) {
  ++heap_calls;
  return __real_realloc(memory, bytes);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t bytes) {
  ++heap_calls;
  return __real_aligned_alloc(alignment, bytes);
}
void __wrap_free(void* memory) {
  ++heap_calls;
  __real_free(memory);
}
}

void* operator new(std::size_t bytes) {
  if (void* memory = std::malloc(bytes)) {
    return memory;
  }
  throw std::bad_alloc();
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (bytes + step - 1) / step * step)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace mien::tests {
namespace {

// Passes the pointer through a volatile one, so that the compiler does not remove the pair of
// calls.
template <class T>
T* opaque(T* pointer) {
  T* volatile result = pointer;
  return result;
}

TEST(Allocation, IsNoticedByThisTest) {
  const long before = heap_calls;
  std::free(opaque(std::malloc(1)));
  std::free(opaque(std::calloc(1, 1)));
  std::free(opaque(std::aligned_alloc(64, 64)));
  delete opaque(new int);
  delete opaque(new CacheLine);
  EXPECT_EQ(heap_calls.load(), before + 10);
}

TEST(Allocation, NeverHappensInRunAndReset) {
  for (const char* network : {"encoder", "pnet", "temporal"}) {
    MiniSession mini(network);
    ASSERT_EQ(mini.status, MIEN_OK);
    const long before = heap_calls;
    for (int i = 0; i < 10; ++i) {
      mini.session->run();
      mini.session->reset();
    }
    EXPECT_EQ(heap_calls.load(), before) << network;
  }
}

TEST(Allocation, NeverHappensWhenASessionIsMadeInTheCallersMemory) {
  AlignedBuffer file = mini_file();
  engine::Model model;
  ASSERT_EQ(model.open(file.span()).status, MIEN_OK);
  const engine::SessionRequest request{&model, "encoder", {}};
  engine::SessionSize size;
  ASSERT_EQ(engine::session_size(request, size), MIEN_OK);
  AlignedBuffer memory(size.session_bytes), arena(size.arena_bytes);
  engine::Session* session = nullptr;
  const long before = heap_calls;
  const std::int32_t opened = model.open(file.span()).status;
  const mien_status made = engine::Session::init(request, memory.span(), arena.span(), session);
  EXPECT_EQ(heap_calls.load(), before);
  EXPECT_EQ(opened, MIEN_OK);
  EXPECT_EQ(made, MIEN_OK);
}

}  // namespace
}  // namespace mien::tests
