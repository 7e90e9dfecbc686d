// The bytes choose a valid network. Each tier runs it fused and layer by layer, and both agree with
// plain layers in double precision.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "engine/session.h"
#include "fuzz/bytes.h"
#include "fuzz/target.h"
#include "kernels/tier.h"
#include "tests/engine/owned_session.h"
#include "tests/engine/random_network.h"

namespace {

using namespace mien;

// Relative to the largest output. Values cancel more in fuzzed networks than in those of the tests.
constexpr double kTolerance = 2e-4;
constexpr double kHalfTolerance = 0.2;

void set_input(engine::Session& session, const tests::Map& input) {
  const engine::Shape& shape = session.input_shape();
  const std::size_t pixels = input.h * input.w;
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t c = 0; c < input.c; ++c) {
      const std::size_t at =
          shape.interleaved() ? p * input.c + c : (c / 8 * pixels + p) * 8 + c % 8;
      session.input()[at] = static_cast<float>(input.values[p * input.c + c]);
    }
  }
}

void compare(const engine::Session& session, std::uint32_t output, const tests::Map& want,
             double tolerance) {
  double largest = 1e-3;
  for (const double value : want.values) {
    largest = std::max(largest, std::abs(value));
  }
  const std::span<const float> got = session.output(output);
  const std::size_t pixels = want.h * want.w;
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t c = 0; c < want.c; ++c) {
      const auto value = static_cast<double>(got[(c / 8 * pixels + p) * 8 + c % 8]);
      if (!(std::abs(value - want.values[p * want.c + c]) <= tolerance * largest)) {
        std::fprintf(stderr, "output %u, pixel %zu, channel %zu: %g instead of %g\n", output, p, c,
                     value, want.values[p * want.c + c]);
        fuzz::require(false);
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes choices(data, size);
  const formats::InputShape input = {static_cast<std::uint32_t>(choices.between(3, 15)),
                                     static_cast<std::uint32_t>(choices.between(3, 15)),
                                     static_cast<std::uint32_t>(choices.between(1, 9))};
  const auto seed = choices.take<std::uint16_t>();
  formats::MienWriter writer;
  tests::RandomNetwork network(writer.network("net", input), input, seed, [&](std::size_t count) {
    return static_cast<std::size_t>(choices.between(0, static_cast<std::int32_t>(count) - 1));
  });
  std::vector<std::byte> file;
  fuzz::require(writer.finish(&file).status == MIEN_OK);
  const tests::Map image = network.twin.random_input();
  network.twin.reset();
  const std::vector<tests::Map> want = network.twin.run(image);
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    if ((kernels::detect_cpu() & 1u << tier) == 0) {
      continue;
    }
    for (const std::uint32_t fused : {0u, kernels::kFusedBlocks}) {
      const std::uint32_t mask = kernels::up_to(static_cast<kernels::Tier>(tier)) | fused;
      tests::OwnedSession owned(tests::AlignedBuffer(std::span<const std::byte>(file)), "net", {},
                                mask);
      fuzz::require(owned.status == MIEN_OK);
      set_input(*owned.session, image);
      owned.fill_arena_with_nan();
      owned.session->run();
      for (std::uint32_t i = 0; i < network.twin.outputs().size(); ++i) {
        compare(*owned.session, i, want[network.twin.outputs()[i]],
                kernels::is_half(static_cast<kernels::Tier>(tier)) ? kHalfTolerance : kTolerance);
      }
    }
  }
  return 0;
}
