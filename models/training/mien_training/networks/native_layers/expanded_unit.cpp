// An inverted residual in training without its projection: a pointwise convolution that expands few
// channels to many, norm and ReLU6, a 3x3 depthwise convolution, norm and ReLU6. Maps are
// [images][height][width][channels], fp32 or bfloat16; x has `narrow` channels, `convolved` and y
// have shape.channels. The expanded map, the largest of all, is never stored: it is computed from
// x, a vector of channels of one image at a time, and again in the backward pass. Its moments, and
// their gradients, follow from those of x, because it is linear in x: mean z = W mean x, E[z z'] =
// W E[x x'] W'. The weights of expand have the type of the map.
#include "depthwise.h"
#include "products.h"

namespace mien::training {
namespace {

constexpr std::size_t kMaxNarrow = 48;

// Sums over all pixels of x and of x x', in fp64.
struct Gram {
  std::size_t narrow;
  double* values;  // [narrow + 1][narrow]; the last row sums x itself

  double& at(std::size_t j, std::size_t k) const { return values[j * narrow + k]; }
  double& sum(std::size_t k) const { return values[narrow * narrow + k]; }

  template <typename T>
  void add(const Along<T>& x) const {
    for (std::size_t v = 0; v < x.vectors(); ++v) {
      const Vector<T>* vector = x.row(0) + v;
      std::array<Lanes, kMaxNarrow> part = {};
      outer<T>(x.row(0), x.vectors(), narrow, vector, x.vectors(), x.units_of_all(), part.data());
      Lanes sums = {};
      for (std::size_t u = 0; u < x.units_of_all(); ++u) {
        sums = Terms<T>::plus(sums, vector[u * x.vectors()], Terms<T>::kOnes);
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

// The weights of expand, [channels][narrow].
struct Expansion {
  std::size_t channels, narrow;
  const float* weights;

  const float* row(std::size_t channel) const { return weights + channel * narrow; }

  // For channels from c on: [narrow / terms] vectors over the channels.
  template <typename T>
  std::array<Vector<T>, kMaxNarrow> by_input(std::size_t c, std::size_t count) const {
    return joined<T, kMaxNarrow>(narrow, [&](std::size_t k) {
      Lanes out = {};
      for (std::size_t lane = 0; lane < count; ++lane) {
        out[lane] = row(c + lane)[k];
      }
      return out;
    });
  }

  // The same multiplied by scale, for a vector of inputs from k on: [kLanes / terms] vectors.
  template <typename T>
  std::array<Vector<T>, kLanes> by_channel(std::size_t c, std::size_t count, std::size_t k,
                                           const float* scale) const {
    return joined<T, kLanes>(kLanes, [&](std::size_t lane) {
      Lanes out = {};
      for (std::size_t i = 0; lane < count && i < kLanes && k + i < narrow; ++i) {
        out[i] = scale[c + lane] * row(c + lane)[k + i];
      }
      return out;
    });
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

// Computes a row of the expanded map z from x, and of the convolution's input `seen`, for a vector
// of channels from c on. z and `seen` may be the same.
template <typename T>
void expand_row(const T* x, std::size_t narrow, const std::array<Vector<T>, kMaxNarrow>& by_input,
                std::size_t width, const Line& line, std::size_t c, Lanes* z, Lanes* seen) {
  product(x, narrow, narrow, by_input.data(), width, z, 1, false);
  for (std::size_t column = 0; column < width; ++column) {
    seen[column] = limited(line.at(c, z[column]), kRelu6);
  }
}

template <typename T>
void forward(DepthwiseShape shape, std::size_t narrow, const T* x, float epsilon,
             const float* expansion_weights, Norm first, const float* weights, Norm second,
             double* gram_values, T* convolved, T* y) {
  const Geometry g(shape);
  const Expansion expansion = {shape.channels, narrow, expansion_weights};
  const Gram gram = {narrow, gram_values};
  std::fill_n(gram_values, (narrow + 1) * narrow, 0.0);
  Along<T> along(shape.height, shape.width, narrow);
  for (std::size_t i = 0; i < shape.images; ++i) {
    along.read(x + i * g.pixels() * narrow);
    gram.add(along);
  }
  set_moments(expansion.totals(gram), g.in().pixels, shape.channels, epsilon, first);
  const Line line(shape.channels, first);
  Rows seen(g);
  Totals sums;
  for (std::size_t i = 0; i < shape.images; ++i) {
    const T* picture = x + i * g.pixels() * narrow;
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c);
      const auto by_input = expansion.by_input<T>(c, count);
      Lanes values = {}, squares = {};
      convolve(g, seen, kernel_of(weights, shape.channels, c, count),
               convolved + i * g.out_pixels() * shape.channels + c, count, values, squares,
               [&](std::size_t row) {
                 expand_row(picture + row * shape.width * narrow, narrow, by_input, shape.width,
                            line, c, seen.inner(row), seen.inner(row));
               });
      sums.add(c, count, values, squares);
    }
  }
  set_moments(sums, g.out().pixels, shape.channels, epsilon, second);
  normalise(convolved, g.out(), Line(shape.channels, second), kRelu6, y);
}

struct Gradients {
  float *expansion, *first_weight, *first_bias, *weights, *second_weight, *second_bias;
};

// The part of the gradient of x that comes from the moments of the expanded map: x B + constant,
// for a vector of outputs from k on: [narrow / terms] vectors of B.
template <typename T>
std::array<Vector<T>, kMaxNarrow> moments_share(const Expansion& e, const NormBackward& before,
                                                std::size_t k, Lanes& constant) {
  const std::size_t count = std::min(kLanes, e.narrow - k);
  constant = Lanes{};
  for (std::size_t c = 0; c < e.channels; ++c) {
    constant += before.constant[c] * load_some(e.row(c) + k, count);
  }
  return joined<T, kMaxNarrow>(e.narrow, [&](std::size_t j) {
    Lanes out = {};
    for (std::size_t c = 0; c < e.channels; ++c) {
      out += e.row(c)[j] * before.along[c] * load_some(e.row(c) + k, count);
    }
    return out;
  });
}

template <typename T>
void add_moments_share(const Expansion& e, const NormBackward& before, const Geometry& g,
                       const T* x, T* dx) {
  const std::size_t pixels = g.shape.width;  // at a time
  std::vector<Lanes> share(pixels);
  for (std::size_t k = 0; k < e.narrow; k += kLanes) {
    const std::size_t count = std::min(kLanes, e.narrow - k);
    Lanes constant;
    const auto b = moments_share<T>(e, before, k, constant);
    for (std::size_t p = 0; p < g.in().pixels; p += pixels) {
      product(x + p * e.narrow, e.narrow, e.narrow, b.data(), pixels, share.data(), 1, false);
      for (std::size_t j = 0; j < pixels; ++j) {
        T* to = dx + (p + j) * e.narrow + k;
        store_some(to, load_some(to, count) + share[j] + constant, count);
      }
    }
  }
}

void expansion_gradient(const Expansion& e, const Gram& gram, const Line& line,
                        const NormBackward& before, const std::vector<double>& products,
                        float* out) {
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

// Copies [pixels][vectors] in fp32 to [pixels][channels].
template <typename T>
void write(const std::vector<Lanes>& from, std::size_t channels, T* to) {
  for (auto vector = from.begin(); vector != from.end(); to += channels) {
    for (std::size_t c = 0; c < channels; c += kLanes) {
      store_some(to + c, *vector++, std::min(kLanes, channels - c));
    }
  }
}

// Passes the gradient dz of the expanded map on to x and to the weights of expand: one image, a
// vector of channels and a row at a time.
template <typename T>
class ExpansionBackward {
 public:
  ExpansionBackward(const Geometry& g, const Expansion& expansion)
      : width_(g.shape.width),
        expansion_(expansion),
        along_x_(g.shape.height, width_, expansion.narrow),
        along_dz_(1, width_, kLanes),
        dz_(width_ * kLanes),
        towards_x_(g.pixels() * along_x_.vectors()),
        products_(expansion.channels * expansion.narrow) {}

  void begin_image(const T* x) { along_x_.read(x); }

  void begin_channels(std::size_t c, std::size_t count, const Line& line) {
    part_ = {};
    for (std::size_t v = 0; v < along_x_.vectors(); ++v) {
      by_channel_[v] = expansion_.by_channel<T>(c, count, v * kLanes, line.scale.data());
    }
  }

  void add_row(std::size_t row, std::size_t c, const Lanes* dz) {
    const std::size_t vectors = along_x_.vectors();
    along_dz_.fill([dz](std::size_t, std::size_t column, std::size_t) { return dz[column]; });
    outer<T>(along_x_.row(row), vectors, expansion_.narrow, along_dz_.row(0), 1,
             along_dz_.units_of_all(), part_.data());
    for (std::size_t column = 0; column < width_; ++column) {
      store(&dz_[column * kLanes], dz[column]);
    }
    for (std::size_t v = 0; v < vectors; ++v) {
      product(dz_.data(), kLanes, kLanes, by_channel_[v].data(), width_,
              &towards_x_[row * width_ * vectors + v], vectors, c > 0);
    }
  }

  void end_channels(std::size_t c, std::size_t count) {
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (std::size_t k = 0; k < expansion_.narrow; ++k) {
        products_[(c + lane) * expansion_.narrow + k] += part_[k][lane];
      }
    }
  }

  void end_image(T* dx) const { write(towards_x_, expansion_.narrow, dx); }

  // The sums of dz x' over all pixels, [channels][narrow].
  const std::vector<double>& products() const { return products_; }

 private:
  std::size_t width_;
  const Expansion& expansion_;
  Along<T> along_x_, along_dz_;
  std::vector<T> dz_;             // a row
  std::vector<Lanes> towards_x_;  // the gradient of one image of x
  std::vector<double> products_;
  std::array<std::array<Vector<T>, kLanes>, kMaxNarrow / kLanes> by_channel_;
  std::array<Lanes, kMaxNarrow> part_;  // of products_, of one image
};

template <typename T>
void backward(DepthwiseShape shape, std::size_t narrow, const T* dy, const T* x, const T* convolved,
              const float* expansion_weights, Norm first, const float* weights, Norm second,
              double* gram_values, T* dx, Gradients out) {
  const Geometry g(shape);
  const Expansion expansion = {shape.channels, narrow, expansion_weights};
  const Gram gram = {narrow, gram_values};
  const Line line(shape.channels, first);
  const OutputGradient<T> slope(g, dy, convolved, second, out.second_weight, out.second_bias);
  PerChannel<float> mean = {};
  std::copy_n(first.mean, shape.channels, mean.begin());
  Rows expanded(g), seen(g), gradient(g);
  ExpansionBackward<T> expansion_backward(g, expansion);
  Totals sums;
  std::vector<double> dweights(kTaps * shape.channels);
  for (std::size_t i = 0; i < shape.images; ++i) {
    slope.prefetch_maps(i * g.out_pixels() * shape.channels, g.out_pixels() * shape.channels);
    const T* picture = x + i * g.pixels() * narrow;
    expansion_backward.begin_image(picture);
    for (std::size_t c = 0; c < shape.channels; c += kLanes) {
      const std::size_t count = std::min(kLanes, shape.channels - c),
                        convolved_image = i * g.out_pixels() * shape.channels + c;
      const auto by_input = expansion.by_input<T>(c, count);
      expansion_backward.begin_channels(c, count, line);
      Kernel dkernel = {};
      Lanes gradients = {}, along = {};
      slide_backward(
          g, seen, gradient, kernel_of(weights, shape.channels, c, count), dkernel,
          [&](std::size_t pixel) {
            return slope.at(convolved_image + pixel * shape.channels, c, count);
          },
          [&](std::size_t row) {
            expand_row(picture + row * shape.width * narrow, narrow, by_input, shape.width, line, c,
                       expanded.inner(row), seen.inner(row));
          },
          [&](std::size_t row) {
            const Lanes *z = expanded.inner(row), *value = seen.inner(row);
            Lanes* dz = gradient.inner(row);
            Lanes of_row = {}, along_row = {};  // in registers, unlike captured sums
            for (std::size_t column = 0; column < shape.width; ++column) {
              dz[column] = passed(value[column], kRelu6, dz[column]);
              of_row += dz[column];
              along_row += dz[column] * (z[column] - load(&mean[c]));
            }
            gradients += of_row;
            along += along_row;
            expansion_backward.add_row(row, c, dz);
          });
      add_kernel(dweights, dkernel, shape.channels, c, count);
      sums.add(c, count, gradients, along);
      expansion_backward.end_channels(c, count);
    }
    expansion_backward.end_image(dx + i * g.pixels() * narrow);
  }
  std::copy(dweights.begin(), dweights.end(), out.weights);
  const NormBackward before(g.in(), first, line, sums, out.first_weight, out.first_bias);
  expansion_gradient(expansion, gram, line, before, expansion_backward.products(), out.expansion);
  add_moments_share(expansion, before, g, x, dx);
}

}  // namespace

extern "C" {

void expanded_unit_forward(const DepthwiseShape* shape, std::size_t narrow, int half, const void* x,
                           float epsilon, const float* expansion, Norm first, const float* weights,
                           Norm second, double* gram, void* convolved, void* y) {
  if (half != 0) {
    forward(*shape, narrow, static_cast<const BFloat16*>(x), epsilon, expansion, first, weights,
            second, gram, static_cast<BFloat16*>(convolved), static_cast<BFloat16*>(y));
  } else {
    forward(*shape, narrow, static_cast<const float*>(x), epsilon, expansion, first, weights,
            second, gram, static_cast<float*>(convolved), static_cast<float*>(y));
  }
}

void expanded_unit_backward(const DepthwiseShape* shape, std::size_t narrow, int half,
                            const void* dy, const void* x, const void* convolved,
                            const float* expansion, Norm first, const float* weights, Norm second,
                            double* gram, void* dx, Gradients out) {
  if (half != 0) {
    backward(*shape, narrow, static_cast<const BFloat16*>(dy), static_cast<const BFloat16*>(x),
             static_cast<const BFloat16*>(convolved), expansion, first, weights, second, gram,
             static_cast<BFloat16*>(dx), out);
  } else {
    backward(*shape, narrow, static_cast<const float*>(dy), static_cast<const float*>(x),
             static_cast<const float*>(convolved), expansion, first, weights, second, gram,
             static_cast<float*>(dx), out);
  }
}
}

}  // namespace mien::training
