// Parses the part of a WAV file before its first sample.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/counted_source.h"
#include "formats/wav.h"

namespace mien::formats {

inline constexpr std::uint64_t kUnknownWavBytes = UINT64_MAX;

struct WavHeader {
  WavFormat format;
  std::uint64_t data_bytes = 0;  // of the data chunk, or kUnknownWavBytes
};

struct WavFault {
  WavStatus status = WavStatus::kOk;
  std::uint64_t offset = 0;  // bytes, see WavReader::fault_offset
};

// Leaves `source` at the first sample. `header` is only valid on kOk.
[[nodiscard]] WavFault read_wav_header(CountedSource& source, WavHeader& header);

// Relevant bytes of a fmt chunk; a shorter chunk is padded with zeros.
inline constexpr std::size_t kWavFormatBytes = 40;

// Parses a fmt chunk of `chunk_bytes`, whose first bytes are in `body`. Offsets count from the
// start of the body. Sets all of `format` except `frames`.
[[nodiscard]] WavFault parse_wav_format(std::span<const std::byte, kWavFormatBytes> body,
                                        std::uint32_t chunk_bytes, WavFormat& format);

}  // namespace mien::formats
