// The bytes are a WAV file. Reading it frame by frame and at once gives the same samples.
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

struct AudioOutput {
  WavStatus status = WavStatus::kOk;  // the first that is not kOk
  std::uint64_t fault_offset = 0;
  std::vector<std::uint32_t> samples;  // the floats' bits, so that NaNs compare
  bool operator==(const AudioOutput&) const = default;
};

void check_format(const mien::formats::WavFormat& format, WavStatus opened) {
  const std::size_t frame_bytes = format.frame_bytes();
  expect((opened == WavStatus::kOk) == (frame_bytes > 0));
  expect(format.channels <= mien::formats::kMaxWavChannels && frame_bytes <= 64);
}

AudioOutput process(std::span<const std::byte> file, std::size_t block_frames) {
  std::span<const std::byte> left = file;
  AudioOutput output;
  WavReader reader;
  output.status = reader.open(mien::formats::span_source(&left));
  const auto& format = reader.format();
  check_format(format, output.status);
  std::vector<float> block(format.channels * block_frames);
  while (output.status == WavStatus::kOk) {
    std::size_t frames = 0;
    output.status = reader.read(block, frames);
    expect((output.status == WavStatus::kOk) == (frames > 0) && frames <= block_frames);
    for (const float sample : std::span(block).first(frames * format.channels)) {
      output.samples.push_back(std::bit_cast<std::uint32_t>(sample));
    }
  }
  output.fault_offset = reader.fault_offset();
  expect(output.fault_offset <= file.size() && output.status != WavStatus::kBufferTooSmall);
  // The number of samples is the declared one, unless the file is truncated.
  const std::size_t declared =
      format.channels * static_cast<std::size_t>(format.frames.value_or(0));
  const bool as_declared = !format.frames || output.samples.size() == declared;
  expect(as_declared || output.status == WavStatus::kTruncatedData);
  return output;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = std::as_bytes(std::span(data, size));
  expect(process(file, 1) == process(file, size + 1));
  return 0;
}
