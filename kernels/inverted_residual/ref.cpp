// Computes one output row at a time, and expands each channel for the height of one window. Inputs
// of layers with 8 bits are clamped, but not rounded.
#include "kernels/common/ref.h"
#include "kernels/families.h"

namespace mien::kernels::ref {
namespace {

double bounded(double input, const InvertedResidualArgs::Weights& layer) {
  const double bound = layer.input_bound;
  return layer.quads != nullptr ? std::clamp(input, -bound, bound) : input;
}

float expanded(const InvertedResidualArgs& a, std::int32_t y, std::int32_t x, std::int32_t c) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.in_h} * a.in_w;
  const std::ptrdiff_t pixel = std::ptrdiff_t{y} * a.in_w + x;
  if (a.expand.weights == nullptr) {
    return a.x[blocked(c, pixel, pixels)];
  }
  const std::ptrdiff_t reduction = std::ptrdiff_t{blocks_of(a.in_c)} * kBlock;
  double sum = half_to_float(a.expand.bias[c]);
  for (std::int32_t i = 0; i < a.in_c; ++i) {
    sum += panel_weight(a.expand.weights, a.hidden_c, reduction, c, i) *
           bounded(a.x[blocked(i, pixel, pixels)], a.expand);
  }
  return static_cast<float>(activated(sum, a.expand.activation, c));
}

// Expands the rows of channel c that output row oy reads, into the strip: [kernel_h][in_w].
void expand_rows(const InvertedResidualArgs& a, std::int32_t oy, std::int32_t c) {
  for (std::int32_t ky = 0; ky < a.kernel_h; ++ky) {
    const std::int32_t y = oy * a.stride_h + ky - a.pad_top;
    for (std::int32_t x = 0; x < a.in_w; ++x) {
      const bool is_inside = y >= 0 && y < a.in_h;
      a.strip[std::ptrdiff_t{ky} * a.in_w + x] = is_inside ? expanded(a, y, x, c) : 0.0f;
    }
  }
}

float depthwise_output(const InvertedResidualArgs& a, std::int32_t ox, std::int32_t c) {
  const std::ptrdiff_t first = std::ptrdiff_t{c / kBlock} * a.kernel_h * a.kernel_w * kBlock;
  const std::uint16_t* weights = a.depthwise.weights + first;
  double sum = half_to_float(a.depthwise.bias[c]);
  for (std::int32_t ky = 0; ky < a.kernel_h; ++ky) {
    for (std::int32_t kx = 0; kx < a.kernel_w; ++kx) {
      const std::int32_t x = ox * a.stride_w + kx - a.pad_left;
      if (x >= 0 && x < a.in_w) {
        const double w = half_to_float(weights[(ky * a.kernel_w + kx) * kBlock + c % kBlock]);
        sum += w * static_cast<double>(a.strip[std::ptrdiff_t{ky} * a.in_w + x]);
      }
    }
  }
  return static_cast<float>(activated(sum, a.depthwise.activation, c));
}

double projected(const InvertedResidualArgs& a, std::int32_t ox, std::int32_t o) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{blocks_of(a.hidden_c)} * kBlock;
  double sum = half_to_float(a.project.bias[o]);
  for (std::int32_t c = 0; c < a.hidden_c; ++c) {
    sum += panel_weight(a.project.weights, a.out_c, reduction, o, c) *
           bounded(a.band[blocked(c, ox, a.out_w)], a.project);
  }
  return activated(sum, a.project.activation, o);
}

double residual_at(const InvertedResidualArgs& a, std::int32_t y, std::int32_t x, std::int32_t o) {
  if (a.residual == nullptr) {
    return 0.0;
  }
  const std::ptrdiff_t pixel =
      std::ptrdiff_t{y + a.residual_top} * a.residual_w + x + a.residual_left;
  return a.residual[blocked(o, pixel, std::ptrdiff_t{a.residual_h} * a.residual_w)];
}

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{a.out_h} * a.out_w;
  for (std::int32_t oy = 0; oy < a.out_h; ++oy) {
    for (std::int32_t c = 0; c < a.hidden_c; ++c) {
      expand_rows(a, oy, c);
      for (std::int32_t ox = 0; ox < a.out_w; ++ox) {
        a.band[blocked(c, ox, a.out_w)] = depthwise_output(a, ox, c);
      }
    }
    for (std::int32_t o = 0; o < blocks_of(a.out_c) * kBlock; ++o) {
      for (std::int32_t ox = 0; ox < a.out_w; ++ox) {
        const double sum = o < a.out_c ? projected(a, ox, o) + residual_at(a, oy, ox, o) : 0.0;
        a.y[blocked(o, std::ptrdiff_t{oy} * a.out_w + ox, pixels)] = static_cast<float>(sum);
      }
    }
  }
}

}  // namespace mien::kernels::ref
