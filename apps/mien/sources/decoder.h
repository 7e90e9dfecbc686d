// ffmpeg decoding streams of one input: packets with their times.
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
  // `output` tells ffmpeg what to write to its standard output, and how (see `nut_output`).
  // ffmpeg seeks to `seek_s` (0: the start), and its times count from there.
  Decoder(const std::string& input, double seek_s, const std::vector<std::string>& input_options,
          const std::vector<std::string>& output, std::size_t streams);

  // The next packet of a stream, whose time counts from the start of the input. False at the end.
  bool next(std::size_t stream, NutPacket& packet);

  [[nodiscard]] const Damage& damage() const { return damage_; }  // so far

  // Once `next` was false.
  [[nodiscard]] bool failed() const { return failed_; }          // ffmpeg gave up
  [[nodiscard]] bool ended_early() const { return truncated_; }  // the input is not whole

 private:
  static std::size_t read_process(void* context, std::span<std::byte> into) {
    return static_cast<Subprocess*>(context)->read(into);
  }
  void collect_complaints();
  void finish(bool whole);
  void keep(NutPacket& packet);

  std::string input_;
  double seek_s_;
  Subprocess process_;
  NutReader reader_;
  std::vector<std::deque<NutPacket>> waiting_;  // of each stream
  std::size_t waiting_bytes_ = 0;
  std::string log_;  // what is no line yet
  bool ended_ = false;
  bool failed_ = false;
  bool truncated_ = false;
  Damage damage_;
};

// ffmpeg's options for one stream, by its index in the input. All that follow it in a command go
// to the same output.
[[nodiscard]] std::vector<std::string> video_output(int index, const std::string& time_base,
                                                    const std::string& filter);
[[nodiscard]] std::vector<std::string> audio_output(int index, const std::string& filter);
// Behind those: the container.
[[nodiscard]] std::vector<std::string> nut_output();
// Reads a stream and does nothing with it: the times of all streams that are read begin at 0
// together.
[[nodiscard]] std::vector<std::string> clock_output(int index);

}  // namespace mien::app
