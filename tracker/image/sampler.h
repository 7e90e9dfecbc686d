// Cuts squares out of the caller's image, straight into the pictures that networks read.
#pragma once

#include <cstdint>
#include <span>

#include "engine/arena.h"
#include "kernels/image/warp.h"
#include "kernels/registry.h"
#include "tracker/geometry/crop.h"
#include "tracker/image/image_view.h"

namespace mien::tracker {

// What a network sees of a crop: rows x columns samples, square ones, around its middle; `extent`
// is their height in sides of the crop.
struct Raster {
  std::int32_t rows;
  std::int32_t columns;
  float extent;
};

class Sampler {
 public:
  // False when no tier of the mask has the kernel.
  [[nodiscard]] bool init(std::uint32_t cpu_mask, engine::Arena& arena) {
    warp_ = kernels::find<kernels::WarpArgs>(cpu_mask);
    const std::span<std::byte> shared =
        arena.share(kernels::kWarpSampleElems * sizeof(std::uint16_t));
    samples_ = reinterpret_cast<std::uint16_t*>(shared.data());
    return warp_ != nullptr;
  }

  // The crop as [rows][columns][3] RGB, -1..1. Where samples lie more than 1.5 pixels apart the
  // image is made smaller before. Outside the image its border repeats.
  void cut(const ImageView& view, const Crop& crop, const Raster& raster,
           std::span<float> picture) const;

  // An upright square, black outside the image.
  void cut_black(const ImageView& view, const Square& square, std::int32_t samples,
                 std::span<float> picture) const;

 private:
  kernels::Kernel<kernels::WarpArgs> warp_ = nullptr;
  std::uint16_t* samples_ = nullptr;  // what only a cut in progress needs
};

}  // namespace mien::tracker
