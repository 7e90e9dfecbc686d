// What a WAV file says before its first sample.
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

// Leaves `source` before the first sample. `header` counts on kOk only.
[[nodiscard]] WavFault read_wav_header(CountedSource& source, WavHeader& header);

// What of a fmt chunk has a meaning here, the zeros behind a shorter one included.
inline constexpr std::size_t kWavFormatBytes = 40;

// The body of a fmt chunk of `chunk_bytes`, of which `body` holds the first ones. Offsets are from
// the begin of the body; sets all of `format` but its frames.
[[nodiscard]] WavFault parse_wav_format(std::span<const std::byte, kWavFormatBytes> body,
                                        std::uint32_t chunk_bytes, WavFormat& format);

}  // namespace mien::formats
