// The middle of an inverted residual in training: norm and ReLU6 of the expanded map, a 3x3
// depthwise convolution, its norm and ReLU6. Maps are [images][height][width][channels], fp32 or
// bfloat16. Only the expanded map (`x`) and the output of the convolution (`convolved`) are stored;
// the maps between them are computed again when needed.
#include "depthwise.h"

namespace mien::training {
namespace {

// `first` is the norm of x. If its weight is null, the convolution reads x itself.
Line line_before(std::size_t channels, Norm first) {
  return first.weight ? Line(channels, first) : Line(channels);
}
Limits limits_before(Norm first) { return first.weight ? kRelu6 : Limits{-INFINITY, INFINITY}; }

// Computes a row of the convolution's input from x, for a vector of channels from c on.
template <typename T>
void read_row(const T* x, DepthwiseShape shape, std::size_t c, std::size_t count, const Line& line,
              Limits limits, Lanes* to) {
  for (std::size_t column = 0; column < shape.width; ++column, x += shape.channels) {
    to[column] = limited(line.at(c, load_some(x, count)), limits);
  }
}

template <typename T>
void forward(DepthwiseShape shape, const T* x, float epsilon, Norm first, const float* weights,
             Norm second, T* convolved, T* y) {
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
      convolve(g, seen, kernel_of(weights, shape.channels, c, count),
               convolved + i * g.out_pixels() * shape.channels + c, count, values, squares,
               [&](std::size_t row) {
                 read_row(picture + row * shape.width * shape.channels, shape, c, count, line,
                          limits, seen.inner(row));
               });
      sums.add(c, count, values, squares);
    }
  }
  set_moments(sums, g.out().pixels, shape.channels, epsilon, second);
  normalise(convolved, g.out(), Line(shape.channels, second), kRelu6, y);
}

struct Gradients {
  float *first_weight, *first_bias, *weights, *second_weight, *second_bias;
};

// Replaces the gradient of the normalized map in dx by that of x.
template <typename T>
void pass_norm(Map map, const Line& line, const NormBackward& norm_backward, const T* x, T* dx) {
  for (std::size_t p = 0; p < map.pixels; ++p, x += map.channels, dx += map.channels) {
    for (std::size_t c = 0; c < map.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, map.channels - c);
      store_some(dx + c,
                 norm_backward.at(line, c, load_some(dx + c, count), load_some(x + c, count)),
                 count);
    }
  }
}

template <typename T>
void backward(DepthwiseShape shape, const T* dy, const T* x, const T* convolved, Norm first,
              const float* weights, Norm second, T* dx, Gradients out) {
  const Geometry g(shape);
  const Line line = line_before(shape.channels, first);
  const Limits limits = limits_before(first);
  const OutputGradient<T> slope(g, dy, convolved, second, out.second_weight, out.second_bias);
  PerChannel<float> mean = {};
  if (first.weight) {
    std::copy_n(first.mean, shape.channels, mean.begin());
  }
  Rows seen(g), gradient(g);
  Totals sums;
  std::vector<double> dweights(kTaps * shape.channels);
  for (std::size_t i = 0; i < shape.images; ++i) {
    prefetch(x + i * g.pixels() * shape.channels, g.pixels() * shape.channels);
    slope.prefetch_maps(i * g.out_pixels() * shape.channels, g.out_pixels() * shape.channels);
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c),
                        picture = i * g.pixels() * shape.channels + c;
      const std::size_t convolved_image = i * g.out_pixels() * shape.channels + c;
      Kernel dkernel = {};
      Lanes gradients = {}, products = {};
      slide_backward(
          g, seen, gradient, kernel_of(weights, shape.channels, c, count), dkernel,
          [&](std::size_t pixel) {
            return slope.at(convolved_image + pixel * shape.channels, c, count);
          },
          [&](std::size_t row) {
            read_row(x + picture + row * shape.width * shape.channels, shape, c, count, line,
                     limits, seen.inner(row));
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
  if (first.weight) {
    const NormBackward before(g.in(), first, line, sums, out.first_weight, out.first_bias);
    pass_norm(g.in(), line, before, x, dx);
  }
}

}  // namespace

extern "C" {

// x has no norm if first.weight is null.
void depthwise_unit_forward(const DepthwiseShape* shape, int half, const void* x, float epsilon,
                            Norm first, const float* weights, Norm second, void* convolved,
                            void* y) {
  if (half != 0) {
    forward(*shape, static_cast<const BFloat16*>(x), epsilon, first, weights, second,
            static_cast<BFloat16*>(convolved), static_cast<BFloat16*>(y));
  } else {
    forward(*shape, static_cast<const float*>(x), epsilon, first, weights, second,
            static_cast<float*>(convolved), static_cast<float*>(y));
  }
}

void depthwise_unit_backward(const DepthwiseShape* shape, int half, const void* dy, const void* x,
                             const void* convolved, Norm first, const float* weights, Norm second,
                             void* dx, Gradients out) {
  if (half != 0) {
    backward(*shape, static_cast<const BFloat16*>(dy), static_cast<const BFloat16*>(x),
             static_cast<const BFloat16*>(convolved), first, weights, second,
             static_cast<BFloat16*>(dx), out);
  } else {
    backward(*shape, static_cast<const float*>(dy), static_cast<const float*>(x),
             static_cast<const float*>(convolved), first, weights, second, static_cast<float*>(dx),
             out);
  }
}
}

}  // namespace mien::training
