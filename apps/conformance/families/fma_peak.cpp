// Cases of fma_peak, with the expected results.
#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::FmaPeakArgs;

// Every sum approaches 1: y = y * 0.999 + 0.001. Tiers combine their sums differently, so they are
// only required to be finite and positive. The count, a multiple of the rounds, shows that all were
// computed.
Case make(std::int64_t rounds) {
  Case test;
  test.shape = std::to_string(rounds) + " rounds";
  test.buffers = {writes(Element::kFloat, std::vector<Approx>(8, {50.0, 50.0 - 1e-6})),
                  writes(Element::kInt64, {{1e9, 1e9 - static_cast<double>(8 * rounds)}})};
  test.bind = [=](const Addresses& buffers) {
    return arguments(FmaPeakArgs{buffers.floats(0), rounds, buffers.int64s(1)});
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
