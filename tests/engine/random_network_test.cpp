// Random networks whose values have long and overlapping lifetimes. If the plan overwrites a value
// that is still needed, outputs differ, because all values are random and the arena starts as NaNs.
#include <random>

#include "tests/engine/random_network.h"
#include "tests/engine/twin_session.h"

namespace mien::tests {
namespace {

using formats::InputShape;

// Values of random networks cancel each other.
constexpr double kSlack = 2;

TEST(RandomNetworks, AgreeWithPlainLayers) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const InputShape input{9 + seed % 7, 9 + seed % 5, 1 + seed % 9};
    for (const std::uint32_t tier : tiers_here()) {
      formats::MienWriter writer;
      std::mt19937 random(seed);
      RandomNetwork network(writer.network("net", input), input, seed, [&](std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
      });
      ASSERT_NO_FATAL_FAILURE(expect_twins_agree(writer, "net", network.twin, tier, 2, kSlack))
          << "seed " << seed << ", tier mask " << tier;
    }
  }
}

}  // namespace
}  // namespace mien::tests
