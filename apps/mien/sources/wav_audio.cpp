// Reads audio from WAV files.
#include "apps/mien/sources/wav_audio.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "apps/mien/sources/input_file.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/system/failure.h"
#include "formats/wav.h"

namespace mien::app {
namespace {

using formats::WavFormat;
using formats::WavReader;
using formats::WavStatus;

constexpr std::size_t kBlockFrames = 1024;

std::string error_message(const WavReader& reader, WavStatus status) {
  return std::string(formats::message(status)) + ", at byte " +
         std::to_string(reader.fault_offset());
}

// Clamped, because any number of seconds may be given.
std::int64_t frames_in(double seconds, std::uint32_t rate) {
  constexpr double kMaxFrames = 1e15;
  return std::llround(std::clamp(seconds * rate, 0.0, kMaxFrames));
}

class WavAudio : public AudioSource {
 public:
  WavAudio(const std::string& path, const VideoRange& range)
      : name_(input_label(path)), file_(open_input_file(path)) {
    const WavStatus status = reader_.open(formats::file_source(file_.get()));
    if (status != WavStatus::kOk) {
      throw Failure(kExitNoAudio,
                    name_ + ": audio cannot be read: " + error_message(reader_, status));
    }
    const WavFormat& format = reader_.format();
    samples_.resize(kBlockFrames * format.channels);
    skip_ = frames_in(range.start_s, format.sample_rate);
    last_ = range.duration_s ? skip_ + frames_in(*range.duration_s, format.sample_rate)
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
    pts_ns = std::llround(seconds * 1e9);
    return true;
  }

 private:
  bool read(std::size_t& frames) {
    const WavStatus status = reader_.read(samples_, frames);
    if (status != WavStatus::kOk && status != WavStatus::kEnd) {
      const double seconds = static_cast<double>(frames_) / reader_.format().sample_rate;
      throw Failure(kExitTruncated, name_ + ": audio damaged after " + std::to_string(seconds) +
                                        " s: " + error_message(reader_, status));
    }
    return status == WavStatus::kOk;
  }

  std::string name_;
  InputFile file_;
  WavReader reader_;
  std::vector<float> samples_;
  std::int64_t frames_ = 0;  // read
  std::int64_t skip_ = 0;
  std::int64_t last_ = 0;
};

}  // namespace

bool is_wav(const std::string& input) { return input.ends_with(".wav") && !is_url(input); }

std::string wav_refusal(const std::string& path) {
  const InputFile file = open_input_file(path);
  if (!can_be_read_again(path)) {
    return {};
  }
  WavReader reader;
  const WavStatus status = reader.open(formats::file_source(file.get()));
  return status == WavStatus::kOk ? std::string() : error_message(reader, status);
}

std::unique_ptr<AudioSource> open_wav(const std::string& input, const VideoRange& range) {
  return std::make_unique<WavAudio>(input, range);
}

}  // namespace mien::app
