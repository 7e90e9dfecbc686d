// Decodes an input to images and audio blocks.
#include "fuzz/views.h"

#include <cstdlib>

namespace mien::fuzz {
namespace {

constexpr std::int32_t kMaxSide = 97;

struct Plane {
  std::int32_t row_bytes, rows;
};

void describe(const mien_image& image, Plane (&planes)[3]) {
  const std::int32_t w = image.width, h = image.height, cw = (w + 1) / 2, ch = (h + 1) / 2;
  constexpr std::int32_t kBytes[] = {1, 3, 3, 4, 4, 1, 1, 1};
  planes[0] = {w * kBytes[image.format], h};
  planes[1] = planes[2] = {0, 0};
  if (image.format == MIEN_IMAGE_NV12 || image.format == MIEN_IMAGE_NV21) {
    planes[1] = {2 * cw, ch};
  } else if (image.format == MIEN_IMAGE_I420) {
    const std::int32_t step =
        image.chroma_pixel_stride_bytes > 1 ? image.chroma_pixel_stride_bytes : 1;
    planes[1] = planes[2] = {(cw - 1) * step + 1, ch};
  }
}

// The memory ends with the last pixel of the last row; if bottom-up, the image starts there.
void place(Bytes& choices, const Plane& plane, int index, std::vector<std::byte>& memory,
           mien_image& image) {
  if (plane.rows == 0) {
    image.planes[index] = choices.coin() ? nullptr : reinterpret_cast<const void*>(0x10);
    image.row_stride_bytes[index] = choices.any_int();
    return;
  }
  const std::int32_t stride = plane.row_bytes + choices.between(0, 9);
  memory.resize(static_cast<std::size_t>(stride * (plane.rows - 1) + plane.row_bytes));
  const std::uint8_t seed = choices.take<std::uint8_t>();
  for (std::size_t i = 0; i < memory.size(); ++i) {
    memory[i] = static_cast<std::byte>(seed + i * (seed | 1u) / 3);
  }
  const bool bottom_up = choices.coin();
  image.planes[index] = memory.data() + (bottom_up ? stride * (plane.rows - 1) : 0);
  image.row_stride_bytes[index] = bottom_up ? -stride : stride;
}

void make_invalid(Bytes& choices, mien_image& image) {
  switch (choices.between(0, 6)) {
    case 0:
      image.format = choices.one_of({-1, 8, 2147483647});
      break;
    case 1:
      image.width = choices.one_of({0, -1, MIEN_MAX_IMAGE_SIDE + 1, -2147483647});
      break;
    case 2:
      image.height = choices.one_of({0, -5, MIEN_MAX_IMAGE_SIDE + 1, 2147483647});
      break;
    case 3:
      image.planes[0] = nullptr;
      break;
    case 4:
      image.rotation = choices.one_of({1, -90, 360, 45, 2147483647});
      break;
    case 5:
      image.struct_size = static_cast<std::uint32_t>(choices.between(0, 40));
      break;
    default:
      image.focal_length_px = choices.one_of({-1.0f, __builtin_nanf(""), __builtin_inff()});
      image.pixel_aspect = choices.one_of({-1.0f, 11.0f, __builtin_nanf("")});
  }
}

}  // namespace

mien_image take_image(Bytes& choices, std::vector<std::byte> (&memory)[3]) {
  mien_image image;
  mien_image_default(&image);
  image.format = choices.between(MIEN_IMAGE_GRAY8, MIEN_IMAGE_I420);
  image.width = choices.between(1, kMaxSide);
  image.height = choices.between(1, kMaxSide);
  image.chroma_pixel_stride_bytes = choices.between(0, 3);
  image.rotation = 90 * choices.between(0, 3);
  image.mirrored = choices.between(0, 1);
  image.full_range = choices.between(0, 1);
  image.focal_length_px = choices.one_of({0.0f, 1e-30f, 100.0f, 3e38f});
  image.principal_x = choices.one_of({0.0f, 50.0f, 3e38f});
  Plane planes[3];
  describe(image, planes);
  for (int i = 0; i < 3; ++i) {
    place(choices, planes[i], i, memory[i], image);
  }
  if (choices.between(0, 7) == 7) {
    make_invalid(choices, image);
  }
  if (choices.coin()) {  // a region, which may exceed the image
    for (std::int32_t& number : image.region) {
      number = choices.between(-1, kMaxSide);
    }
  }
  return image;
}

mien_audio take_audio(Bytes& choices, std::vector<std::byte>& memory) {
  constexpr std::int32_t kRates[] = {8000, 11025, 16000, 44100, 48000, 96000, 192000, 8001, 47999};
  mien_audio audio;
  mien_audio_default(&audio);
  audio.format = choices.between(MIEN_SAMPLES_FLOAT32, MIEN_SAMPLES_INT16);
  audio.sample_rate = choices.one_of(kRates);
  audio.channels = choices.between(1, MIEN_MAX_AUDIO_CHANNELS);
  audio.planar = choices.between(0, 1);
  audio.frames = static_cast<std::size_t>(choices.between(0, 1200));
  const std::size_t sample_bytes = audio.format == MIEN_SAMPLES_INT16 ? 2 : 4;
  const std::size_t channel_bytes = audio.frames * sample_bytes;
  memory.resize(channel_bytes * static_cast<std::size_t>(audio.channels));
  std::uint64_t state = choices.take<std::uint64_t>();
  for (std::byte& byte : memory) {  // any bits: NaNs, infinities, denormal numbers
    state = state * 6364136223846793005u + 1442695040888963407u;
    byte = static_cast<std::byte>(state >> 56);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(audio.channels); ++i) {
    audio.samples[i] = memory.data() + (audio.planar != 0 ? i * channel_bytes : 0);
  }
  switch (choices.between(0, 31)) {
    case 27:
      audio.format = choices.one_of({-1, 2, 2147483647});
      break;
    case 28:
      audio.sample_rate = choices.one_of({0, 7999, 192001, -48000});
      break;
    case 29:
      audio.channels = choices.one_of({0, -1, 9, 2147483647});
      break;
    case 30:
      audio.samples[0] = nullptr;
      break;
    case 31:
      audio.struct_size = static_cast<std::uint32_t>(choices.between(0, 30));
      break;
    default:
      break;
  }
  return audio;
}

}  // namespace mien::fuzz
