#include "apps/mien/sources/sound_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/subprocess.h"
#include "formats/wav.h"

namespace mien::app {
namespace {

using formats::WavFormat;
using formats::WavReader;
using formats::WavStatus;

constexpr std::size_t kBlockFrames = 1024;
// The middle of AudioNet's windows is heard 42 ms late.
constexpr std::int64_t kAheadNs = 100'000'000;

// The part of a WAV stream that is asked for.
class WavSound : public SoundSource {
 public:
  // `from_s`: what the time of the stream's first sample is.
  WavSound(std::string name, formats::ByteSource bytes, const VideoRange& range, double from_s)
      : name_(std::move(name)), from_s_(from_s) {
    const WavStatus status = reader_.open(bytes);
    if (status != WavStatus::kOk) {
      fail(kExitNoSound, "no sound that can be read", status);
    }
    const WavFormat& format = reader_.format();
    samples_.resize(kBlockFrames * format.channels);
    const auto frames_in = [&](double seconds) {
      return static_cast<std::int64_t>(std::llround(seconds * format.sample_rate));
    };
    skip_ = frames_in(range.start_s - from_s);
    last_ = range.duration_s ? skip_ + frames_in(*range.duration_s)
                             : std::numeric_limits<std::int64_t>::max();
  }

  bool next(Audio& block, std::int64_t& pts_ns) override {
    std::size_t frames = 0;
    do {
      if (frames_ >= last_ || !read(frames)) {
        return false;
      }
      frames_ += static_cast<std::int64_t>(frames);
    } while (frames_ <= skip_);
    const WavFormat& format = reader_.format();
    block = Audio();
    block.sample_rate = static_cast<std::int32_t>(format.sample_rate);
    block.channels = static_cast<std::int32_t>(format.channels);
    const std::int64_t first = frames_ - static_cast<std::int64_t>(frames);
    const std::int64_t skipped = std::max<std::int64_t>(skip_ - first, 0);
    block.frames = static_cast<std::size_t>(std::min(frames_, last_) - first - skipped);
    block.samples[0] = samples_.data() + static_cast<std::size_t>(skipped) * format.channels;
    const double seconds = static_cast<double>(first + skipped) / format.sample_rate;
    pts_ns = std::llround((from_s_ + seconds) * 1e9);
    return true;
  }

 protected:
  // What is to be said when the stream ends.
  virtual void at_end() {}

 private:
  bool read(std::size_t& frames) {
    const WavStatus status = reader_.read(samples_, frames);
    if (status == WavStatus::kOk) {
      return true;
    }
    if (status != WavStatus::kEnd) {
      const double seconds = static_cast<double>(frames_) / reader_.format().sample_rate;
      fail(kExitTruncated, "sound damaged after " + std::to_string(seconds) + " s", status);
    }
    at_end();
    return false;
  }

  [[noreturn]] void fail(ExitCode code, const std::string& what, WavStatus status) const {
    throw Failure(code, name_ + ": " + what + ": " + formats::message(status) + ", at byte " +
                            std::to_string(reader_.fault_offset()));
  }

  std::string name_;
  double from_s_;
  WavReader reader_;
  std::vector<float> samples_;
  std::int64_t frames_ = 0;  // read
  std::int64_t skip_ = 0;
  std::int64_t last_ = 0;
};

struct CloseFile {
  void operator()(std::FILE* file) const {
    if (file != stdin) {
      std::fclose(file);
    }
  }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File open_file(const std::string& path) {
  File file(path == kStandardInput ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) {
    throw Failure(kExitNoInput, path + ": no such file");
  }
  return file;
}

// A base: it is there before the WavSound that reads it.
struct WavFile {
  File file;
};

class WavFileSound : private WavFile, public WavSound {
 public:
  WavFileSound(const std::string& path, const VideoRange& range)
      : WavFile{open_file(path)},
        WavSound(path == kStandardInput ? "standard input" : path, formats::file_source(file.get()),
                 range, 0.0) {}
};

// WAV is what ffmpeg is asked for; gaps are filled with silence, so that samples tell the time.
std::vector<std::string> sound_command(const std::string& input, const VideoRange& range) {
  std::vector<std::string> command = {"ffmpeg",   "-hide_banner", "-nostdin",
                                      "-nostats", "-loglevel",    "error"};
  if (range.start_s > 0.0) {
    command.insert(command.end(), {"-ss", std::to_string(range.start_s)});
  }
  if (range.duration_s) {
    command.insert(command.end(), {"-t", std::to_string(*range.duration_s)});
  }
  const std::vector<std::string> source = input_arguments(input);
  command.insert(command.end(), source.begin(), source.end());
  command.insert(command.end(), {"-map", "0:a:0", "-af", "aresample=async=1:first_pts=0", "-ac",
                                 "1", "-ar", "16000", "-c:a", "pcm_s16le", "-f", "wav", "-"});
  return command;
}

struct Decoder {
  Subprocess process;

  static std::size_t read(void* context, std::span<std::byte> into) {
    return static_cast<Decoder*>(context)->process.read(into);
  }
};

class FfmpegSound : private Decoder, public WavSound {
 public:
  FfmpegSound(const std::string& input, const VideoRange& range)
      : Decoder{{sound_command(input, range), Subprocess::Pipe::kFromChild, patience_with(input)}},
        WavSound(input, {&Decoder::read, static_cast<Decoder*>(this)}, range, range.start_s),
        input_(input) {}

 private:
  void at_end() override {
    if (process.finish() != 0) {
      throw Failure(kExitTruncated,
                    input_ + ": the sound is damaged: " + last_line(process.take_errors()));
    }
  }

  std::string input_;
};

}  // namespace

bool is_wav(const std::string& input) { return input.ends_with(".wav") && !is_url(input); }

std::unique_ptr<SoundSource> open_sound(const std::string& input, const VideoRange& range) {
  if (input == kStandardInput || is_wav(input)) {
    return std::make_unique<WavFileSound>(input, range);
  }
  return std::make_unique<FfmpegSound>(input, range);
}

void SoundFeed::hear_until(std::int64_t pts_ns, Tracker& tracker) {
  Audio block;
  std::int64_t block_ns = 0;
  while (!ended_ && !lasts_until(pts_ns + kAheadNs)) {
    if (!source_->next(block, block_ns)) {
      ended_ = true;
      return;
    }
    const mien_status status = tracker.push_audio(block, block_ns);
    if (status != MIEN_OK) {
      throw Failure(kExitInternal, input_ + ": sound: " + message(status));
    }
    if (listener_) {
      listener_(block, block_ns);
    }
    end_ns_ =
        block_ns + static_cast<std::int64_t>(block.frames) * 1'000'000'000 / block.sample_rate;
  }
}

}  // namespace mien::app
