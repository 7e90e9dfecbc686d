// Reads NUT streams. Every size and index of the stream is checked, and memory is limited.
#include "apps/mien/sources/nut_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string_view>

namespace mien::app {
namespace {

constexpr std::string_view kSignature{"nut/multimedia container\0", 25};

// Start codes of packets that are not frames. All begin with 'N'.
constexpr std::uint64_t kMainHeader = 0x4E4D7A561F5F04ADu;
constexpr std::uint64_t kStreamHeader = 0x4E5311405BF2F9DBu;
constexpr std::uint64_t kSyncpoint = 0x4E4BE4ADEECA4569u;

enum Flag : std::uint64_t {
  kCodedTimestamp = 1u << 3,
  kStreamNumber = 1u << 4,
  kSizeHigh = 1u << 5,
  kChecksum = 1u << 6,
  kReserved = 1u << 7,
  kSideData = 1u << 8,
  kHeaderNumber = 1u << 10,
  kMatchTime = 1u << 11,
  kCodedFlags = 1u << 12,
  kInvalid = 1u << 13,
};

constexpr std::uint64_t kMaxHeaderBytes = 1u << 20;  // bytes; ffmpeg's have some hundreds
constexpr std::uint64_t kMaxFrameBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxStreams = 16;
constexpr std::int64_t kMaxTimestamp = std::int64_t{1} << 61;

bool fits(std::int64_t value) { return value > 0 && value <= INT32_MAX; }

// value * factor / divisor, rounded down.
std::int64_t scaled(std::int64_t value, std::int64_t factor, std::int64_t divisor) {
  std::int64_t whole = value / divisor, rest = value % divisor;
  if (rest < 0) {
    --whole;
    rest += divisor;
  }
  return whole * factor + rest * factor / divisor;
}

}  // namespace

bool NutReader::read(std::span<std::byte> into) {
  if (!at_end_ && source_.read(source_.context, into) < into.size()) {
    at_end_ = true;
  }
  return !at_end_;
}

std::uint8_t NutReader::byte() {
  std::byte value{};
  return read({&value, 1}) ? static_cast<std::uint8_t>(value) : std::uint8_t{0};
}

std::uint64_t NutReader::number() {
  constexpr int kMaxBytes = 9;
  std::uint64_t value = 0;
  for (int i = 0; i < kMaxBytes; ++i) {
    const std::uint8_t next = byte();
    value = value << 7 | (next & 0x7Fu);
    if ((next & 0x80u) == 0) {
      return value;
    }
  }
  damaged_ = true;
  return 0;
}

std::int64_t NutReader::signed_number() {
  const std::uint64_t coded = number() + 1;
  const auto half = static_cast<std::int64_t>(coded >> 1);
  return (coded & 1) != 0 ? -half : half;
}

std::vector<std::byte> NutReader::text() {
  const std::uint64_t length = number();
  damaged_ = damaged_ || length > kMaxHeaderBytes;
  std::vector<std::byte> bytes(damaged_ ? 0 : static_cast<std::size_t>(length));
  read(bytes);
  return bytes;
}

bool NutReader::skip(std::uint64_t bytes) {
  if (bytes > kMaxHeaderBytes) {
    damaged_ = true;
    return false;
  }
  std::vector<std::byte> passed(static_cast<std::size_t>(bytes));
  return read(passed);
}

NutStatus NutReader::open() {
  std::array<std::byte, kSignature.size()> signature{};
  if (!read(signature)) {
    return NutStatus::kEnd;
  }
  const auto same = [](char a, std::byte b) { return static_cast<std::byte>(a) == b; };
  opened_ = std::equal(kSignature.begin(), kSignature.end(), signature.begin(), same);
  return opened_ ? NutStatus::kOk : NutStatus::kDamaged;
}

NutStatus NutReader::next(NutPacket& packet) {
  if (!opened_) {
    if (const NutStatus status = open(); status != NutStatus::kOk) {
      return status;
    }
  }
  while (!damaged_) {
    const std::uint8_t first = byte();
    if (at_end_) {
      return NutStatus::kEnd;
    }
    const bool frame = first != 'N';
    if (frame ? read_frame(first, packet) : read_header_packet(first)) {
      if (frame) {
        return NutStatus::kOk;
      }
    } else {
      damaged_ = true;
    }
  }
  return NutStatus::kDamaged;
}

bool NutReader::read_header_packet(std::uint8_t first) {
  constexpr std::uint64_t kLongPacket = 4096;  // longer packets have a checksum after their length
  constexpr std::uint64_t kChecksumBytes = 4;
  std::uint64_t kind = first;
  for (int i = 0; i < 7; ++i) {
    kind = kind << 8 | byte();
  }
  const std::uint64_t length = number();
  if (length < kChecksumBytes || length > kMaxHeaderBytes ||
      (length > kLongPacket && !skip(kChecksumBytes))) {
    return false;
  }
  std::vector<std::byte> payload(static_cast<std::size_t>(length));
  if (!read(payload)) {
    return false;
  }
  std::span<const std::byte> remaining(payload);
  const formats::ByteSource outer = source_;
  source_ = formats::span_source(&remaining);
  if (kind == kMainHeader) {
    read_main_header();
  } else if (kind == kStreamHeader) {
    read_stream_header();
  } else if (kind == kSyncpoint) {
    read_syncpoint();
  }
  source_ = outer;
  return !at_end_ && !damaged_;
}

void NutReader::read_main_header() {
  const std::uint64_t version = number();
  if (version > 3) {
    number();  // minor version
  }
  const std::uint64_t streams = number();
  number();  // largest distance of syncpoints
  const std::uint64_t units = number();
  if (streams > kMaxStreams || units == 0 || units > kMaxStreams) {
    damaged_ = true;
    return;
  }
  streams_.assign(static_cast<std::size_t>(streams), {});
  units_.clear();
  for (std::uint64_t i = 0; i < units; ++i) {
    TimeBase unit;
    unit.numerator = static_cast<std::int64_t>(number());
    unit.denominator = static_cast<std::int64_t>(number());
    damaged_ = damaged_ || !fits(unit.numerator) || !fits(unit.denominator);
    units_.push_back(unit);
  }
  read_codes();
  const std::uint64_t headers = number();
  headers_.assign(1, {});
  for (std::uint64_t i = 0; i < headers && !at_end_ && !damaged_; ++i) {
    headers_.push_back(text());
  }
}

// The table of frame codes consists of runs. A run repeats the fields of the previous one that it
// does not change.
void NutReader::read_codes() {
  FrameCode run;
  for (std::size_t i = 0; i < codes_.size() && !at_end_ && !damaged_;) {
    run.flags = number();
    const std::uint64_t fields = number();
    run.step = fields > 0 ? signed_number() : run.step;
    run.size_factor = fields > 1 ? number() : run.size_factor;
    run.stream = fields > 2 ? static_cast<std::size_t>(number()) : run.stream;
    run.size = fields > 3 ? number() : 0;
    run.reserved = fields > 4 ? number() : 0;
    damaged_ = damaged_ || run.size > run.size_factor;
    std::uint64_t count = fields > 5 ? number() : damaged_ ? 0 : run.size_factor - run.size;
    if (fields > 6) {
      signed_number();  // match time, unused
    }
    run.header = fields > 7 ? number() : run.header;
    for (std::uint64_t j = 8; j < fields && !at_end_; ++j) {
      number();
    }
    for (; count > 0 && i < codes_.size(); ++i) {
      codes_[i] = run;
      if (i == 'N') {
        codes_[i].flags = kInvalid;
      } else {
        ++run.size;
        --count;
      }
    }
  }
}

void NutReader::read_stream_header() {
  const std::uint64_t stream = number();
  number();  // class
  text();    // codec
  const std::uint64_t unit = number();
  const std::uint64_t shift = number();
  if (stream >= streams_.size() || unit >= units_.size() || shift >= 16) {
    damaged_ = true;
    return;
  }
  streams_[static_cast<std::size_t>(stream)] = {units_[static_cast<std::size_t>(unit)],
                                                static_cast<unsigned>(shift), 0};
}

void NutReader::read_syncpoint() {
  const std::uint64_t coded = number();
  if (units_.empty()) {
    damaged_ = true;
    return;
  }
  const TimeBase from = units_[static_cast<std::size_t>(coded % units_.size())];
  const auto time = static_cast<std::int64_t>(coded / units_.size());
  for (Stream& stream : streams_) {
    std::int64_t factor = from.numerator * stream.unit.denominator;
    std::int64_t divisor = from.denominator * stream.unit.numerator;
    const std::int64_t common = std::max<std::int64_t>(1, std::gcd(factor, divisor));
    factor /= common;
    divisor /= common;
    if (!fits(factor) || !fits(divisor) || time / divisor > INT64_MAX / 2 / factor) {
      damaged_ = true;
      return;
    }
    stream.last = scaled(time, factor, divisor);
  }
}

std::int64_t NutReader::timestamp(const Stream& stream, std::uint64_t coded) const {
  const std::int64_t wrap = std::int64_t{1} << stream.shift;
  const auto value = static_cast<std::int64_t>(coded);
  if (value >= wrap) {
    return value - wrap;
  }
  const std::int64_t lowest = stream.last - (wrap - 1) / 2;
  return lowest + ((value - lowest) & (wrap - 1));
}

double NutReader::seconds(const Stream& stream) const {
  const auto numerator = static_cast<double>(stream.unit.numerator);
  const auto denominator = static_cast<double>(stream.unit.denominator);
  const std::int64_t offset = std::llround(offset_s_ * denominator / numerator);
  return static_cast<double>(stream.last - offset) * numerator / denominator;
}

bool NutReader::read_frame(std::uint8_t code, NutPacket& packet) {
  constexpr std::uint64_t kMaxBytesWithHeader = 4096;
  FrameCode frame = codes_[code];
  if ((frame.flags & kInvalid) != 0) {
    return false;
  }
  if ((frame.flags & kCodedFlags) != 0) {
    frame.flags ^= number();
  }
  frame.stream =
      (frame.flags & kStreamNumber) != 0 ? static_cast<std::size_t>(number()) : frame.stream;
  if (frame.stream >= streams_.size() || streams_[frame.stream].unit.denominator == 0) {
    return false;
  }
  Stream& stream = streams_[frame.stream];
  if (std::abs(stream.last) > kMaxTimestamp || std::abs(frame.step) > kMaxTimestamp) {
    return false;
  }
  stream.last =
      (frame.flags & kCodedTimestamp) != 0 ? timestamp(stream, number()) : stream.last + frame.step;
  const std::uint64_t high = (frame.flags & kSizeHigh) != 0 ? number() : 0;
  if ((frame.flags & kMatchTime) != 0) {
    signed_number();
  }
  const std::uint64_t header_number = (frame.flags & kHeaderNumber) != 0 ? number() : frame.header;
  std::uint64_t reserved = (frame.flags & kReserved) != 0 ? number() : frame.reserved;
  for (; reserved > 0 && !at_end_; --reserved) {
    number();
  }
  if ((frame.flags & kChecksum) != 0) {
    skip(4);
  }
  if (std::max({high, frame.size_factor, frame.size}) > kMaxFrameBytes) {
    return false;
  }
  const std::uint64_t size = frame.size + frame.size_factor * high;
  const std::uint64_t used = size > kMaxBytesWithHeader ? 0 : header_number;
  if (size > kMaxFrameBytes || used >= headers_.size() || (frame.flags & kSideData) != 0) {
    return false;
  }
  const std::vector<std::byte>& header = headers_[static_cast<std::size_t>(used)];
  if (header.size() > size || at_end_ || damaged_) {
    return false;
  }
  packet.stream = frame.stream;
  packet.time_s = seconds(stream);
  return read_data(header, static_cast<std::size_t>(size), packet.data);
}

// Reads in parts, so that a wrong size allocates no more memory than there is data.
bool NutReader::read_data(std::span<const std::byte> header, std::size_t size,
                          std::vector<std::byte>& data) {
  constexpr std::size_t kPart = std::size_t{1} << 24;
  data.assign(header.begin(), header.end());
  while (data.size() < size) {
    const std::size_t done = data.size();
    data.resize(std::min(size, done + kPart));
    if (!read(std::span(data).subspan(done))) {
      return false;
    }
  }
  return true;
}

}  // namespace mien::app
