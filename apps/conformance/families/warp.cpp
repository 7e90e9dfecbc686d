// Cases of warp, with the expected results.
#include <algorithm>
#include <array>
#include <limits>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::PixelFormat;
using kernels::Plane;
using kernels::WarpArgs;

constexpr int kFormats = 6;

// A plane of an image without bytes beyond those that its stride requires.
struct TestPlane {
  int width = 1, height = 1, pixel_bytes = 1, row_bytes = 1;
  bool bottom_up = false;
  std::vector<std::uint8_t> bytes;

  TestPlane() : bytes(1) {}
  TestPlane(RandomValues& random, int w, int h, int pixel, int used_bytes, bool flipped)
      : width(w), height(h), pixel_bytes(pixel), bottom_up(flipped) {
    constexpr int kPadding[] = {0, 1, 3, 5, 7, 13};
    row_bytes = w * pixel + kPadding[random.between(0, 5)];
    bytes.resize(as_size(row_bytes * (h - 1) + (w - 1) * pixel + used_bytes));
    for (std::uint8_t& one : bytes) {
      one = static_cast<std::uint8_t>(random.between(0, 255));
    }
  }

  [[nodiscard]] std::ptrdiff_t offset(int x, int y) const {
    const int row = bottom_up ? height - 1 - y : y;
    return std::ptrdiff_t{row} * row_bytes + std::ptrdiff_t{x} * pixel_bytes;
  }
  [[nodiscard]] Plane at(const std::uint8_t* first) const {
    return {first + offset(0, 0), bottom_up ? -row_bytes : row_bytes, pixel_bytes};
  }
  // Byte `channel` of a pixel; the border repeats outside.
  [[nodiscard]] double sample(int x, int y, int channel) const {
    const std::ptrdiff_t at =
        offset(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1)) + channel;
    return bytes[static_cast<std::size_t>(at)];
  }
  // Mean of the box in column x and row y.
  [[nodiscard]] double mean(int x, int y, int channel, int box) const {
    double sum = 0.0;
    for (int row = y * box; row < (y + 1) * box; ++row) {
      for (int column = x * box; column < (x + 1) * box; ++column) {
        sum += sample(column, row, channel);
      }
    }
    return sum / (box * box);
  }
};

struct Image {
  PixelFormat format;
  bool full_range;
  bool bt709;
  int width, height;
  std::array<TestPlane, 3> planes;
};

struct Transform {
  float matrix[6];
  int box, chroma_box, width, height;
  float scale, offset;
};

// A coordinate in the image with the error bound of its computation in fp32.
struct Coordinate {
  double value, error;
};

Coordinate coordinate(const float* row, double j, double i) {
  const double terms[] = {static_cast<double>(row[0]) * j, static_cast<double>(row[1]) * i,
                          static_cast<double>(row[2])};
  const double value = terms[0] + terms[1] + terms[2];
  double magnitude = 0.0;
  for (const double one : terms) {
    magnitude += std::abs(one);
  }
  const bool finite = std::isfinite(value);
  return {finite ? value : 0.0, finite ? kSumFactor * kUnit * magnitude : 0.0};
}

// Bilinear sample of four boxes. Its error bound includes those of the coordinates: the sample
// changes by at most 255 per box along an axis, and a kernel may round the horizontal position to
// parts of 2^14. `shrink`: pixels of the image per sample of the plane.
Approx bilinear(const TestPlane& plane, int channel, Coordinate x, Coordinate y, int shrink,
                int box) {
  constexpr double kMargin = 2.0;  // positions further beyond the border are equivalent
  const double box_pixels = shrink * box, across = plane.width, down = plane.height;
  const double px = std::clamp(x.value / box_pixels, -kMargin, across / box + kMargin) - 0.5;
  const double py = std::clamp(y.value / box_pixels, -kMargin, down / box + kMargin) - 0.5;
  const int x0 = static_cast<int>(std::floor(px)), y0 = static_cast<int>(std::floor(py));
  const double fx = px - x0, fy = py - y0;
  const auto at = [&](int column, int row) {
    return plane.mean(x0 + column, y0 + row, channel, box);
  };
  const double top = (1 - fx) * at(0, 0) + fx * at(1, 0);
  const double bottom = (1 - fx) * at(0, 1) + fx * at(1, 1);
  constexpr double kRounding = 1.0 / (1 << 15);
  const double moved = std::min(1.0, (x.error + y.error) / box_pixels + kRounding +
                                         kSumFactor * kUnit * (plane.width + plane.height + 8));
  return {(1 - fy) * top + fy * bottom, 255.0 * moved};
}

struct Colour {
  Approx channel[3];
};

Approx clamped(double value, double error) {
  return {std::clamp(value, 0.0, 255.0), std::min(error, 255.0)};
}

Approx luma_of(const Image& image, const Transform& transform, Coordinate x, Coordinate y) {
  const Approx sample = bilinear(image.planes[0], 0, x, y, 1, transform.box);
  constexpr double kGain = 255.0 / 219.0;
  return image.full_range ? sample : Approx{(sample.value - 16.0) * kGain, sample.error * kGain};
}

Colour yuv_colour(const Image& image, const Transform& transform, Coordinate x, Coordinate y) {
  const double gain = image.full_range ? 1.0 : 255.0 / 224.0;
  const Approx luma = luma_of(image, transform, x, y);
  const Approx u = bilinear(image.planes[1], 0, x, y, 2, transform.chroma_box);
  const Approx v = bilinear(image.planes[2], 0, x, y, 2, transform.chroma_box);
  constexpr double kSd[3][2] = {{0.0, 1.402}, {-0.344136, -0.714136}, {1.772, 0.0}};
  constexpr double kHd[3][2] = {{0.0, 1.5748}, {-0.187324, -0.468124}, {1.8556, 0.0}};
  const auto& matrix = image.bt709 ? kHd : kSd;
  Colour colour;
  for (int c = 0; c < 3; ++c) {
    const double of_u = matrix[c][0] * gain, of_v = matrix[c][1] * gain;
    colour.channel[c] = clamped(luma.value + of_u * (u.value - 128) + of_v * (v.value - 128),
                                luma.error + std::abs(of_u) * u.error + std::abs(of_v) * v.error);
  }
  return colour;
}

Colour colour_at(const Image& image, const Transform& transform, Coordinate x, Coordinate y) {
  Colour colour;
  switch (image.format) {
    case PixelFormat::kYuv420:
      return yuv_colour(image, transform, x, y);
    case PixelFormat::kGray8: {
      const Approx luma = luma_of(image, transform, x, y);
      colour.channel[0] = colour.channel[1] = colour.channel[2] = clamped(luma.value, luma.error);
      return colour;
    }
    default: {
      const bool reversed = image.format == PixelFormat::kBgr || image.format == PixelFormat::kBgra;
      for (int c = 0; c < 3; ++c) {
        colour.channel[c] = bilinear(image.planes[0], reversed ? 2 - c : c, x, y, 1, transform.box);
      }
      return colour;
    }
  }
}

Colour output_sample(const Image& image, const Transform& transform, double i, double j) {
  return colour_at(image, transform, coordinate(transform.matrix, j, i),
                   coordinate(transform.matrix + 3, j, i));
}

std::vector<Approx> expected(const Image& image, const Transform& transform) {
  std::vector<Approx> y;
  const auto scale = static_cast<double>(transform.scale);
  const auto offset = static_cast<double>(transform.offset);
  for (int i = 0; i < transform.height; ++i) {
    for (int j = 0; j < transform.width; ++j) {
      for (const Approx& one : output_sample(image, transform, i + 0.5, j + 0.5).channel) {
        const double rounding = kSumFactor * kUnit * (255.0 * scale + std::abs(offset));
        y.push_back({one.value * scale + offset, one.error * scale + rounding});
      }
    }
  }
  return y;
}

Case make(const Image& image, const Transform& transform) {
  Case test;
  test.shape = "format " + std::to_string(static_cast<int>(image.format)) + ", " +
               times(image.height, image.width) + " to " +
               times(transform.height, transform.width) + ", boxes of " +
               std::to_string(transform.box) + " and " + std::to_string(transform.chroma_box);
  for (const TestPlane& plane : image.planes) {
    test.buffers.push_back(reads(plane.bytes));
  }
  test.buffers.push_back(writes(Element::kFloat, expected(image, transform)));
  test.buffers.push_back(scratch(kernels::kWarpSampleElems / 2));
  test.bind = [=](const Addresses& buffers) {
    WarpArgs args{};
    args.format = image.format;
    for (std::size_t i = 0; i < 3; ++i) {
      args.plane[i] = image.planes[i].at(buffers.bytes(i));
    }
    args.full_range = image.full_range;
    args.yuv_matrix = image.bt709 ? kernels::kBt709 : kernels::kBt601;
    args.image_width = image.width;
    args.image_height = image.height;
    std::copy(std::begin(transform.matrix), std::end(transform.matrix), args.matrix);
    args.box = transform.box;
    args.chroma_box = transform.chroma_box;
    args.y = buffers.floats(3);
    args.width = transform.width;
    args.height = transform.height;
    args.scale = transform.scale;
    args.offset = transform.offset;
    args.samples = reinterpret_cast<std::uint16_t*>(buffers.floats(4));
    return arguments(args);
  };
  test.call = call<WarpArgs>;
  return test;
}

int bytes_per_pixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgb:
    case PixelFormat::kBgr:
      return 3;
    case PixelFormat::kRgba:
    case PixelFormat::kBgra:
      return 4;
    default:
      return 1;
  }
}

Image random_image(RandomValues& random, PixelFormat format, int width, int height) {
  const int pixel = bytes_per_pixel(format);
  const bool flipped = random.coin();
  Image image{format, random.coin(), random.coin(), width, height, {}};
  // The unused fourth byte of the last pixel is missing.
  image.planes[0] = TestPlane(random, width, height, pixel, std::min(pixel, 3), flipped);
  if (format == PixelFormat::kYuv420) {
    const int chroma_w = (width + 1) / 2, chroma_h = (height + 1) / 2;
    image.planes[1] = TestPlane(random, chroma_w, chroma_h, random.between(1, 2), 1, false);
    image.planes[2] = TestPlane(random, chroma_w, chroma_h, random.between(1, 2), 1, flipped);
  }
  return image;
}

// Some are far outside the image or not finite.
float unusual_value(RandomValues& random) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kOdd[] = {
      1e30f, -1e30f, kInfinity, -kInfinity, 3e9f, -3e9f, std::numeric_limits<float>::quiet_NaN()};
  return kOdd[random.between(0, static_cast<int>(std::size(kOdd)) - 1)];
}

Transform random_transform(RandomValues& random) {
  Transform transform{};
  for (float& one : transform.matrix) {
    one = static_cast<float>(random.between(-300, 300)) * 0.01f;
  }
  transform.matrix[2] = static_cast<float>(random.between(-50, 80));
  transform.matrix[5] = static_cast<float>(random.between(-50, 80));
  if (random.case_number() % 4 == 3) {
    transform.matrix[random.between(0, 5)] = unusual_value(random);
  }
  transform.box = 1 << random.between(0, 3);
  transform.chroma_box = 1 << random.between(0, 3);
  transform.width = random.size(40);
  transform.height = random.between(1, 19);
  transform.scale = 1.0f / 127.5f;
  transform.offset = -1.0f;
  return transform;
}

}  // namespace

template <>
Case random_case<WarpArgs>(RandomValues& random) {
  const auto format = static_cast<PixelFormat>(random.case_number() % kFormats);
  const int width = random.size(40), height = random.size(40);
  const Image image = random_image(random, format, width, height);
  return make(image, random_transform(random));
}

// The crop of the first encoder, from a camera image.
template <>
Case typical_case<WarpArgs>(RandomValues& random) {
  return make(random_image(random, PixelFormat::kYuv420, 640, 480),
              {{3.0f, 0.3f, 150.0f, -0.3f, 3.0f, 120.0f}, 2, 1, 65, 65, 1.0f / 127.5f, -1.0f});
}

}  // namespace mien::conformance
