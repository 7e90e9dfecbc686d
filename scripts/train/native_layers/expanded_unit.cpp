// An inverted residual in training without its projection: a pointwise convolution that expands few
// channels to many, norm and ReLU6, a 3x3 depthwise convolution, norm and ReLU6. Maps are
// [images][height][width][channels], fp32 or bfloat16; x has `narrow` channels, slid and y have
// shape.channels. The expanded map, the largest of all, is never stored: a vector of channels of
// one picture at a time are made from x, and again on the way back. Its moments follow from those
// of x, since it is linear in x: mean z = W mean x, E[z z'] = W E[x x'] W'. So do the terms by
// which they take part in the gradients.
#include "depthwise.h"

namespace mien::training {
namespace {

constexpr std::size_t kMostNarrow = 48;
constexpr std::size_t kSummed = 8;  // rows of a sum of products that stay in registers

// out[p] = (out[p] +) sum over k < count of x[p][k] weights[k], for so many pixels at a time that
// the sums hide their latency
template <std::size_t kTogether>
std::size_t product_of(const float* x, std::size_t stride, std::size_t count, const Lanes* weights,
                       std::size_t begin, std::size_t pixels, Lanes* out, std::size_t out_stride,
                       bool add) {
  std::size_t p = begin;
  for (; p + kTogether <= pixels; p += kTogether) {
    std::array<Lanes, kTogether> sums = {};
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t j = 0; j < kTogether; ++j) {
        sums[j] += weights[k] * x[(p + j) * stride + k];
      }
    }
    for (std::size_t j = 0; j < kTogether; ++j) {
      Lanes& to = out[(p + j) * out_stride];
      to = add ? to + sums[j] : sums[j];
    }
  }
  return p;
}

void product(const float* x, std::size_t stride, std::size_t count, const Lanes* weights,
             std::size_t pixels, Lanes* out, std::size_t out_stride, bool add) {
  std::size_t p = product_of<8>(x, stride, count, weights, 0, pixels, out, out_stride, add);
  p = product_of<4>(x, stride, count, weights, p, pixels, out, out_stride, add);
  product_of<1>(x, stride, count, weights, p, pixels, out, out_stride, add);
}

// totals[k] += sum over pixels of x[p][k] y[p], for k < count, which is a multiple of kSummed
void outer(const float* x, std::size_t stride, std::size_t count, const Lanes* y,
           std::size_t y_stride, std::size_t pixels, Lanes* totals) {
  for (std::size_t k = 0; k < count; k += kSummed) {
    std::array<Lanes, kSummed> sums;
    std::copy_n(totals + k, kSummed, sums.begin());
    for (std::size_t p = 0; p < pixels; ++p) {
      const Lanes value = y[p * y_stride];
      for (std::size_t j = 0; j < kSummed; ++j) {
        sums[j] += value * x[p * stride + k + j];
      }
    }
    std::copy(sums.begin(), sums.end(), totals + k);
  }
}

// One picture of few channels in fp32, each pixel in whole vectors.
class Picture {
 public:
  Picture(std::size_t pixels, std::size_t channels)
      : pixels_(pixels),
        channels_(channels),
        vectors_((channels + kLanes - 1) / kLanes),
        values_(pixels * vectors_) {}

  template <typename T>
  void read(const T* x) {
    for (std::size_t p = 0; p < pixels_; ++p, x += channels_) {
      for (std::size_t v = 0; v < vectors_; ++v) {
        values_[p * vectors_ + v] =
            load_some(x + v * kLanes, std::min(kLanes, channels_ - v * kLanes));
      }
    }
  }
  template <typename T>
  void write(T* x) const {
    for (std::size_t p = 0; p < pixels_; ++p, x += channels_) {
      for (std::size_t v = 0; v < vectors_; ++v) {
        store_some(x + v * kLanes, values_[p * vectors_ + v],
                   std::min(kLanes, channels_ - v * kLanes));
      }
    }
  }
  const float* floats(std::size_t pixel = 0) const {
    return reinterpret_cast<const float*>(values_.data() + pixel * vectors_);
  }
  std::size_t stride() const { return vectors_ * kLanes; }
  std::size_t vectors() const { return vectors_; }
  Lanes* vector(std::size_t v, std::size_t pixel = 0) {
    return values_.data() + pixel * vectors_ + v;
  }

 private:
  std::size_t pixels_, channels_, vectors_;
  std::vector<Lanes> values_;
};

// Sums over all pixels of x and of x x', in fp64.
struct Gram {
  std::size_t narrow;
  double* values;  // [narrow + 1][narrow]; the last row is of x itself

  double& at(std::size_t j, std::size_t k) const { return values[j * narrow + k]; }
  double& sum(std::size_t k) const { return values[narrow * narrow + k]; }

  void add(Picture& x, std::size_t pixels) const {
    for (std::size_t v = 0; v < x.vectors(); ++v) {
      std::array<Lanes, kMostNarrow> part = {};
      outer(x.floats(), x.stride(), narrow, x.vector(v), x.vectors(), pixels, part.data());
      Lanes sums = {};
      for (std::size_t p = 0; p < pixels; ++p) {
        sums += x.vector(v)[p * x.vectors()];
      }
      for (std::size_t lane = 0; lane < kLanes && v * kLanes + lane < narrow; ++lane) {
        sum(v * kLanes + lane) += sums[lane];
        for (std::size_t j = 0; j < narrow; ++j) {
          at(j, v * kLanes + lane) += part[j][lane];
        }
      }
    }
  }
};

// The expanding weights, [channels][narrow].
struct Expansion {
  std::size_t channels, narrow;
  const float* weights;

  const float* row(std::size_t channel) const { return weights + channel * narrow; }

  // For channels from c on: [narrow] vectors over the channels.
  std::array<Lanes, kMostNarrow> by_input(std::size_t c, std::size_t count) const {
    std::array<Lanes, kMostNarrow> out = {};
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (std::size_t k = 0; k < narrow; ++k) {
        out[k][lane] = row(c + lane)[k];
      }
    }
    return out;
  }

  // Times scale, for 16 inputs from k on: [16] vectors over the inputs.
  std::array<Lanes, kLanes> by_channel(std::size_t c, std::size_t count, std::size_t k,
                                       const float* scale) const {
    std::array<Lanes, kLanes> out = {};
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (std::size_t i = 0; i < kLanes && k + i < narrow; ++i) {
        out[lane][i] = scale[c + lane] * row(c + lane)[k + i];
      }
    }
    return out;
  }

  // Sums of the expanded map and of its squares.
  Totals totals(const Gram& gram) const {
    Totals out;
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t j = 0; j < narrow; ++j) {
        double along = 0;
        for (std::size_t k = 0; k < narrow; ++k) {
          along += row(c)[k] * gram.at(j, k);
        }
        out.first[c] += row(c)[j] * gram.sum(j);
        out.second[c] += row(c)[j] * along;
      }
    }
    return out;
  }
};

template <typename T>
void forward(DepthwiseShape shape, std::size_t narrow, const T* x, float epsilon,
             const float* expansion_weights, Norm first, const float* weights, Norm second,
             double* gram_values, T* slid, T* y) {
  const Geometry g(shape);
  const Expansion expansion = {shape.channels, narrow, expansion_weights};
  const Gram gram = {narrow, gram_values};
  std::fill_n(gram_values, (narrow + 1) * narrow, 0.0);
  Picture picture(g.pixels(), narrow);
  for (std::size_t i = 0; i < shape.images; ++i) {
    picture.read(x + i * g.pixels() * narrow);
    gram.add(picture, g.pixels());
  }
  set_moments(expansion.totals(gram), g.in().pixels, shape.channels, epsilon, first);
  const Line line(shape.channels, first);
  Rows seen(g);
  Totals sums;
  for (std::size_t i = 0; i < shape.images; ++i) {
    picture.read(x + i * g.pixels() * narrow);
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c);
      const auto by_input = expansion.by_input(c, count);
      Lanes values = {}, squares = {};
      slide(g, seen, kernel_of(weights, shape.channels, c, count),
            slid + i * g.out_pixels() * shape.channels + c, count, values, squares,
            [&](std::size_t row) {
              Lanes* to = seen.inner(row);
              product(picture.floats(row * shape.width), picture.stride(), narrow, by_input.data(),
                      shape.width, to, 1, false);
              for (std::size_t column = 0; column < shape.width; ++column) {
                to[column] = limited(line.at(c, to[column]), kRelu6);
              }
            });
      sums.add(c, count, values, squares);
    }
  }
  set_moments(sums, g.out().pixels, shape.channels, epsilon, second);
  normalise(slid, g.out(), Line(shape.channels, second), kRelu6, y);
}

struct Gradients {
  float *expansion, *first_weight, *first_bias, *weights, *second_weight, *second_bias;
};

// What the moments of the expanded map add to the gradient by x: x B + constant, B [narrow] vectors
// of 16 outputs from k on.
void moments_share(const Expansion& e, const Descent& before, std::size_t k, Lanes* b,
                   Lanes& constant) {
  constant = Lanes{};
  std::fill_n(b, e.narrow, Lanes{});
  for (std::size_t i = 0; i < kLanes && k + i < e.narrow; ++i) {
    for (std::size_t c = 0; c < e.channels; ++c) {
      constant[i] += before.constant[c] * e.row(c)[k + i];
      for (std::size_t j = 0; j < e.narrow; ++j) {
        b[j][i] += e.row(c)[j] * before.along[c] * e.row(c)[k + i];
      }
    }
  }
}

void expansion_gradient(const Expansion& e, const Gram& gram, const Line& line,
                        const Descent& before, const std::vector<double>& products, float* out) {
  for (std::size_t c = 0; c < e.channels; ++c) {
    for (std::size_t k = 0; k < e.narrow; ++k) {
      double with_expanded = 0;
      for (std::size_t j = 0; j < e.narrow; ++j) {
        with_expanded += e.row(c)[j] * gram.at(j, k);
      }
      out[c * e.narrow + k] =
          static_cast<float>(line.scale[c] * products[c * e.narrow + k] +
                             before.along[c] * with_expanded + before.constant[c] * gram.sum(k));
    }
  }
}

template <typename T>
void backward(DepthwiseShape shape, std::size_t narrow, const T* dy, const T* x, const T* slid,
              const float* expansion_weights, Norm first, const float* weights, Norm second,
              double* gram_values, T* dx, Gradients out) {
  const Geometry g(shape);
  const Expansion expansion = {shape.channels, narrow, expansion_weights};
  const Gram gram = {narrow, gram_values};
  const Line line(shape.channels, first), line_slid(shape.channels, second);
  const Descent descent(g.out(), second, line_slid,
                        sum_gradients(dy, slid, g.out(), second, line_slid, kRelu6),
                        out.second_weight, out.second_bias);
  PerChannel<float> mean = {};
  std::copy_n(first.mean, shape.channels, mean.begin());
  Rows expanded(g), seen(g), gradient(g);
  Picture picture(g.pixels(), narrow);
  std::vector<Picture> towards_x(shape.images,
                                 picture);  // the gradient by x, but for what the moments add
  Totals sums;
  std::vector<double> dweights(kTaps * shape.channels), products(shape.channels * narrow);
  for (std::size_t i = 0; i < shape.images; ++i) {
    prefetch(slid + i * g.out_pixels() * shape.channels, g.out_pixels() * shape.channels);
    prefetch(dy + i * g.out_pixels() * shape.channels, g.out_pixels() * shape.channels);
    picture.read(x + i * g.pixels() * narrow);
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c),
                        slid_picture = i * g.out_pixels() * shape.channels + c;
      const auto by_input = expansion.by_input(c, count);
      std::array<std::array<Lanes, kLanes>, kMostNarrow / kLanes> by_channel;
      for (std::size_t v = 0; v < picture.vectors(); ++v) {
        by_channel[v] = expansion.by_channel(c, count, v * kLanes, line.scale.data());
      }
      Kernel dkernel = {};
      Lanes gradients = {}, along = {};
      std::array<Lanes, kMostNarrow> part = {};
      descend(
          g, seen, gradient, kernel_of(weights, shape.channels, c, count), dkernel,
          [&](std::size_t pixel) {
            const std::size_t at = slid_picture + pixel * shape.channels;
            const Lanes v = load_some(slid + at, count);
            return descent.at(line_slid, c,
                              passed(line_slid.at(c, v), kRelu6, load_some(dy + at, count)), v);
          },
          [&](std::size_t row) {
            Lanes *z = expanded.inner(row), *to = seen.inner(row);
            product(picture.floats(row * shape.width), picture.stride(), narrow, by_input.data(),
                    shape.width, z, 1, false);
            for (std::size_t column = 0; column < shape.width; ++column) {
              to[column] = limited(line.at(c, z[column]), kRelu6);
            }
          },
          [&](std::size_t row) {
            const Lanes *z = expanded.inner(row), *value = seen.inner(row);
            Lanes* dz = gradient.inner(row);
            Lanes of_row = {}, along_row = {};  // in registers, as sums captured are not
            for (std::size_t column = 0; column < shape.width; ++column) {
              dz[column] = passed(value[column], kRelu6, dz[column]);
              of_row += dz[column];
              along_row += dz[column] * (z[column] - load(&mean[c]));
            }
            gradients += of_row;
            along += along_row;
            outer(picture.floats(row * shape.width), picture.stride(), narrow, dz, 1, shape.width,
                  part.data());
            for (std::size_t v = 0; v < picture.vectors(); ++v) {
              product(reinterpret_cast<const float*>(dz), kLanes, kLanes, by_channel[v].data(),
                      shape.width, towards_x[i].vector(v, row * shape.width), picture.vectors(),
                      c > 0);
            }
          });
      add_kernel(dweights, dkernel, shape.channels, c, count);
      sums.add(c, count, gradients, along);
      for (std::size_t lane = 0; lane < count; ++lane) {
        for (std::size_t k = 0; k < narrow; ++k) {
          products[(c + lane) * narrow + k] += part[k][lane];
        }
      }
    }
  }
  std::copy(dweights.begin(), dweights.end(), out.weights);
  const Descent before(g.in(), first, line, sums, out.first_weight, out.first_bias);
  expansion_gradient(expansion, gram, line, before, products, out.expansion);
  std::array<std::array<Lanes, kMostNarrow>, kMostNarrow / kLanes> b;
  std::array<Lanes, kMostNarrow / kLanes> constant;
  for (std::size_t v = 0; v < picture.vectors(); ++v) {
    moments_share(expansion, before, v * kLanes, b[v].data(), constant[v]);
  }
  for (std::size_t i = 0; i < shape.images; ++i) {
    picture.read(x + i * g.pixels() * narrow);
    for (std::size_t v = 0; v < picture.vectors(); ++v) {
      Lanes* to = towards_x[i].vector(v);
      product(picture.floats(), picture.stride(), narrow, b[v].data(), g.pixels(), to,
              picture.vectors(), true);
      for (std::size_t p = 0; p < g.pixels(); ++p) {
        to[p * picture.vectors()] += constant[v];
      }
    }
    towards_x[i].write(dx + i * g.pixels() * narrow);
  }
}

}  // namespace

extern "C" {

void expanded_unit_forward(const DepthwiseShape* shape, std::size_t narrow, int half, const void* x,
                           float epsilon, const float* expansion, Norm first, const float* weights,
                           Norm second, double* gram, void* slid, void* y) {
  if (half != 0) {
    forward(*shape, narrow, static_cast<const BFloat16*>(x), epsilon, expansion, first, weights,
            second, gram, static_cast<BFloat16*>(slid), static_cast<BFloat16*>(y));
  } else {
    forward(*shape, narrow, static_cast<const float*>(x), epsilon, expansion, first, weights,
            second, gram, static_cast<float*>(slid), static_cast<float*>(y));
  }
}

void expanded_unit_backward(const DepthwiseShape* shape, std::size_t narrow, int half,
                            const void* dy, const void* x, const void* slid, const float* expansion,
                            Norm first, const float* weights, Norm second, double* gram, void* dx,
                            Gradients out) {
  if (half != 0) {
    backward(*shape, narrow, static_cast<const BFloat16*>(dy), static_cast<const BFloat16*>(x),
             static_cast<const BFloat16*>(slid), expansion, first, weights, second, gram,
             static_cast<BFloat16*>(dx), out);
  } else {
    backward(*shape, narrow, static_cast<const float*>(dy), static_cast<const float*>(x),
             static_cast<const float*>(slid), expansion, first, weights, second, gram,
             static_cast<float*>(dx), out);
  }
}
}

}  // namespace mien::training
