// Four taps at a time: their pixels are fetched byte by byte into the lanes of vectors, since a
// wider load could read past the last byte of an image, and mixed together.
#include <algorithm>

#include "kernels/common/wasm.h"
#include "kernels/families.h"

namespace mien::kernels::wasm {
namespace {

// Where one axis of a bilinear sample reads: sample index a, its neighbour b, and the weight of b.
struct Axis {
  std::int32_t a[kLanes], b[kLanes];
  Vec weight;
};

// Of numbers below 2^22: adding 1.5 * 2^23 leaves the integer in the lowest bits.
Vec to_integer(Vec whole) {
  const Vec shift = splat(12582912.0f);
  return wasm_i32x4_sub(wasm_f32x4_add(whole, shift), shift);
}

// Coordinates to neighbours, clamped to the border. Not-a-numbers count as 0 like infinities: a
// comparison with either is false.
Axis axis_of(Vec coordinate, std::int32_t size) {
  coordinate = only(wasm_f32x4_le(wasm_f32x4_abs(coordinate), splat(3.0e38f)), coordinate);
  coordinate = at_least(coordinate, splat(-1.0f));
  coordinate = at_most(coordinate, splat(static_cast<float>(size) + 1.0f));
  coordinate = wasm_f32x4_sub(coordinate, splat(0.5f));
  const Vec whole = wasm_f32x4_floor(coordinate);
  const Vec index = to_integer(whole);
  const Vec next = wasm_i32x4_add(index, wasm_i32x4_splat(1));
  const Vec last = wasm_i32x4_splat(size - 1), zero = wasm_i32x4_splat(0);
  Axis axis;
  wasm_v128_store(axis.a, wasm_i32x4_max(zero, wasm_i32x4_min(index, last)));
  wasm_v128_store(axis.b, wasm_i32x4_max(zero, wasm_i32x4_min(next, last)));
  axis.weight = wasm_f32x4_sub(coordinate, whole);
  return axis;
}

// Four bytes as floats.
Vec gather(const std::uint8_t* const (&at)[kLanes], std::ptrdiff_t byte) {
  Vec bytes = wasm_i32x4_splat(0);
  bytes = wasm_v128_load8_lane(at[0] + byte, bytes, 0);
  bytes = wasm_v128_load8_lane(at[1] + byte, bytes, 4);
  bytes = wasm_v128_load8_lane(at[2] + byte, bytes, 8);
  bytes = wasm_v128_load8_lane(at[3] + byte, bytes, 12);
  return wasm_f32x4_convert_i32x4(bytes);
}

Vec between(Vec from, Vec to, Vec weight) {
  return add_product(from, weight, wasm_f32x4_sub(to, from));
}

// The four pixels around each of four samples.
struct Corners {
  const std::uint8_t *upper_left[kLanes], *upper_right[kLanes];
  const std::uint8_t *lower_left[kLanes], *lower_right[kLanes];
  Vec x, y;  // weights of the right and lower neighbours

  Corners(const Plane& plane, const Axis& xs, const Axis& ys) : x(xs.weight), y(ys.weight) {
    for (int i = 0; i < kLanes; ++i) {
      const std::uint8_t* upper = plane.data + ys.a[i] * plane.row_bytes;
      const std::uint8_t* lower = plane.data + ys.b[i] * plane.row_bytes;
      const std::ptrdiff_t left = xs.a[i] * plane.pixel_bytes;
      const std::ptrdiff_t right = xs.b[i] * plane.pixel_bytes;
      upper_left[i] = upper + left;
      upper_right[i] = upper + right;
      lower_left[i] = lower + left;
      lower_right[i] = lower + right;
    }
  }
  [[nodiscard]] Vec mix(std::ptrdiff_t byte) const {
    const Vec top = between(gather(upper_left, byte), gather(upper_right, byte), x);
    const Vec bottom = between(gather(lower_left, byte), gather(lower_right, byte), x);
    return between(top, bottom, y);
  }
};

Vec clamped(Vec x) { return at_most(at_least(x, splat(0.0f)), splat(255.0f)); }

struct Rgb {
  Vec c[3];

  void add(Vec red, Vec green, Vec blue) {
    c[0] = wasm_f32x4_add(c[0], red);
    c[1] = wasm_f32x4_add(c[1], green);
    c[2] = wasm_f32x4_add(c[2], blue);
  }
};

// Adds up taps in RGB, 0..255.
class Sampler {
 public:
  explicit Sampler(const WarpArgs& args)
      : a_(args),
        chroma_width_((args.image_width + 1) / 2),
        chroma_height_((args.image_height + 1) / 2),
        black_(splat(args.full_range ? 0.0f : 16.0f)),
        luma_gain_(splat(args.full_range ? 1.0f : 255.0f / 219.0f)),
        chroma_gain_(splat(args.full_range ? 1.0f : 255.0f / 224.0f)) {}

  void add(Vec x, Vec y, Rgb& sums) const {
    const Axis xs = axis_of(x, a_.image_width), ys = axis_of(y, a_.image_height);
    switch (a_.format) {
      case PixelFormat::kGray8:
        return add_gray(xs, ys, sums);
      case PixelFormat::kYuv420:
        return add_yuv(xs, ys, x, y, sums);
      case PixelFormat::kRgb:
      case PixelFormat::kRgba:
        return add_packed(xs, ys, sums, 0, 2);
      case PixelFormat::kBgr:
      case PixelFormat::kBgra:
        return add_packed(xs, ys, sums, 2, 0);
    }
  }

 private:
  [[nodiscard]] Vec luma(const Axis& xs, const Axis& ys) const {
    const Vec stored = Corners(a_.plane[0], xs, ys).mix(0);
    return wasm_f32x4_mul(wasm_f32x4_sub(stored, black_), luma_gain_);
  }
  [[nodiscard]] Vec chroma(const Plane& plane, const Axis& xs, const Axis& ys) const {
    const Vec stored = Corners(plane, xs, ys).mix(0);
    return wasm_f32x4_mul(wasm_f32x4_sub(stored, splat(128.0f)), chroma_gain_);
  }

  void add_packed(const Axis& xs, const Axis& ys, Rgb& sums, int red, int blue) const {
    const Corners at(a_.plane[0], xs, ys);
    sums.add(at.mix(red), at.mix(1), at.mix(blue));
  }

  void add_gray(const Axis& xs, const Axis& ys, Rgb& sums) const {
    const Vec gray = clamped(luma(xs, ys));
    sums.add(gray, gray, gray);
  }

  void add_yuv(const Axis& xs, const Axis& ys, Vec x, Vec y, Rgb& sums) const {
    const Vec half = splat(0.5f);
    const Axis us = axis_of(wasm_f32x4_mul(x, half), chroma_width_);
    const Axis vs = axis_of(wasm_f32x4_mul(y, half), chroma_height_);
    const Vec bright = luma(xs, ys);
    const Vec u = chroma(a_.plane[1], us, vs), v = chroma(a_.plane[2], us, vs);
    const Vec green = add_product(add_product(bright, u, splat(-0.344136f)), v, splat(-0.714136f));
    sums.add(clamped(add_product(bright, v, splat(1.402f))), clamped(green),
             clamped(add_product(bright, u, splat(1.772f))));
  }

  const WarpArgs& a_;
  std::int32_t chroma_width_, chroma_height_;
  Vec black_, luma_gain_, chroma_gain_;
};

// The sum over the taps of 4 output samples of row i, from column j on. Beyond the row's end they
// are computed as well: their coordinates are clamped as all are.
Rgb sum_of_taps(const WarpArgs& a, const Sampler& sampler, std::int32_t i, std::int32_t j) {
  const float* m = a.matrix;
  const float step = 1.0f / static_cast<float>(a.taps);
  Rgb sums = {{splat(0.0f), splat(0.0f), splat(0.0f)}};
  for (std::int32_t v = 0; v < a.taps; ++v) {
    const Vec row = splat(static_cast<float>(i) + (static_cast<float>(v) + 0.5f) * step);
    for (std::int32_t u = 0; u < a.taps; ++u) {
      const float first = static_cast<float>(j) + (static_cast<float>(u) + 0.5f) * step;
      const Vec column = wasm_f32x4_add(wasm_f32x4_make(0, 1, 2, 3), splat(first));
      const auto affine = [&](const float* k) {
        return add_product(add_product(splat(k[2]), row, splat(k[1])), column, splat(k[0]));
      };
      sampler.add(affine(m), affine(m + 3), sums);
    }
  }
  return sums;
}

}  // namespace

void warp(const WarpArgs& a) {
  const Sampler sampler(a);
  const float step = 1.0f / static_cast<float>(a.taps);
  const Vec mean = splat(a.scale * step * step), offset = splat(a.offset);
  for (std::int32_t i = 0; i < a.height; ++i) {
    for (std::int32_t j = 0; j < a.width; j += kLanes) {
      const Rgb sums = sum_of_taps(a, sampler, i, j);
      float values[3][kLanes];
      for (int c = 0; c < 3; ++c) {
        store(values[c], add_product(offset, sums.c[c], mean));
      }
      float* y = a.y + (std::ptrdiff_t{i} * a.width + j) * 3;
      for (int k = 0; k < std::min(kLanes, a.width - j); ++k) {
        for (int c = 0; c < 3; ++c) {
          y[3 * k + c] = values[c][k];
        }
      }
    }
  }
}

}  // namespace mien::kernels::wasm
