// Reads samples and names faults.
#include "formats/wav.h"

#include <algorithm>
#include <array>

#include "formats/wav_header.h"
#include "formats/wav_samples.h"

namespace mien::formats {

const char* message(WavStatus status) {
  switch (status) {
    case WavStatus::kOk:
      return "ok";
    case WavStatus::kEnd:
      return "end of the audio";
    case WavStatus::kBadSignature:
      return "not a RIFF, RF64 or BW64 file";
    case WavStatus::kNotWave:
      return "RIFF form type: unsupported (expected WAVE)";
    case WavStatus::kTruncatedHeader:
      return "truncated inside a chunk before the samples";
    case WavStatus::kBadSizes64:
      return "ds64 chunk: missing or incomplete at the start of an RF64 or BW64 file";
    case WavStatus::kNoFormat:
      return "fmt chunk: missing";
    case WavStatus::kSecondFormat:
      return "fmt chunk: duplicate";
    case WavStatus::kDataBeforeFormat:
      return "data chunk: before the fmt chunk";
    case WavStatus::kNoData:
      return "data chunk: missing";
    case WavStatus::kBadFormatSize:
      return "fmt chunk: too short (expected at least 16 bytes)";
    case WavStatus::kBadExtensionSize:
      return "fmt chunk: too short for the extensible format";
    case WavStatus::kUnsupportedCoding:
      return "format tag: unsupported (expected PCM or IEEE float)";
    case WavStatus::kUnsupportedSubFormat:
      return "sub-format: unsupported (expected PCM or IEEE float)";
    case WavStatus::kBadChannels:
      return "channels: out of range (expected 1 to 8)";
    case WavStatus::kBadRate:
      return "sample rate: out of range (expected 8000 to 192000 Hz)";
    case WavStatus::kBadBits:
      return "bits per sample: unsupported (expected 8, 16, 24 or 32 for PCM, 32 or 64 for IEEE "
             "float)";
    case WavStatus::kBadBlockAlign:
      return "block alignment: wrong (expected the bytes of one sample of each channel)";
    case WavStatus::kBadValidBits:
      return "valid bits: more than bits per sample";
    case WavStatus::kTruncatedData:
      return "truncated inside the data chunk";
    case WavStatus::kPartialFrame:
      return "truncated inside a frame";
    case WavStatus::kBufferTooSmall:
      return "buffer too small for a frame";
  }
  return "unknown status";
}

WavStatus WavReader::open(ByteSource source) {
  *this = WavReader();
  CountedSource counted(source);
  WavHeader header;
  const WavFault fault = read_wav_header(counted, header);
  fault_offset_ = fault.offset;
  if (fault.status == WavStatus::kOk) {
    source_ = counted;
    format_ = header.format;
    data_left_ = header.data_bytes;
    end_ = WavStatus::kOk;
  }
  return fault.status;
}

WavStatus WavReader::read(std::span<float> interleaved, std::size_t& frames_read) {
  frames_read = 0;
  if (end_ != WavStatus::kOk) {
    return end_;
  }
  const std::size_t capacity = interleaved.size() / format_.channels;
  if (capacity == 0) {
    return WavStatus::kBufferTooSmall;
  }
  while (frames_read < capacity && end_ == WavStatus::kOk) {
    const std::size_t first = frames_read * format_.channels;
    frames_read += read_block(interleaved.subspan(first, capacity * format_.channels - first));
  }
  return frames_read > 0 ? WavStatus::kOk : end_;
}

// Reads up to samples.size() samples in complete frames; returns the number of frames.
std::size_t WavReader::read_block(std::span<float> samples) {
  std::array<std::byte, 4096> block;
  const std::size_t frame_bytes = format_.frame_bytes();
  const std::size_t frames =
      std::min(samples.size() / format_.channels, block.size() / frame_bytes);
  const auto asked =
      static_cast<std::size_t>(std::min<std::uint64_t>(frames * frame_bytes, data_left_));
  const std::size_t bytes = source_.read(std::span(block).first(asked));
  const std::size_t whole = bytes / frame_bytes;
  convert_wav_samples(format_, block, samples.first(whole * format_.channels));
  data_left_ -= bytes;
  const std::size_t partial = bytes % frame_bytes;
  if (bytes < asked && format_.frames) {
    end(WavStatus::kTruncatedData, source_.position());
  } else if (partial > 0) {
    end(WavStatus::kPartialFrame, source_.position() - partial);
  } else if (bytes < asked || data_left_ == 0) {
    end(WavStatus::kEnd, source_.position());
  }
  return whole;
}

void WavReader::end(WavStatus status, std::uint64_t offset) {
  end_ = status;
  fault_offset_ = offset;
}

}  // namespace mien::formats
