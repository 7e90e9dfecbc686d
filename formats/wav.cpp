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
      return "end of the sound";
    case WavStatus::kBadSignature:
      return "not a RIFF, RF64 or BW64 file";
    case WavStatus::kNotWave:
      return "a RIFF file, but not of sound (WAVE)";
    case WavStatus::kTruncatedHeader:
      return "the file ends inside a chunk before the samples";
    case WavStatus::kBadSizes64:
      return "an RF64 or BW64 file without a whole ds64 chunk at its begin";
    case WavStatus::kNoFormat:
      return "the file has no fmt chunk";
    case WavStatus::kSecondFormat:
      return "a second fmt chunk";
    case WavStatus::kDataBeforeFormat:
      return "the data chunk comes before the fmt chunk";
    case WavStatus::kNoData:
      return "the file has no data chunk";
    case WavStatus::kBadFormatSize:
      return "the fmt chunk is shorter than 16 bytes";
    case WavStatus::kBadExtensionSize:
      return "the fmt chunk is too short for the extensible format";
    case WavStatus::kUnsupportedCoding:
      return "the samples are neither PCM nor IEEE float";
    case WavStatus::kUnsupportedSubFormat:
      return "the sub-format is neither PCM nor IEEE float";
    case WavStatus::kBadChannels:
      return "the number of channels is not 1..8";
    case WavStatus::kBadRate:
      return "the sample rate is not 8000..192000 Hz";
    case WavStatus::kBadBits:
      return "the bits of a sample are not 8, 16, 24 or 32 (PCM), 32 or 64 (IEEE float)";
    case WavStatus::kBadBlockAlign:
      return "the block alignment is not the bytes of one sample of each channel";
    case WavStatus::kBadValidBits:
      return "more valid bits than a sample has";
    case WavStatus::kTruncatedData:
      return "the file ends before its data chunk does";
    case WavStatus::kPartialFrame:
      return "the samples end inside a frame";
    case WavStatus::kBufferTooSmall:
      return "the buffer is smaller than a frame";
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
  const std::size_t room = interleaved.size() / format_.channels;
  if (room == 0) {
    return WavStatus::kBufferTooSmall;
  }
  while (frames_read < room && end_ == WavStatus::kOk) {
    const std::size_t first = frames_read * format_.channels;
    frames_read += read_block(interleaved.subspan(first, room * format_.channels - first));
  }
  return frames_read > 0 ? WavStatus::kOk : end_;
}

// The frames that `samples` asks for, or the first ones of them, or all that are left: how many.
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
