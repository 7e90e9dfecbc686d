// The combine kernel of all vector tiers: a plain loop over the 8 channels of a block, which
// compilers vectorize.
#include <cstddef>

#include "kernels/common/lanes.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// kStep: 8 if b has a block per pixel, 0 if one block applies to the whole row.
template <Combination kKind>
void combine_row(const float* a, const float* b, float* y, std::int32_t width, std::int32_t b_step,
                 bool one_channel, std::int32_t lanes) {
  for (std::int32_t p = 0; p < width; ++p, a += kBlockLanes, b += b_step, y += kBlockLanes) {
    float other[kBlockLanes], result[kBlockLanes];
    for (int i = 0; i < kBlockLanes; ++i) {
      other[i] = one_channel ? b[0] : b[i];
    }
    for (int i = 0; i < kBlockLanes; ++i) {
      result[i] = kKind == Combination::kProduct    ? a[i] * other[i]
                  : kKind == Combination::kQuotient ? a[i] / other[i]
                                                    : a[i] + other[i];
    }
    store_lanes(result, lanes, y);
  }
}

template <Combination kKind>
void combine_maps(const CombineArgs& args) {
  const std::ptrdiff_t b_w = args.repeats_columns ? 1 : args.w;
  const std::ptrdiff_t b_plane = (args.repeats_rows ? 1 : args.h) * b_w * kBlockLanes;
  const std::ptrdiff_t row_elems = std::ptrdiff_t{args.w} * kBlockLanes;
  const std::int32_t step = args.repeats_columns ? 0 : kBlockLanes;
  std::ptrdiff_t at = 0;
  for (std::int32_t first = 0; first < args.channels; first += kBlockLanes) {
    const float* plane = args.b + (args.repeats_channels ? 0 : first / kBlockLanes * b_plane);
    for (std::int32_t row = 0; row < args.h; ++row, at += row_elems) {
      const float* b = plane + (args.repeats_rows ? 0 : row * b_w * kBlockLanes);
      combine_row<kKind>(args.a + at, b, args.y + at, args.w, step, args.repeats_channels,
                         args.channels - first);
    }
  }
}

}  // namespace

void combine(const CombineArgs& args) {
  switch (args.kind) {
    case Combination::kProduct:
      return combine_maps<Combination::kProduct>(args);
    case Combination::kQuotient:
      return combine_maps<Combination::kQuotient>(args);
    case Combination::kSum:
      return combine_maps<Combination::kSum>(args);
  }
}

}  // namespace mien::kernels::MIEN_TIER
