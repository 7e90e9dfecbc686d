// Converts decoded audio packets to blocks of fp32 samples.
#include "apps/mien/sources/decoded_audio.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

constexpr double kRate = 16000.0;
constexpr std::size_t kSampleBytes = 2;

// The number of samples before `seconds`, at most `max`.
std::size_t samples_before(double seconds, std::size_t max) {
  return static_cast<std::size_t>(
      std::clamp(std::round(seconds * kRate), 0.0, static_cast<double>(max)));
}

}  // namespace

DecodedAudio::DecodedAudio(std::string input, const VideoRange& range,
                           std::shared_ptr<Decoder> decoder, std::size_t stream)
    : input_(std::move(input)), range_(range), decoder_(std::move(decoder)), stream_(stream) {}

void DecodedAudio::convert(std::size_t first, std::size_t last) {
  samples_.clear();
  for (std::size_t i = first; i < last; ++i) {
    const std::byte* at = packet_.data.data() + i * kSampleBytes;
    const auto bits = static_cast<std::uint16_t>(std::to_integer<unsigned>(at[0]) |
                                                 std::to_integer<unsigned>(at[1]) << 8);
    samples_.push_back(static_cast<float>(static_cast<std::int16_t>(bits)) / 32768.0f);
  }
}

// Returns only samples within the range.
bool DecodedAudio::next(Audio& block, std::int64_t& pts_ns) {
  while (decoder_->next(stream_, packet_)) {
    const std::size_t there = packet_.data.size() / kSampleBytes;
    const double begin_s = range_.start_s - packet_.time_s;
    const std::size_t first = samples_before(begin_s, there);
    const std::size_t last =
        range_.duration_s ? samples_before(begin_s + *range_.duration_s, there) : there;
    if (last == 0 && there > 0) {
      return false;
    }
    if (first < last) {
      convert(first, last);
      block = Audio();
      block.sample_rate = static_cast<std::int32_t>(kRate);
      block.frames = samples_.size();
      block.samples[0] = samples_.data();
      const double seconds = packet_.time_s + static_cast<double>(first) / kRate;
      pts_ns = std::llround(seconds * 1e9);
      has_output_ = true;
      return true;
    }
  }
  at_end();
  return false;
}

void DecodedAudio::at_end() const {
  const std::string& last = decoder_->damage().last;
  const std::string reason = last.empty() ? "" : ": " + last;
  if (decoder_->failed() || decoder_->ended_early()) {
    throw Failure(has_output_ || decoder_->ended_early() ? kExitTruncated : kExitNoAudio,
                  input_ + ": the audio is damaged or truncated" + reason);
  }
}

}  // namespace mien::app
