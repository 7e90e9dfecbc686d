// Finds the fmt and data chunks.
#include "formats/wav_header.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "formats/little_endian.h"

namespace mien::formats {
namespace {

constexpr std::uint32_t kUnknown32 = 0xffffffff;
// Placeholders of sox (rounded down to whole frames) and arecord when they cannot seek back.
constexpr std::uint32_t kPlaceholders[] = {0x7ffff000, 0x7fffff00};

bool is_placeholder(std::uint64_t bytes, std::size_t frame_bytes) {
  return std::any_of(std::begin(kPlaceholders), std::end(kPlaceholders), [&](std::uint32_t size) {
    return bytes == size || bytes == size - size % frame_bytes;
  });
}

constexpr std::uint32_t id(const char (&name)[5]) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(name[i])) << (8 * i);
  }
  return value;
}

struct Chunk {
  std::uint32_t name = 0;
  std::uint32_t bytes = 0;  // size of the body
  std::uint64_t at = 0;     // offset of the 8-byte chunk header
};

class HeaderReader {
 public:
  HeaderReader(CountedSource& source, WavHeader& header) : source_(source), header_(header) {}

  WavFault run() {
    const WavFault start = read_start();
    return start.status == WavStatus::kOk ? read_chunks() : start;
  }

 private:
  WavFault read_start();
  WavFault read_sizes64();
  WavFault read_chunks();
  WavFault next_chunk(Chunk& chunk);
  WavFault read_format(const Chunk& chunk);
  WavFault begin_data(const Chunk& chunk);

  // Reads the first bytes of a chunk into `body` and skips the others. A body of odd size is
  // followed by a padding byte.
  WavFault read_body(const Chunk& chunk, std::span<std::byte> body) {
    const std::size_t kept = std::min<std::size_t>(chunk.bytes, body.size());
    const std::uint64_t rest = std::uint64_t{chunk.bytes} - kept + chunk.bytes % 2;
    const bool whole = source_.read(body.first(kept)) == kept && source_.skip(rest);
    return whole ? WavFault{} : truncated();
  }

  [[nodiscard]] WavFault truncated() const {
    return {WavStatus::kTruncatedHeader, source_.position()};
  }

  CountedSource& source_;
  WavHeader& header_;
  bool has_format_ = false;  // a fmt chunk was read
  std::uint64_t riff_bytes_ = 0;
  std::uint64_t data_bytes64_ = kUnknownWavBytes;  // the size for 0xFFFFFFFF
};

WavFault HeaderReader::read_start() {
  std::array<std::byte, 12> start{};
  const std::size_t bytes = source_.read(start);
  const auto signature = load_little<std::uint32_t>(start.data());
  const bool wide = signature == id("RF64") || signature == id("BW64");
  if (signature != id("RIFF") && !wide) {
    return {WavStatus::kBadSignature, 0};
  }
  if (bytes < start.size()) {
    return truncated();
  }
  if (load_little<std::uint32_t>(&start[8]) != id("WAVE")) {
    return {WavStatus::kNotWave, 8};
  }
  const auto riff_bytes = load_little<std::uint32_t>(&start[4]);
  riff_bytes_ = riff_bytes == kUnknown32 ? kUnknownWavBytes : riff_bytes;
  return wide ? read_sizes64() : WavFault{};
}

// ds64 holds the sizes of the RIFF chunk, of the data chunk, and of others that are not needed.
WavFault HeaderReader::read_sizes64() {
  constexpr std::uint32_t kSizes64Bytes = 28;
  Chunk chunk;
  const WavFault fault = next_chunk(chunk);
  if (fault.status != WavStatus::kOk) {
    return fault;
  }
  if (chunk.name != id("ds64") || chunk.bytes < kSizes64Bytes) {
    return {WavStatus::kBadSizes64, chunk.at};
  }
  std::array<std::byte, 16> sizes{};
  const WavFault read = read_body(chunk, sizes);
  riff_bytes_ = load_little<std::uint64_t>(&sizes[0]);
  data_bytes64_ = load_little<std::uint64_t>(&sizes[8]);
  return read;
}

WavFault HeaderReader::read_chunks() {
  Chunk chunk;
  WavFault fault = next_chunk(chunk);
  while (fault.status == WavStatus::kOk) {
    if (chunk.name == id("data")) {
      return begin_data(chunk);
    }
    fault = chunk.name == id("fmt ") ? read_format(chunk) : read_body(chunk, {});
    if (fault.status == WavStatus::kOk) {
      fault = next_chunk(chunk);
    }
  }
  return fault;
}

WavFault HeaderReader::next_chunk(Chunk& chunk) {
  std::array<std::byte, 8> start{};
  chunk.at = source_.position();
  const std::size_t bytes = source_.read(start);
  if (bytes == 0) {
    return {has_format_ ? WavStatus::kNoData : WavStatus::kNoFormat, chunk.at};
  }
  chunk.name = load_little<std::uint32_t>(&start[0]);
  chunk.bytes = load_little<std::uint32_t>(&start[4]);
  return bytes == start.size() ? WavFault{} : truncated();
}

WavFault HeaderReader::read_format(const Chunk& chunk) {
  if (has_format_) {
    return {WavStatus::kSecondFormat, chunk.at};
  }
  const std::uint64_t body_at = source_.position();
  std::array<std::byte, kWavFormatBytes> body{};
  const WavFault read = read_body(chunk, body);
  if (read.status != WavStatus::kOk) {
    return read;
  }
  has_format_ = true;
  const WavFault parsed = parse_wav_format(body, chunk.bytes, header_.format);
  return {parsed.status, body_at + parsed.offset};
}

WavFault HeaderReader::begin_data(const Chunk& chunk) {
  if (!has_format_) {
    return {WavStatus::kDataBeforeFormat, chunk.at};
  }
  std::uint64_t bytes = chunk.bytes == kUnknown32 ? data_bytes64_ : chunk.bytes;
  // Writers that cannot seek leave a zero. An empty data chunk is different: other chunks follow it
  // in the RIFF chunk, whose size counts from byte 8.
  const bool goes_on = riff_bytes_ != kUnknownWavBytes && riff_bytes_ > source_.position() - 8;
  if ((bytes == 0 && !goes_on) || is_placeholder(bytes, header_.format.frame_bytes())) {
    bytes = kUnknownWavBytes;
  }
  header_.data_bytes = bytes;
  if (bytes != kUnknownWavBytes) {
    header_.format.frames = bytes / header_.format.frame_bytes();
  }
  return {};
}

}  // namespace

WavFault read_wav_header(CountedSource& source, WavHeader& header) {
  header = {};
  return HeaderReader(source, header).run();
}

}  // namespace mien::formats
