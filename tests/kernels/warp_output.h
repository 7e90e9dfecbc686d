// Warps into a small image, on every tier of this machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::kernels {

inline constexpr std::int32_t kHeight = 30, kWidth = 90;

// Of kWidth x kHeight.
struct Output {
  explicit Output(PixelFormat format) {
    args.format = format;
    args.full_range = true;
    args.yuv_matrix = kBt601;
    args.box = args.chroma_box = 1;
    args.y = picture.data();
    args.width = kWidth;
    args.height = kHeight;
    args.scale = 1.0f;
    args.samples = samples.data();
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  WarpArgs args{};
  std::vector<float> picture = std::vector<float>(std::size_t{3} * kHeight * kWidth);
  std::vector<std::uint16_t> samples = std::vector<std::uint16_t>(kWarpSampleElems);
};

template <class Check>
void for_each_tier(Check check) {
  for (const Entry& entry : all_kernels()) {
    if (entry.family == WarpArgs::kFamily && (detect_cpu() & bit(entry.tier)) != 0) {
      check(entry.tier);
    }
  }
}

}  // namespace mien::kernels
