// Valid and invalid WAV files for tests, and the result of reading them.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/wav.h"

namespace mien::formats {

std::string little(std::uint64_t value, std::size_t bytes);

// Name, size and body, with a padding byte after an odd size.
std::string wav_chunk(std::string_view name, std::string_view body);

// The body of a fmt chunk as fields, which tests may change.
struct FmtFields {
  std::uint16_t tag = 1;
  std::uint16_t channels = 1;
  std::uint32_t rate = 16000;
  std::uint16_t bits = 16;
  std::optional<std::uint16_t> block_align;  // default: channels * bits / 8
  // WAVE_FORMAT_EXTENSIBLE, if it has a sub-format
  std::optional<std::uint16_t> sub_format;
  std::optional<std::uint16_t> valid_bits;  // default: bits
  std::uint16_t extension_bytes = 22;
  std::string guid_rest{"\x00\x00\x00\x00\x10\x00\x80\x00\x00\xaa\x00\x38\x9b\x71", 14};
};
std::string fmt_body(const FmtFields& fields);

// A RIFF header with the correct size around these chunks.
std::string riff(std::initializer_list<std::string_view> chunks);

// RIFF header, fmt chunk, data chunk.
std::string simple(const FmtFields& fields, std::string_view data);

// RF64 header, ds64 chunk with these sizes, chunks.
std::string rf64(std::uint64_t riff_bytes, std::uint64_t data_bytes, std::string_view chunks);

struct Decoded {
  WavStatus opened = WavStatus::kOk;
  WavStatus ended = WavStatus::kOk;  // the first status of read() that is not kOk
  std::uint64_t fault_offset = 0;
  WavFormat format;
  std::vector<std::uint32_t> samples;  // the bits of the floats, so that NaNs compare equal
};

// Reads everything in blocks of `block_frames` frames, and checks properties of all files.
Decoded decode(const std::string& file, const std::function<std::size_t()>& block_frames);
Decoded decode(const std::string& file);

// Expects that opening the file fails for this reason.
void expect_refused(const std::string& file, WavStatus status, std::uint64_t offset);

std::vector<std::uint32_t> bits_of(const std::vector<float>& samples);

}  // namespace mien::formats
