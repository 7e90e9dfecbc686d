// The middle of an inverted residual in training: norm and ReLU6 of the expanded map, a 3x3
// depthwise convolution, its norm and ReLU6. Maps are [images][height][width][channels], fp32 or
// bfloat16. Only the expanded map (`x`) and the output of the convolution (`slid`) are stored; the
// maps between them are computed again when needed.
#include "depthwise.h"

namespace mien::training {
namespace {

// `first` is the norm of x. If its weight is null, the convolution reads x itself.
Line line_before(std::size_t channels, Norm first) {
  return first.weight ? Line(channels, first) : Line(channels);
}
Limits limits_before(Norm first) { return first.weight ? kRelu6 : Limits{-INFINITY, INFINITY}; }

template <typename T>
void forward(DepthwiseShape shape, const T* x, float epsilon, Norm first, const float* weights,
             Norm second, T* slid, T* y) {
  const Geometry g(shape);
  if (first.weight) {
    find_moments(x, g.in(), epsilon, first);
  }
  const Line line = line_before(shape.channels, first);
  const Limits limits = limits_before(first);
  Rows seen(g);
  Totals sums;
  for (std::size_t i = 0; i < shape.images; ++i) {
    prefetch(x + i * g.pixels() * shape.channels, g.pixels() * shape.channels);
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c);
      const T* picture = x + i * g.pixels() * shape.channels + c;
      Lanes values = {}, squares = {};
      slide(g, seen, kernel_of(weights, shape.channels, c, count),
            slid + i * g.out_pixels() * shape.channels + c, count, values, squares,
            [&](std::size_t row) {
              const T* from = picture + row * shape.width * shape.channels;
              for (std::size_t column = 0; column < shape.width; ++column, from += shape.channels) {
                seen.inner(row)[column] = limited(line.at(c, load_some(from, count)), limits);
              }
            });
      sums.add(c, count, values, squares);
    }
  }
  set_moments(sums, g.out().pixels, shape.channels, epsilon, second);
  normalise(slid, g.out(), Line(shape.channels, second), kRelu6, y);
}

struct Gradients {
  float *first_weight, *first_bias, *weights, *second_weight, *second_bias;
};

template <typename T>
void backward(DepthwiseShape shape, const T* dy, const T* x, const T* slid, Norm first,
              const float* weights, Norm second, T* dx, Gradients out) {
  const Geometry g(shape);
  const Line line = line_before(shape.channels, first), line_slid(shape.channels, second);
  const Limits limits = limits_before(first);
  const Descent descent(g.out(), second, line_slid,
                        sum_gradients(dy, slid, g.out(), second, line_slid, kRelu6),
                        out.second_weight, out.second_bias);
  PerChannel<float> mean = {};
  if (first.weight) {
    std::copy_n(first.mean, shape.channels, mean.begin());
  }
  Rows seen(g), gradient(g);
  Totals sums;
  std::vector<double> dweights(kTaps * shape.channels);
  for (std::size_t i = 0; i < shape.images; ++i) {
    prefetch(x + i * g.pixels() * shape.channels, g.pixels() * shape.channels);
    prefetch(slid + i * g.out_pixels() * shape.channels, g.out_pixels() * shape.channels);
    prefetch(dy + i * g.out_pixels() * shape.channels, g.out_pixels() * shape.channels);
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c),
                        picture = i * g.pixels() * shape.channels + c;
      const std::size_t slid_picture = i * g.out_pixels() * shape.channels + c;
      Kernel dkernel = {};
      Lanes gradients = {}, products = {};
      descend(
          g, seen, gradient, kernel_of(weights, shape.channels, c, count), dkernel,
          [&](std::size_t pixel) {
            const std::size_t at = slid_picture + pixel * shape.channels;
            const Lanes v = load_some(slid + at, count);
            return descent.at(line_slid, c,
                              passed(line_slid.at(c, v), kRelu6, load_some(dy + at, count)), v);
          },
          [&](std::size_t row) {
            const T* from = x + picture + row * shape.width * shape.channels;
            for (std::size_t column = 0; column < shape.width; ++column, from += shape.channels) {
              seen.inner(row)[column] = limited(line.at(c, load_some(from, count)), limits);
            }
          },
          [&](std::size_t row) {
            Lanes of_row = {}, products_of_row = {};  // in registers, unlike captured sums
            for (std::size_t column = 0; column < shape.width; ++column) {
              const std::size_t at = picture + (row * shape.width + column) * shape.channels;
              const Lanes v = load_some(x + at, count);
              const Lanes dz = passed(line.at(c, v), limits, gradient.inner(row)[column]);
              of_row += dz;
              products_of_row += dz * (v - load(&mean[c]));
              store_some(dx + at, dz, count);
            }
            gradients += of_row;
            products += products_of_row;
          });
      add_kernel(dweights, dkernel, shape.channels, c, count);
      sums.add(c, count, gradients, products);
    }
  }
  std::copy(dweights.begin(), dweights.end(), out.weights);
  if (!first.weight) {
    return;
  }
  const Descent before(g.in(), first, line, sums, out.first_weight, out.first_bias);
  for (std::size_t p = 0; p < g.in().pixels; ++p, x += shape.channels, dx += shape.channels) {
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c);
      store_some(dx + c, before.at(line, c, load_some(dx + c, count), load_some(x + c, count)),
                 count);
    }
  }
}

}  // namespace

extern "C" {

// x has no norm if first.weight is null.
void depthwise_unit_forward(const DepthwiseShape* shape, int half, const void* x, float epsilon,
                            Norm first, const float* weights, Norm second, void* slid, void* y) {
  if (half != 0) {
    forward(*shape, static_cast<const BFloat16*>(x), epsilon, first, weights, second,
            static_cast<BFloat16*>(slid), static_cast<BFloat16*>(y));
  } else {
    forward(*shape, static_cast<const float*>(x), epsilon, first, weights, second,
            static_cast<float*>(slid), static_cast<float*>(y));
  }
}

void depthwise_unit_backward(const DepthwiseShape* shape, int half, const void* dy, const void* x,
                             const void* slid, Norm first, const float* weights, Norm second,
                             void* dx, Gradients out) {
  if (half != 0) {
    backward(*shape, static_cast<const BFloat16*>(dy), static_cast<const BFloat16*>(x),
             static_cast<const BFloat16*>(slid), first, weights, second, static_cast<BFloat16*>(dx),
             out);
  } else {
    backward(*shape, static_cast<const float*>(dy), static_cast<const float*>(x),
             static_cast<const float*>(slid), first, weights, second, static_cast<float*>(dx), out);
  }
}
}

}  // namespace mien::training
