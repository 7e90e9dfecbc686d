// Batch norm in training, followed by the limits of an activation: two forward and two
// backward passes through the map.
#include "norm.h"

namespace mien::training {
namespace {

template <typename T>
void forward(const T* x, Map map, float epsilon, Limits limits, Norm norm, T* y) {
  find_moments(x, map, epsilon, norm);
  normalise(x, map, Line(map.channels, norm), limits, y);
}

template <typename T>
void backward(const T* dy, const T* x, Map map, Limits limits, Norm norm, T* dx, float* dweight,
              float* dbias) {
  const Line line(map.channels, norm);
  const NormBackward norm_backward(map, norm, line, sum_gradients(dy, x, map, norm, line, limits),
                                   dweight, dbias);
  for (std::size_t p = 0; p < map.pixels;
       ++p, dy += map.channels, x += map.channels, dx += map.channels) {
    for (std::size_t c = 0; c < map.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, map.channels - c);
      const Lanes v = load_some(x + c, count);
      const Lanes dz = passed(line.at(c, v), limits, load_some(dy + c, count));
      store_some(dx + c, norm_backward.at(line, c, dz, v), count);
    }
  }
}

}  // namespace

extern "C" {

// Maps are fp32, or bfloat16 if `half`. Also writes mean and inverse.
void norm_activation_forward(const void* x, int half, std::size_t pixels, std::size_t channels,
                             float epsilon, float low, float high, const float* weight,
                             const float* bias, float* mean, float* inverse, void* y) {
  const Norm norm = {weight, bias, mean, inverse};
  if (half != 0) {
    forward(static_cast<const BFloat16*>(x), {pixels, channels}, epsilon, {low, high}, norm,
            static_cast<BFloat16*>(y));
  } else {
    forward(static_cast<const float*>(x), {pixels, channels}, epsilon, {low, high}, norm,
            static_cast<float*>(y));
  }
}

// Computes the gradients of x, weight and bias from that of y.
void norm_activation_backward(const void* dy, const void* x, int half, std::size_t pixels,
                              std::size_t channels, float low, float high, const float* weight,
                              const float* bias, float* mean, float* inverse, void* dx,
                              float* dweight, float* dbias) {
  const Norm norm = {weight, bias, mean, inverse};
  if (half != 0) {
    backward(static_cast<const BFloat16*>(dy), static_cast<const BFloat16*>(x), {pixels, channels},
             {low, high}, norm, static_cast<BFloat16*>(dx), dweight, dbias);
  } else {
    backward(static_cast<const float*>(dy), static_cast<const float*>(x), {pixels, channels},
             {low, high}, norm, static_cast<float*>(dx), dweight, dbias);
  }
}
}

}  // namespace mien::training
