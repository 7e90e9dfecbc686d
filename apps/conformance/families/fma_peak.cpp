#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::FmaPeakArgs;

// Every sum approaches 1: y = y * 0.999 + 0.001. Which sums a tier adds up at the end is its own
// business, so they are only known to be finite and positive; that all of them were done shows in
// the count, a multiple of the rounds.
Case make(std::int64_t rounds) {
  Case test;
  test.shape = std::to_string(rounds) + " rounds";
  test.buffers = {writes(Element::kFloat, std::vector<Approx>(8, {50.0, 50.0 - 1e-6})),
                  writes(Element::kInt64, {{1e9, 1e9 - static_cast<double>(8 * rounds)}})};
  test.bind = [=](const Places& places) {
    return arguments(FmaPeakArgs{places.floats(0), rounds, places.int64s(1)});
  };
  test.call = call<FmaPeakArgs>;
  return test;
}

}  // namespace

template <>
Case random_case<FmaPeakArgs>(RandomValues& random) {
  return make(random.between(1, 100));
}

template <>
Case typical_case<FmaPeakArgs>(RandomValues&) {
  return make(1000);
}

}  // namespace mien::conformance
