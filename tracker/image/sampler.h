// Warps crops of the caller's image directly into the inputs of networks.
#pragma once

#include <cstdint>
#include <span>

#include "engine/arena.h"
#include "kernels/image/warp.h"
#include "kernels/registry.h"
#include "tracker/geometry/crop.h"
#include "tracker/image/image_view.h"

namespace mien::tracker {

// The sampling of a crop: rows x columns square samples around its centre. `extent` is the height
// of all rows, relative to the crop's side.
struct Raster {
  std::int32_t rows;
  std::int32_t columns;
  float extent;
};

class Sampler {
 public:
  // False if no tier of the mask has the kernel.
  [[nodiscard]] bool init(std::uint32_t cpu_mask, engine::Arena& arena) {
    warp_ = kernels::find<kernels::WarpArgs>(cpu_mask);
    const std::span<std::byte> shared =
        arena.share(kernels::kWarpSampleElems * sizeof(std::uint16_t));
    samples_ = reinterpret_cast<std::uint16_t*>(shared.data());
    return warp_ != nullptr;
  }

  // Writes the crop as [rows][columns][3] RGB, -1..1. If samples are more than 1.5 pixels apart, it
  // samples means of boxes of pixels. Outside the image the border repeats.
  void warp(const ImageView& view, const Crop& crop, const Raster& raster,
            std::span<float> out) const;

  // Writes the whole crop as [samples][samples][3]; black outside the image.
  void warp_with_black_border(const ImageView& view, const Crop& crop, std::int32_t samples,
                              std::span<float> out) const;

 private:
  kernels::Kernel<kernels::WarpArgs> warp_ = nullptr;
  std::uint16_t* samples_ = nullptr;  // scratch
};

}  // namespace mien::tracker
