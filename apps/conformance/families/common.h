// Helpers for the cases of several families: packed weights, blocked maps, activations.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/conformance/case.h"

namespace mien::conformance {

[[nodiscard]] inline int padded(int channels) { return (channels + 7) / 8 * 8; }

// Index of a channel of a pixel in a blocked map.
[[nodiscard]] inline std::size_t blocked(int channel, int pixel, int pixels) {
  return as_size((channel / 8 * pixels + pixel) * 8 + channel % 8);
}

[[nodiscard]] double widened(std::uint16_t half);

// The weight of output o and reduction index k in panels [panel][reduction][16 or 8].
[[nodiscard]] double panel_weight(const std::vector<std::uint16_t>& panels, int outputs,
                                  int reduction, int o, int k);

struct RandomActivation {
  RandomActivation() = default;  // none
  RandomActivation(RandomValues& random, int channels);

  // `slopes`: their address during the call.
  [[nodiscard]] kernels::ActivationSpec spec(const std::uint16_t* slopes) const;
  [[nodiscard]] Approx operator()(Approx x, int channel) const;
  [[nodiscard]] const char* name() const;

  kernels::Activation kind = kernels::Activation::kNone;
  float alpha = 0.0f;
  std::vector<std::uint16_t> slopes;
};

// A blocked map: `at(channel, pixel)` for every channel, 0 in unused lanes.
template <class Function>
[[nodiscard]] std::vector<Approx> expected_map(int channels, int pixels, Function at) {
  std::vector<Approx> map(as_size(padded(channels) * pixels));
  for (int c = 0; c < channels; ++c) {
    for (int p = 0; p < pixels; ++p) {
      map[blocked(c, p, pixels)] = at(c, p);
    }
  }
  return map;
}

// The window of convolutions, depthwise layers and pools.
struct Window {
  int in_h, in_w, out_h, out_w, kernel_h, kernel_w, stride_h, stride_w, pad_top, pad_left;

  // The map may end before the last window does: that is padding at the bottom and right.
  static Window random(RandomValues& random, int largest_kernel, int largest_stride);
  [[nodiscard]] int in_pixels() const { return in_h * in_w; }
  [[nodiscard]] int out_pixels() const { return out_h * out_w; }
  // Calls f(index in the kernel, pixel of the map) for the part of a window inside the map.
  template <class Function>
  void for_each(int out_pixel, Function f) const {
    for (int ky = 0; ky < kernel_h; ++ky) {
      for (int kx = 0; kx < kernel_w; ++kx) {
        const int y = out_pixel / out_w * stride_h + ky - pad_top;
        const int x = out_pixel % out_w * stride_w + kx - pad_left;
        if (y >= 0 && y < in_h && x >= 0 && x < in_w) {
          f(ky * kernel_w + kx, y * in_w + x);
        }
      }
    }
  }
  [[nodiscard]] std::string text() const;
};

template <class Args>
void set_window(const Window& window, Args& args) {
  args.in_h = window.in_h;
  args.in_w = window.in_w;
  args.out_h = window.out_h;
  args.out_w = window.out_w;
  args.kernel_h = window.kernel_h;
  args.kernel_w = window.kernel_w;
  args.stride_h = window.stride_h;
  args.stride_w = window.stride_w;
  args.pad_top = window.pad_top;
  args.pad_left = window.pad_left;
}

// A map that is larger than a slice of it, sometimes by a prime.
struct ResidualSlice {
  int h = 0, w = 0, top = 0, left = 0;  // size of the map; start of the slice

  static ResidualSlice random(RandomValues& random, int slice_h, int slice_w);
  [[nodiscard]] int pixels() const { return h * w; }
  [[nodiscard]] int pixel(int slice_pixel, int slice_w) const {
    return (slice_pixel / slice_w + top) * w + slice_pixel % slice_w + left;
  }
};

template <class Args>
void set_residual(const ResidualSlice& slice, const float* residual, Args& args) {
  args.residual = residual;
  args.residual_h = slice.h;
  args.residual_w = slice.w;
  args.residual_top = slice.top;
  args.residual_left = slice.left;
}

[[nodiscard]] std::string times(int h, int w);  // "5x7"

}  // namespace mien::conformance
