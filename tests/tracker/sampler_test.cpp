// Tests of warped crops: colour and brightness keep their positions, and patterns too fine for a
// crop are averaged instead of aliased.
#include "tracker/image/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/arena.h"
#include "kernels/tier.h"

namespace mien::tracker {
namespace {

constexpr int kSide = 512;  // of the image
constexpr float kMiddle = kSide / 2.0f;
constexpr std::int32_t kSamples = 16;  // of a crop
constexpr std::size_t kCropValues = 3 * std::size_t{kSamples} * kSamples;

using Value = std::function<int(int column, int row)>;

// A square image with a luma plane and, depending on the format, chroma planes of half its size.
class Scene {
 public:
  Scene(std::int32_t format, const Value& luma, const Value& u)
      : luma_(std::size_t{kSide} * kSide) {
    mien_image_default(&image_);
    image_.format = format;
    image_.width = image_.height = kSide;
    image_.full_range = 1;
    image_.yuv_matrix = MIEN_YUV_BT601;
    fill(luma_, kSide, luma);
    image_.planes[0] = luma_.data();
    image_.row_stride_bytes[0] = kSide;
    if (format == MIEN_IMAGE_I420) {
      add_planes(u);
    } else if (format != MIEN_IMAGE_GRAY8) {
      add_pairs(u, format == MIEN_IMAGE_NV12 ? 0 : 1);
    }
  }
  [[nodiscard]] const mien_image& image() const { return image_; }

 private:
  static constexpr std::size_t kHalf = kSide / 2;

  static void fill(std::vector<std::uint8_t>& plane, int width, const Value& value) {
    for (std::size_t i = 0; i < plane.size(); ++i) {
      const int at = static_cast<int>(i);
      plane[i] = static_cast<std::uint8_t>(value(at % width, at / width));
    }
  }
  void add_planes(const Value& u) {
    colour_[0].resize(kHalf * kHalf);
    colour_[1].assign(kHalf * kHalf, 128);
    fill(colour_[0], kSide / 2, u);
    for (std::size_t i = 0; i < 2; ++i) {
      image_.planes[i + 1] = colour_[i].data();
      image_.row_stride_bytes[i + 1] = kSide / 2;
    }
    image_.chroma_pixel_stride_bytes = 1;
  }
  void add_pairs(const Value& u, int u_byte) {
    colour_[0].resize(2 * kHalf * kHalf);
    fill(colour_[0], kSide,
         [&](int byte, int row) { return byte % 2 == u_byte ? u(byte / 2, row) : 128; });
    image_.planes[1] = colour_[0].data();
    image_.row_stride_bytes[1] = kSide;
  }

  std::vector<std::uint8_t> luma_;
  std::vector<std::uint8_t> colour_[2];
  mien_image image_;
};

struct Rgb {
  float red, green, blue;  // 0..255
};

// Calls `use` with a sampler and a view of the scene.
template <typename Use>
void with_sampler(const Scene& scene, Use use) {
  ImageView view;
  EXPECT_EQ(view_image(&scene.image(), 1.0f, view), MIEN_OK);
  Sampler sampler;
  engine::Arena measured;
  EXPECT_TRUE(sampler.init(kernels::detect_cpu(), measured));
  struct alignas(engine::Arena::kAlignment) Line {
    std::byte bytes[engine::Arena::kAlignment];
  };
  std::vector<Line> memory(measured.need().total_bytes() / sizeof(Line) + 1);
  engine::Arena arena(memory.data()->bytes, measured.need());
  EXPECT_TRUE(sampler.init(kernels::detect_cpu(), arena));
  use(sampler, view);
}

// The samples of a crop at the centre of the scene, row by row, `pixels_apart` pixels apart.
std::vector<Rgb> cut(const Scene& scene, float pixels_apart) {
  std::vector<float> picture(kCropValues);
  with_sampler(scene, [&](const Sampler& sampler, const ImageView& view) {
    const Crop crop = {{kMiddle, kMiddle}, pixels_apart * kSamples, 0.0f};
    sampler.warp(view, crop, {kSamples, kSamples, 1.0f}, picture);
  });
  std::vector<Rgb> samples;
  for (std::size_t i = 0; i < picture.size(); i += 3) {
    const auto value = [&](std::size_t channel) { return (picture[i + channel] + 1) * 127.5f; };
    samples.push_back({value(0), value(1), value(2)});
  }
  return samples;
}

float range_of(const std::vector<Rgb>& samples, float Rgb::*channel) {
  const auto less = [channel](const Rgb& a, const Rgb& b) { return a.*channel < b.*channel; };
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end(), less);
  return (*most).*channel - (*least).*channel;
}

int grey(int, int) { return 128; }

// Distances between samples in pixels, from upscaling to strong downscaling.
constexpr float kDistances[] = {0.7f, 1.0f, 1.4f, 2.3f, 3.7f, 5.1f, 7.3f, 11.6f};

TEST(Sampler, KeepsThePositionOfColour) {
  // A colour sample is the mean of 2 x 2 pixels, so that sample c lies at pixel 2 c + 1.
  const auto blue_at = [](float pixel) { return 128 + 1.772f * ((pixel - 1) / 2 - 128); };
  for (const std::int32_t format : {MIEN_IMAGE_NV12, MIEN_IMAGE_NV21, MIEN_IMAGE_I420}) {
    const Scene across(format, grey, [](int column, int) { return column; });
    const Scene down(format, grey, [](int, int row) { return row; });
    for (const float distance : kDistances) {
      SCOPED_TRACE(testing::Message() << "format " << format << ", " << distance << " pixels");
      const std::vector<Rgb> columns = cut(across, distance), rows = cut(down, distance);
      for (std::size_t i = 0; i < kSamples; ++i) {
        const float pixel = kMiddle + (static_cast<float>(i) + 0.5f - kSamples / 2.0f) * distance;
        const float blue = std::clamp(blue_at(pixel), 0.0f, 255.0f);
        EXPECT_NEAR(columns[i].blue, blue, 0.1f) << "column " << i;
        EXPECT_NEAR(rows[i * kSamples].blue, blue, 0.1f) << "row " << i;
      }
    }
  }
}

TEST(Sampler, KeepsThePositionOfBrightness) {
  const auto ramp = [](int at) { return std::clamp(at - 128, 0, 255); };
  const Scene across(
      MIEN_IMAGE_GRAY8, [&](int column, int) { return ramp(column); }, grey);
  const Scene down(
      MIEN_IMAGE_GRAY8, [&](int, int row) { return ramp(row); }, grey);
  for (const float distance : kDistances) {
    const std::vector<Rgb> columns = cut(across, distance), rows = cut(down, distance);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const float pixel = kMiddle + (static_cast<float>(i) + 0.5f - kSamples / 2.0f) * distance;
      EXPECT_NEAR(columns[i].green, pixel - 128.5f, 0.1f) << distance;
      EXPECT_NEAR(rows[i * kSamples].green, pixel - 128.5f, 0.1f) << distance;
    }
  }
}

// A box averages out stripes of half its width; without it they would alias. Up to a distance
// of 1.5 boxes between samples they are visible.
TEST(Sampler, AveragesPatternsAboveTheSamplingLimit) {
  for (const int width : {1, 2, 4}) {
    const auto stripes = [width](int column, int) { return column / width % 2 == 0 ? 28 : 228; };
    const Scene luma(MIEN_IMAGE_GRAY8, stripes, grey);
    const Scene colour(MIEN_IMAGE_NV12, grey, stripes);
    const float limit = 1.5f * static_cast<float>(width);
    EXPECT_GT(range_of(cut(luma, 0.98f * limit), &Rgb::green), 60.0f) << width;
    EXPECT_LT(range_of(cut(luma, 1.02f * limit), &Rgb::green), 0.1f) << width;
    EXPECT_GT(range_of(cut(colour, 2 * 0.98f * limit), &Rgb::blue), 60.0f) << width;
    EXPECT_LT(range_of(cut(colour, 2 * 1.02f * limit), &Rgb::blue), 0.1f) << width;
  }
}

// Half of each crop lies beside the white image: its left half upright, its lower half turned.
TEST(Sampler, PixelsBesideTheImageAreBlack) {
  const Scene white(MIEN_IMAGE_GRAY8, [](int, int) { return 255; }, {});
  for (const bool turned : {false, true}) {
    std::vector<float> picture(kCropValues);
    with_sampler(white, [&](const Sampler& sampler, const ImageView& view) {
      const Crop crop = {{0.0f, kMiddle}, 64.0f, turned ? 1.5707963f : 0.0f};
      sampler.warp_with_black_border(view, crop, kSamples, picture);
    });
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const std::size_t row = i / 3 / kSamples, column = i / 3 % kSamples;
      const bool outside = turned ? row >= kSamples / 2 : column < kSamples / 2;
      ASSERT_NEAR(picture[i], outside ? -1.0f : 1.0f, 0.01f)
          << "row " << row << ", column " << column << (turned ? " turned" : "");
    }
  }
}

}  // namespace
}  // namespace mien::tracker
