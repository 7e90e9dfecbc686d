// Helpers for the cases of several families.
#include "apps/conformance/families/common.h"

#include <algorithm>

#include "formats/fp16.h"

namespace mien::conformance {

using kernels::Activation;

double widened(std::uint16_t half) { return static_cast<double>(formats::float_from_fp16(half)); }

double panel_weight(const std::vector<std::uint16_t>& panels, int outputs, int reduction, int o,
                    int k) {
  const int first = o / 16 * 16;
  const int width = std::min(16, padded(outputs) - first);
  return widened(panels[as_size(first * reduction + k * width + o - first)]);
}

// Slopes as in trained networks; a slope of 65504 would overflow fp32.
RandomActivation::RandomActivation(RandomValues& random, int channels)
    : kind(static_cast<Activation>(random.between(0, 7))), alpha(0.1f) {
  for (int c = 0; c < padded(channels); ++c) {
    const int thousandths = c < channels ? random.between(-1500, 1500) : 0;
    slopes.push_back(formats::fp16_from_float(static_cast<float>(thousandths) * 1e-3f));
  }
}

kernels::ActivationSpec RandomActivation::spec(const std::uint16_t* at) const {
  return {kind, alpha, at};
}

Approx RandomActivation::operator()(Approx x, int channel) const {
  const bool prelu = kind == Activation::kPrelu;
  return activated(x, {kind, alpha, nullptr},
                   prelu ? widened(slopes[static_cast<std::size_t>(channel)]) : 0.0);
}

const char* RandomActivation::name() const {
  constexpr const char* kNames[] = {"none",  "relu",    "relu6", "leaky_relu",
                                    "prelu", "sigmoid", "tanh",  "clamp01"};
  return kNames[static_cast<int>(kind)];
}

Window Window::random(RandomValues& random, int largest_kernel, int largest_stride) {
  Window window{};
  window.kernel_h = random.between(1, largest_kernel);
  window.kernel_w = random.between(1, largest_kernel);
  window.stride_h = random.between(1, largest_stride);
  window.stride_w = random.between(1, largest_stride);
  window.pad_top = random.between(0, window.kernel_h - 1);
  window.pad_left = random.between(0, window.kernel_w - 1);
  window.out_h = random.between(1, 7);
  window.out_w = random.size(25);
  window.in_h = std::max(1, (window.out_h - 1) * window.stride_h + window.kernel_h -
                                window.pad_top - random.between(0, window.kernel_h - 1));
  window.in_w = std::max(1, (window.out_w - 1) * window.stride_w + window.kernel_w -
                                window.pad_left - random.between(0, window.kernel_w - 1));
  return window;
}

std::string Window::text() const {
  return times(in_h, in_w) + " to " + times(out_h, out_w) + ", kernel " +
         times(kernel_h, kernel_w) + ", stride " + times(stride_h, stride_w) + ", padding " +
         times(pad_top, pad_left);
}

ResidualSlice ResidualSlice::random(RandomValues& random, int slice_h, int slice_w) {
  constexpr int kExtra[] = {0, 0, 1, 2, 3, 5, 7, 11, 13};
  const auto more = [&] {
    return kExtra[random.between(0, static_cast<int>(std::size(kExtra)) - 1)];
  };
  ResidualSlice slice;
  slice.top = more();
  slice.left = more();
  slice.h = slice_h + slice.top + more();
  slice.w = slice_w + slice.left + more();
  return slice;
}

std::string times(int h, int w) { return std::to_string(h) + "x" + std::to_string(w); }

}  // namespace mien::conformance
