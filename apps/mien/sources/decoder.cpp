// Runs ffmpeg as a decoder and collects its packets and errors.
#include "apps/mien/sources/decoder.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "apps/mien/sources/container_end.h"
#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/recording.h"

namespace mien::app {
namespace {

constexpr int kDecodingErrors = 69;  // ffmpeg's exit status with -max_error_rate
constexpr double kOffsetS = 1000.0;  // keeps timestamps positive, because NUT has no negative ones
// Limit for packets of one stream that queue while the decoder reads ahead for another.
constexpr std::size_t kMaxQueuedBytes = std::size_t{1} << 29;

std::vector<std::string> command_of(const std::string& input, double seek_s,
                                    const std::vector<std::string>& input_options,
                                    const std::vector<std::string>& output) {
  std::vector<std::string> command = {"ffmpeg",          "-hide_banner",
                                      "-nostdin",        "-nostats",
                                      "-loglevel",       "repeat+level+error",
                                      "-max_error_rate", "0",
                                      "-max_pixels",     std::to_string(kMaxPixels)};
  const std::vector<std::string> source = input_arguments(input);
  if (seek_s > 0.0) {
    command.insert(command.end(), {"-ss", std::to_string(seek_s)});
  }
  command.insert(command.end(), input_options.begin(), input_options.end());
  command.insert(command.end(), source.begin(), source.end());
  command.insert(command.end(), output.begin(), output.end());
  return command;
}

// Whether a demuxer reports a truncated file.
bool reports_truncation(std::string_view log) {
  constexpr std::array<std::string_view, 2> kWords = {": partial file", "File ended prematurely"};
  return std::any_of(kWords.begin(), kWords.end(), [&](std::string_view words) {
    return log.find(words) != std::string_view::npos;
  });
}

}  // namespace

Decoder::Decoder(const std::string& input, double seek_s,
                 const std::vector<std::string>& input_options,
                 const std::vector<std::string>& output, std::size_t streams)
    : input_(input),
      seek_s_(seek_s),
      process_(command_of(input, seek_s, input_options, output), Subprocess::Pipe::kFromChild,
               timeout_of(input)),
      reader_({&Decoder::read_process, &process_}, kOffsetS),
      queues_(streams) {}

void Decoder::enqueue(NutPacket& packet) {
  if (packet.stream < queues_.size() && queued_bytes_ + packet.data.size() <= kMaxQueuedBytes) {
    queued_bytes_ += packet.data.size();
    queues_[packet.stream].push_back(std::exchange(packet, {}));
  }
}

bool Decoder::next(std::size_t stream, NutPacket& packet) {
  std::deque<NutPacket>& queue = queues_[stream];
  while (queue.empty() && !ended_) {
    const NutStatus status = reader_.next(packet);
    packet.time_s += seek_s_;
    collect_errors();
    if (status != NutStatus::kOk) {
      finish(status == NutStatus::kEnd);
    } else if (packet.stream == stream) {
      return true;
    } else {
      enqueue(packet);
    }
  }
  if (queue.empty()) {
    return false;
  }
  packet = std::move(queue.front());
  queue.pop_front();
  queued_bytes_ -= packet.data.size();
  return true;
}

// Counts errors line by line. Their number is unbounded, so only the last is kept.
void Decoder::collect_errors() {
  log_ += process_.take_errors();
  std::size_t begin = 0;
  for (std::size_t end = log_.find('\n'); end != std::string::npos; end = log_.find('\n', begin)) {
    damage_.last = log_.substr(begin, end - begin);
    ++damage_.complaints;
    truncated_ = truncated_ || reports_truncation(damage_.last);
    begin = end + 1;
  }
  log_.erase(0, begin);
}

void Decoder::finish(bool whole) {
  ended_ = true;
  const int status = process_.finish();
  log_ += process_.take_errors() + "\n";  // the last line may not end with a newline
  std::erase_if(log_, [](char c) { return c == '\r'; });
  while (log_.ends_with("\n\n")) {
    log_.pop_back();
  }
  if (log_ == "\n") {
    log_.clear();
  }
  collect_errors();
  failed_ = !whole || (status != 0 && status != kDecodingErrors);
  truncated_ = truncated_ || (!is_url(input_) && ends_early(input_));
  damage_.frames_lost = status == kDecodingErrors;
}

std::vector<std::string> video_output(int index, const std::string& time_base,
                                      const std::string& filter) {
  std::vector<std::string> options = {"-map",      "0:" + std::to_string(index),
                                      "-vsync",    "passthrough",
                                      "-filter:v", filter,
                                      "-c:v",      "rawvideo",
                                      "-pix_fmt",  "rgb24"};
  if (!time_base.empty()) {  // otherwise ffmpeg rounds timestamps to a constant frame rate
    options.insert(options.end(), {"-enc_time_base:v", time_base});
  }
  return options;
}

// Fills gaps with silence.
std::vector<std::string> audio_output(int index, const std::string& filter) {
  return {"-map",      "0:" + std::to_string(index),
          "-filter:a", filter + "aresample=async=1",
          "-ac",       "1",
          "-ar",       "16000",
          "-c:a",      "pcm_s16le"};
}

std::vector<std::string> nut_output() {
  return {"-output_ts_offset", std::to_string(kOffsetS), "-flush_packets", "1", "-f", "nut", "-"};
}

std::vector<std::string> clock_output(int index) {
  return {"-map", "0:" + std::to_string(index), "-c", "copy", "-f", "null", "-"};
}

}  // namespace mien::app
