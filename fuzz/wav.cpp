// The bytes are a WAV file. Read frame by frame, it is the same as read at once.
#include "formats/wav.h"

#include <bit>
#include <cstdlib>
#include <vector>

#include "fuzz/target.h"

namespace {

using mien::formats::WavReader;
using mien::formats::WavStatus;

void expect(bool truth) {
  if (!truth) {
    std::abort();
  }
}

struct Heard {
  WavStatus status = WavStatus::kOk;  // the first that is not kOk
  std::uint64_t fault_offset = 0;
  std::vector<std::uint32_t> samples;  // the floats' bits, so that NaNs compare
  bool operator==(const Heard&) const = default;
};

void check_format(const mien::formats::WavFormat& format, WavStatus opened) {
  const std::size_t frame_bytes = format.frame_bytes();
  expect((opened == WavStatus::kOk) == (frame_bytes > 0));
  expect(format.channels <= mien::formats::kMaxWavChannels && frame_bytes <= 64);
}

Heard hear(std::span<const std::byte> file, std::size_t block_frames) {
  std::span<const std::byte> left = file;
  Heard heard;
  WavReader reader;
  heard.status = reader.open(mien::formats::span_source(&left));
  const auto& format = reader.format();
  check_format(format, heard.status);
  std::vector<float> block(format.channels * block_frames);
  while (heard.status == WavStatus::kOk) {
    std::size_t frames = 0;
    heard.status = reader.read(block, frames);
    expect((heard.status == WavStatus::kOk) == (frames > 0) && frames <= block_frames);
    for (const float sample : std::span(block).first(frames * format.channels)) {
      heard.samples.push_back(std::bit_cast<std::uint32_t>(sample));
    }
  }
  heard.fault_offset = reader.fault_offset();
  expect(heard.fault_offset <= file.size() && heard.status != WavStatus::kBufferTooSmall);
  // There is what was declared, if nothing else is said.
  const std::size_t declared =
      format.channels * static_cast<std::size_t>(format.frames.value_or(0));
  const bool as_declared = !format.frames || heard.samples.size() == declared;
  expect(as_declared || heard.status == WavStatus::kTruncatedData);
  return heard;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = std::as_bytes(std::span(data, size));
  expect(hear(file, 1) == hear(file, size + 1));
  return 0;
}
