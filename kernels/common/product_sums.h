// Helpers shared by the products of several tiers.
#pragma once

namespace mien::kernels {
namespace {

// Number of partial sums per sum: at least eight sums hide the latency of multiply-adds.
constexpr int partial_sums(int sums) { return sums >= 8 ? 1 : sums >= 4 ? 2 : 4; }

}  // namespace
}  // namespace mien::kernels
