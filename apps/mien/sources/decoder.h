// Decodes streams of one input with ffmpeg, into packets with timestamps.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "apps/mien/sources/nut_reader.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {

class Decoder {
 public:
  // `output`: ffmpeg's options for its standard output (see `nut_output`). ffmpeg seeks to `seek_s`
  // (0: the start), and its timestamps count from there.
  Decoder(const std::string& input, double seek_s, const std::vector<std::string>& input_options,
          const std::vector<std::string>& output, std::size_t streams);

  // Reads the next packet of a stream, with a timestamp relative to the start of the input. Returns
  // false at the end.
  bool next(std::size_t stream, NutPacket& packet);

  [[nodiscard]] const Damage& damage() const { return damage_; }  // until now

  // Valid after `next` returned false.
  [[nodiscard]] bool failed() const { return failed_; }          // ffmpeg failed
  [[nodiscard]] bool ended_early() const { return truncated_; }  // the input is truncated

 private:
  static std::size_t read_process(void* context, std::span<std::byte> into) {
    return static_cast<Subprocess*>(context)->read(into);
  }
  void collect_errors();
  void finish(bool whole);
  void enqueue(NutPacket& packet);

  std::string input_;
  double seek_s_;
  Subprocess process_;
  NutReader reader_;
  std::vector<std::deque<NutPacket>> queues_;  // packets read ahead, per stream
  std::size_t queued_bytes_ = 0;
  std::string log_;  // the incomplete last line of ffmpeg's messages
  bool ended_ = false;
  bool failed_ = false;
  bool truncated_ = false;
  Damage damage_;
};

// ffmpeg's options for one stream, given by its index in the input. The stream goes to the output
// whose options follow.
[[nodiscard]] std::vector<std::string> video_output(int index, const std::string& time_base,
                                                    const std::string& filter);
[[nodiscard]] std::vector<std::string> audio_output(int index, const std::string& filter);
// Options of the container. They follow the streams.
[[nodiscard]] std::vector<std::string> nut_output();
// Reads a stream and discards it. The timestamps of all streams that ffmpeg reads start at 0
// together, so every process must read the same streams.
[[nodiscard]] std::vector<std::string> clock_output(int index);

}  // namespace mien::app
