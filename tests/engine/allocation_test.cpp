// Running and resetting a session allocates nothing: every allocation of this program is counted.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/engine/mini_model.h"

namespace {
long allocations = 0;
}

void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* memory = std::malloc(bytes)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace mien::tests {
namespace {

TEST(Session, RunsWithoutAllocating) {
  for (const char* network : {"encoder", "pnet", "temporal"}) {
    MiniSession mini(network);
    ASSERT_EQ(mini.status, engine::Status::kOk);
    const long before = allocations;
    for (int i = 0; i < 10; ++i) {
      mini.session->run();
      mini.session->reset();
    }
    EXPECT_EQ(allocations, before) << network;
  }
}

}  // namespace
}  // namespace mien::tests
