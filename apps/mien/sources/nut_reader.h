// Reads NUT streams as ffmpeg writes them: packets of raw video and audio with timestamps
// (specification: https://ffmpeg.org/nut.html). Metadata of the input cannot change these
// timestamps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/byte_source.h"

namespace mien::app {

struct NutPacket {
  std::size_t stream = 0;
  double time_s = 0.0;
  std::vector<std::byte> data;
};

enum class NutStatus { kOk, kEnd, kDamaged };

class NutReader {
 public:
  // `offset_s` was added to all timestamps (ffmpeg's -output_ts_offset).
  NutReader(formats::ByteSource source, double offset_s) : source_(source), offset_s_(offset_s) {}

  // Reads the next packet and replaces the data of `packet`.
  [[nodiscard]] NutStatus next(NutPacket& packet);

 private:
  struct TimeBase {
    std::int64_t numerator = 0;
    std::int64_t denominator = 0;
  };
  struct Stream {
    TimeBase unit;
    unsigned shift = 0;  // number of bits of an abbreviated timestamp
    std::int64_t last = 0;
  };
  // The fields that the first byte of a frame stands for.
  struct FrameCode {
    std::uint64_t flags = 0;
    std::size_t stream = 0;
    std::uint64_t size_factor = 1;
    std::uint64_t size = 0;
    std::int64_t step = 0;  // difference to the previous timestamp
    std::uint64_t reserved = 0;
    std::uint64_t header = 0;
  };

  bool read(std::span<std::byte> into);
  std::uint8_t byte();
  std::uint64_t number();         // variable length
  std::int64_t signed_number();   // variable length
  std::vector<std::byte> text();  // prefixed by its length
  bool skip(std::uint64_t bytes);

  NutStatus open();
  bool read_header_packet(std::uint8_t first);
  void read_main_header();
  void read_codes();
  void read_stream_header();
  void read_syncpoint();
  bool read_frame(std::uint8_t code, NutPacket& packet);
  bool read_data(std::span<const std::byte> header, std::size_t size, std::vector<std::byte>& data);
  std::int64_t timestamp(const Stream& stream, std::uint64_t coded) const;
  [[nodiscard]] double seconds(const Stream& stream) const;

  formats::ByteSource source_;
  double offset_s_;
  bool opened_ = false;
  bool at_end_ = false;  // the source returned fewer bytes than requested
  bool damaged_ = false;
  std::vector<TimeBase> units_;
  std::vector<Stream> streams_;
  std::vector<std::vector<std::byte>> headers_;  // omitted in frames
  std::array<FrameCode, 256> codes_{};
};

}  // namespace mien::app
