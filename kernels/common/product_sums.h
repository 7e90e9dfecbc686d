// What products of several tiers have in common.
#pragma once

namespace mien::kernels {
namespace {

// Few sums are split into partial ones: eight at least hide the latency of the multiply-adds.
constexpr int partial_sums(int sums) { return sums >= 8 ? 1 : sums >= 4 ? 2 : 4; }

}  // namespace
}  // namespace mien::kernels
