// Reads audio from WAV streams: PCM of 8, 16, 24 and 32 bits, IEEE float of 32 and 64 bits.
//
// Formats: RIFF WAVE (IBM, Microsoft: Multimedia Programming Interface and Data Specifications 1.0,
// 1991); WAVE_FORMAT_EXTENSIBLE (Microsoft: Multiple Channel Audio Data and WAVE Files, 2001,
// revised 2007); sizes above 4 GiB as in RF64 (EBU Tech 3306) and BW64 (ITU-R BS.2088).
//
// Deviations of real files (docs/wav.md has more):
// * Chunks other than `fmt ` and `data` are skipped. Reading stops at the end of the first data
//   chunk; the bytes after it stay in the source.
// * A data chunk of unknown size, as written to pipes, lasts to the end of the source: its size is
//   0xFFFFFFFF, a placeholder of sox or arecord, or 0 if the RIFF chunk does not continue after it.
// * Otherwise the size of the RIFF chunk is ignored, as are bytes per second, the channel mask, and
//   the number of valid bits of a sample (its upper ones).
//
//   WavReader reader;
//   WavStatus status = reader.open(file_source(file));
//   std::array<float, 4096> samples;
//   std::size_t frames = 0;
//   while (status == WavStatus::kOk && (status = reader.read(samples, frames)) == WavStatus::kOk) {
//     use(std::span(samples).first(frames * reader.format().channels));
//   }
//   if (status != WavStatus::kEnd) {
//     report(message(status), reader.fault_offset());
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "formats/byte_source.h"
#include "formats/counted_source.h"

namespace mien::formats {

enum class WavStatus : std::uint8_t {
  kOk = 0,
  kEnd = 1,  // no more frames, not an error
  // the file
  kBadSignature = 2,
  kNotWave = 3,
  kTruncatedHeader = 4,
  kBadSizes64 = 5,
  kNoFormat = 6,
  kSecondFormat = 7,
  kDataBeforeFormat = 8,
  kNoData = 9,
  // the fmt chunk
  kBadFormatSize = 10,
  kBadExtensionSize = 11,
  kUnsupportedCoding = 12,
  kUnsupportedSubFormat = 13,
  kBadChannels = 14,
  kBadRate = 15,
  kBadBits = 16,
  kBadBlockAlign = 17,
  kBadValidBits = 18,
  // while reading; complete frames before the fault were returned
  kTruncatedData = 19,
  kPartialFrame = 20,
  kBufferTooSmall = 21,
};
inline constexpr std::uint8_t kWavStatusCount = 22;

// A static string of one line.
[[nodiscard]] const char* message(WavStatus status);

inline constexpr std::uint32_t kMaxWavChannels = 8;
inline constexpr std::uint32_t kMinWavRate = 8000;    // frames per second
inline constexpr std::uint32_t kMaxWavRate = 192000;  // frames per second

enum class WavCoding : std::uint8_t { kPcm, kFloat };

struct WavFormat {
  std::uint32_t sample_rate = 0;  // frames per second, kMinWavRate..kMaxWavRate
  std::uint32_t channels = 0;     // 1..kMaxWavChannels
  std::uint32_t bits = 0;         // per stored sample; kPcm: 8, 16, 24, 32; kFloat: 32, 64
  WavCoding coding = WavCoding::kPcm;
  std::optional<std::uint64_t> frames;  // as declared; empty if unknown

  [[nodiscard]] std::size_t frame_bytes() const { return std::size_t{channels} * bits / 8; }
};

class WavReader {
 public:
  // Reads up to the first sample. On failure, the format is all zeros and there are no frames.
  [[nodiscard]] WavStatus open(ByteSource source);

  [[nodiscard]] const WavFormat& format() const { return format_; }

  // Reads as many complete frames as fit into `interleaved`, [frames][channels]; fewer only before
  // the end. Returns kOk if `frames_read` is at least one. At the end it returns kEnd,
  // kTruncatedData or kPartialFrame with `frames_read` 0, on every further call.
  //
  // Full scale is -1..1: unsigned 8 bits become (x - 128) / 128, other PCM of n bits x / 2^(n-1),
  // fp32 is copied bit by bit. All conversions are exact, except that 32-bit PCM and fp64 are
  // rounded to nearest (the largest 32-bit sample to 1, fp64 beyond fp32 to infinity). Floats
  // beyond full scale, infinities and NaN are passed through; the caller must handle them.
  [[nodiscard]] WavStatus read(std::span<float> interleaved, std::size_t& frames_read);

  // Position of the last fault of open() or read(), in bytes from the start of the source: the
  // field, the chunk, the partial frame, or the end. kBufferTooSmall has no position.
  [[nodiscard]] std::uint64_t fault_offset() const { return fault_offset_; }

 private:
  [[nodiscard]] std::size_t read_block(std::span<float> samples);
  void end(WavStatus status, std::uint64_t offset);

  CountedSource source_;
  WavFormat format_;
  std::uint64_t data_left_ = 0;      // bytes
  WavStatus end_ = WavStatus::kEnd;  // kOk while there may be frames
  std::uint64_t fault_offset_ = 0;
};

}  // namespace mien::formats
