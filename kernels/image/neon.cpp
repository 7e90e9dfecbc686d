// Coordinates of 4 taps at a time; the pixels themselves are fetched one by one, since a wider load
// could read past the last byte of an image.
#include <algorithm>

#include "kernels/common/neon.h"
#include "kernels/families.h"

namespace mien::kernels::MIEN_TIER {
namespace {

// Where one axis of a bilinear sample reads: sample index a, its neighbour b, and the weight of b.
struct Axis {
  std::int32_t a[kLanes], b[kLanes];
  float weight[kLanes];
};

// Coordinates to neighbours, clamped to the border. Not-a-numbers count as 0 like infinities: a
// comparison with either is false.
Axis axis_of(Vec coordinate, std::int32_t size) {
  coordinate = only(vcleq_f32(vabsq_f32(coordinate), splat(3.0e38f)), coordinate);
  coordinate = vmaxq_f32(coordinate, splat(-1.0f));
  coordinate = vminq_f32(coordinate, splat(static_cast<float>(size) + 1.0f));
  coordinate = vsubq_f32(coordinate, splat(0.5f));
  const Vec whole = floor(coordinate);
  const int32x4_t index = vcvtq_s32_f32(whole);
  const int32x4_t next = vaddq_s32(index, vdupq_n_s32(1));
  const int32x4_t last = vdupq_n_s32(size - 1), zero = vdupq_n_s32(0);
  Axis axis;
  vst1q_s32(axis.a, vmaxq_s32(zero, vminq_s32(index, last)));
  vst1q_s32(axis.b, vmaxq_s32(zero, vminq_s32(next, last)));
  vst1q_f32(axis.weight, vsubq_f32(coordinate, whole));
  return axis;
}

struct Rgb {
  float c[3];
};

struct Corners {
  const std::uint8_t *p00, *p01, *p10, *p11;
  float x, y;  // weights of the right and lower neighbours

  [[nodiscard]] float mix(std::ptrdiff_t byte) const {
    const float top = static_cast<float>(p00[byte]) +
                      x * (static_cast<float>(p01[byte]) - static_cast<float>(p00[byte]));
    const float bottom = static_cast<float>(p10[byte]) +
                         x * (static_cast<float>(p11[byte]) - static_cast<float>(p10[byte]));
    return top + y * (bottom - top);
  }
};

Corners corners(const Plane& plane, const Axis& xs, const Axis& ys, int i) {
  const std::uint8_t* upper = plane.data + ys.a[i] * plane.row_bytes;
  const std::uint8_t* lower = plane.data + ys.b[i] * plane.row_bytes;
  const std::ptrdiff_t left = xs.a[i] * plane.pixel_bytes, right = xs.b[i] * plane.pixel_bytes;
  return {upper + left, upper + right, lower + left, lower + right, xs.weight[i], ys.weight[i]};
}

float clamped(float value) { return std::min(std::max(value, 0.0f), 255.0f); }

float full_luma(float luma, bool full_range) {
  return full_range ? luma : (luma - 16.0f) * (255.0f / 219.0f);
}

// Adds up taps in RGB, 0..255.
class Sampler {
 public:
  explicit Sampler(const WarpArgs& args)
      : a_(args),
        chroma_width_((args.image_width + 1) / 2),
        chroma_height_((args.image_height + 1) / 2) {}

  void add(Vec x, Vec y, int count, Rgb* sums) const {
    const Axis xs = axis_of(x, a_.image_width), ys = axis_of(y, a_.image_height);
    switch (a_.format) {
      case PixelFormat::kGray8:
        return add_gray(xs, ys, count, sums);
      case PixelFormat::kYuv420:
        return add_yuv(xs, ys, x, y, count, sums);
      case PixelFormat::kRgb:
      case PixelFormat::kRgba:
        return add_packed(xs, ys, count, sums, 0, 2);
      case PixelFormat::kBgr:
      case PixelFormat::kBgra:
        return add_packed(xs, ys, count, sums, 2, 0);
    }
  }

 private:
  void add_packed(const Axis& xs, const Axis& ys, int count, Rgb* sums, int red, int blue) const {
    for (int i = 0; i < count; ++i) {
      const Corners at = corners(a_.plane[0], xs, ys, i);
      sums[i].c[0] += at.mix(red);
      sums[i].c[1] += at.mix(1);
      sums[i].c[2] += at.mix(blue);
    }
  }

  void add_gray(const Axis& xs, const Axis& ys, int count, Rgb* sums) const {
    for (int i = 0; i < count; ++i) {
      const float luma = clamped(full_luma(corners(a_.plane[0], xs, ys, i).mix(0), a_.full_range));
      for (float& channel : sums[i].c) {
        channel += luma;
      }
    }
  }

  void add_yuv(const Axis& xs, const Axis& ys, Vec x, Vec y, int count, Rgb* sums) const {
    const Axis us = axis_of(vmulq_f32(x, splat(0.5f)), chroma_width_);
    const Axis vs = axis_of(vmulq_f32(y, splat(0.5f)), chroma_height_);
    const float gain = a_.full_range ? 1.0f : 255.0f / 224.0f;
    for (int i = 0; i < count; ++i) {
      const float luma = full_luma(corners(a_.plane[0], xs, ys, i).mix(0), a_.full_range);
      const float u = (corners(a_.plane[1], us, vs, i).mix(0) - 128.0f) * gain;
      const float v = (corners(a_.plane[2], us, vs, i).mix(0) - 128.0f) * gain;
      sums[i].c[0] += clamped(luma + 1.402f * v);
      sums[i].c[1] += clamped(luma - 0.344136f * u - 0.714136f * v);
      sums[i].c[2] += clamped(luma + 1.772f * u);
    }
  }

  const WarpArgs& a_;
  std::int32_t chroma_width_, chroma_height_;
};

// Up to 4 output samples of a row, from column j on.
void warp_samples(const WarpArgs& a, const Sampler& sampler, std::int32_t i, std::int32_t j,
                  int count) {
  const float* m = a.matrix;
  static constexpr float kOrder[kLanes] = {0.0f, 1.0f, 2.0f, 3.0f};
  const Vec lane = vld1q_f32(kOrder);
  Rgb sums[kLanes] = {};
  const float step = 1.0f / static_cast<float>(a.taps);
  for (std::int32_t v = 0; v < a.taps; ++v) {
    const Vec row = splat(static_cast<float>(i) + (static_cast<float>(v) + 0.5f) * step);
    for (std::int32_t u = 0; u < a.taps; ++u) {
      const float first = static_cast<float>(j) + (static_cast<float>(u) + 0.5f) * step;
      const Vec column = vaddq_f32(lane, splat(first));
      const auto affine = [&](const float* k) {
        return fma(fma(splat(k[2]), row, splat(k[1])), column, splat(k[0]));
      };
      sampler.add(affine(m), affine(m + 3), count, sums);
    }
  }
  const float mean = a.scale * step * step;
  float* y = a.y + (std::ptrdiff_t{i} * a.width + j) * 3;
  for (int k = 0; k < count; ++k) {
    for (int c = 0; c < 3; ++c) {
      y[3 * k + c] = sums[k].c[c] * mean + a.offset;
    }
  }
}

}  // namespace

void warp(const WarpArgs& a) {
  const Sampler sampler(a);
  for (std::int32_t i = 0; i < a.height; ++i) {
    for (std::int32_t j = 0; j < a.width; j += kLanes) {
      warp_samples(a, sampler, i, j, std::min(kLanes, a.width - j));
    }
  }
}

}  // namespace mien::kernels::MIEN_TIER
