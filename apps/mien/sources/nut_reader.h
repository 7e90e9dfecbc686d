// NUT streams as ffmpeg writes them: packets of raw video and audio with their timestamps
// (libavformat's nut; specification: https://ffmpeg.org/nut.html). No metadata of an input can
// change a timestamp in it.
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

  // Reads up to the next packet, whose data replaces that of `packet`.
  [[nodiscard]] NutStatus next(NutPacket& packet);

 private:
  struct TimeBase {
    std::int64_t numerator = 0;
    std::int64_t denominator = 0;
  };
  struct Stream {
    TimeBase unit;
    unsigned shift = 0;  // bits of a timestamp that is not written in full
    std::int64_t last = 0;
  };
  // What a frame's first byte stands for.
  struct FrameCode {
    std::uint64_t flags = 0;
    std::size_t stream = 0;
    std::uint64_t size_factor = 1;
    std::uint64_t size = 0;
    std::int64_t step = 0;  // from the timestamp before
    std::uint64_t reserved = 0;
    std::uint64_t header = 0;
  };

  bool read(std::span<std::byte> into);
  std::uint8_t byte();
  std::uint64_t number();         // variable length
  std::int64_t signed_number();   // variable length
  std::vector<std::byte> text();  // with its length before it
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
  bool at_end_ = false;  // fewer bytes came than were asked for
  bool damaged_ = false;
  std::vector<TimeBase> units_;
  std::vector<Stream> streams_;
  std::vector<std::vector<std::byte>> headers_;  // that frames leave out
  std::array<FrameCode, 256> codes_{};
};

}  // namespace mien::app
