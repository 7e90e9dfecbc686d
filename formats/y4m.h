// Reads uncompressed 8-bit YUV4MPEG2 video from a stream (format: yuv4mpeg(5) of MJPEG tools).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/byte_source.h"

namespace mien::formats {

enum class Y4mStatus : std::uint8_t {
  kOk = 0,
  kEnd = 1,  // no more frames, not an error
  kBadSignature = 2,
  kHeaderTooLong = 3,
  kTruncatedHeader = 4,
  kBadSize = 5,
  kBadRate = 6,
  kUnsupportedColour = 7,
  kBadParameter = 8,
  kBadFrameHeader = 9,
  kTruncatedFrame = 10,
  kBufferTooSmall = 11,
};
inline constexpr std::uint8_t kY4mStatusCount = 12;

const char* message(Y4mStatus status);

enum class Y4mColour : std::uint8_t { kMono, k420, k422, k444 };

inline constexpr std::uint32_t kMaxVideoSide = 16384;    // pixels
inline constexpr std::size_t kMaxY4mHeaderBytes = 1024;  // line of a stream or frame header

struct Y4mHeader {
  std::uint32_t width = 0;     // pixels, 1..kMaxVideoSide
  std::uint32_t height = 0;    // pixels, 1..kMaxVideoSide
  std::uint32_t rate_num = 0;  // frames per second = rate_num / rate_den, both above zero
  std::uint32_t rate_den = 0;
  Y4mColour colour = Y4mColour::k420;
  bool full_range = false;  // `XCOLORRANGE=FULL`; else 16..235
  // Aspect ratio of a pixel, width to height; 0 if unspecified.
  std::uint32_t aspect_num = 0;
  std::uint32_t aspect_den = 0;

  double pixel_aspect() const;          // 0.1..10; 1 if unknown or outside this range
  std::uint32_t chroma_width() const;   // 0 for kMono; odd widths round up
  std::uint32_t chroma_height() const;  // 0 for kMono; odd heights round up
  std::size_t frame_bytes() const;      // planes Y, U, V in sequence, without padding
};

class Y4mReader {
 public:
  // Reads the stream header. On failure, the header is all zeros and there are no frames.
  [[nodiscard]] Y4mStatus open(ByteSource source);
  const Y4mHeader& header() const { return header_; }
  // Reads the next frame to the first header().frame_bytes() bytes of `frame`.
  [[nodiscard]] Y4mStatus read_frame(std::span<std::byte> frame);

 private:
  ByteSource source_{};
  Y4mHeader header_;
};

}  // namespace mien::formats
