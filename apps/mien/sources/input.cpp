// Opens inputs, and selects between the readers of this program and ffmpeg.
#include "apps/mien/sources/input.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "apps/mien/sources/decoded_audio.h"
#include "apps/mien/sources/decoded_video.h"
#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/wav_audio.h"
#include "apps/mien/sources/y4m_source.h"
#include "apps/mien/system/failure.h"

namespace mien::app {
namespace {

using Arguments = std::vector<std::string>;

Arguments joined(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Arguments input_options(const InputOptions& options) {
  return options.rotation ? Arguments{"-noautorotate"} : Arguments();
}

// The time that ffmpeg seeks to. It may miss the last keyframe before the range, as in MPEG-TS, so
// it starts earlier.
double seek_s(const VideoRange& range) {
  constexpr double kEarlierS = 10.0;
  return std::max(0.0, range.start_s - kEarlierS);
}

// A filter that removes everything before the range; `filter` is "trim" or "atrim".
std::string trimmed(const char* filter, const VideoRange& range) {
  constexpr double kRounding = 1e-6;
  const double before = range.start_s - seek_s(range);
  return before > 0.0 ? std::string(filter) + "=start=" + std::to_string(before - kRounding) + ","
                      : std::string();
}

std::string audio_filter(const InputOptions& options) { return trimmed("atrim", options.range); }

// Square pixels of one size, even if the size changes within the video.
std::string video_filter(const VideoTrack& track, const InputOptions& options) {
  const DisplaySize size = display_size(track, options.rotation);
  return trimmed("trim", options.range) + rotation_filter(options.rotation.value_or(0)) +
         "scale=" + std::to_string(size.width) + ":" + std::to_string(size.height);
}

VideoInfo info_of(const VideoTrack& track, const InputOptions& options) {
  const DisplaySize size = display_size(track, options.rotation);
  return {size.width,   size.height,        track.fps,
          track.frames, track.pixel_aspect, options.rotation.value_or(track.rotation)};
}

// Outputs that read and discard the other streams. Containers without a start time (MPEG-TS) start
// at 0 with the first stream that is read, so all processes must read the same streams.
Arguments discard_outputs(const Recording& recording, int except) {
  Arguments arguments;
  if (recording.video && recording.video->index != except) {
    arguments = clock_output(recording.video->index);
  }
  for (const AudioTrack& track : recording.audio) {
    if (track.index != except) {
      arguments = joined(arguments, clock_output(track.index));
    }
  }
  return arguments;
}

}  // namespace

Input::Input(std::string name) : name_(std::move(name)) {
  if (is_y4m(name_)) {
    const std::string refusal = y4m_refusal(name_);
    kind_ = Kind::kY4m;
    if (!refusal.empty()) {
      probe_or_fail(kExitNoVideo, "not a Y4M video: " + refusal);
    }
  } else if (is_wav(name_)) {
    const std::string refusal = wav_refusal(name_);
    kind_ = Kind::kWav;
    if (!refusal.empty()) {
      probe_or_fail(kExitNoAudio, "audio cannot be read: " + refusal);
    }
  } else {
    probe();
  }
}

void Input::probe() {
  kind_ = Kind::kFfmpeg;
  recording_ = probe_recording(name_);
}

// Falls back to ffmpeg if the content does not match the file name, or if only ffmpeg can read it.
void Input::probe_or_fail(ExitCode code, const std::string& refusal) {
  try {
    probe();
  } catch (const Failure& failure) {
    throw Failure(failure.code() == kExitNoFfmpeg ? kExitNoFfmpeg : code,
                  name_ + ": " + refusal +
                      (failure.code() == kExitNoFfmpeg ? std::string("; ") + failure.what() : ""));
  }
}

int Input::audio_index(int track) const {
  const auto tracks = static_cast<int>(audio_tracks());
  if (track < 1 || track > tracks) {
    throw Failure(kExitNoAudio, tracks == 0
                                    ? name_ + ": no audio"
                                    : "--audio-track: no such track in " + name_ + " (got " +
                                          std::to_string(track) + ", expected 1 to " +
                                          std::to_string(tracks) + ")");
  }
  return kind_ == Kind::kFfmpeg ? recording_.audio[static_cast<std::size_t>(track - 1)].index : 0;
}

// Uses two independent processes: one process would queue images if audio starts late.
Input::Opened Input::open_separately(const InputOptions& options, bool video, bool audio) const {
  Opened opened;
  const auto decoder = [&](const Arguments& output, int index) {
    return std::make_shared<Decoder>(
        name_, seek_s(options.range), input_options(options),
        joined(joined(output, nut_output()), discard_outputs(recording_, index)), 1);
  };
  if (video) {
    const VideoTrack& track = *recording_.video;
    opened.video = std::make_unique<DecodedVideo>(
        name_, options.range, info_of(track, options),
        decoder(video_output(track.index, track.time_base, video_filter(track, options)),
                track.index),
        0);
  }
  if (audio) {
    const int index = audio_index(options.audio_track);
    opened.audio = std::make_unique<DecodedAudio>(
        name_, options.range, decoder(audio_output(index, audio_filter(options)), index), 0);
  }
  return opened;
}

// Uses one process: two connections to a live stream would start at different times.
Input::Opened Input::open_together(const InputOptions& options) const {
  const VideoTrack& track = *recording_.video;
  const Arguments both =
      joined(video_output(track.index, track.time_base, video_filter(track, options)),
             audio_output(audio_index(options.audio_track), audio_filter(options)));
  const auto decoder = std::make_shared<Decoder>(
      name_, seek_s(options.range), input_options(options), joined(both, nut_output()), 2);
  Opened opened;
  opened.video =
      std::make_unique<DecodedVideo>(name_, options.range, info_of(track, options), decoder, 0);
  opened.audio = std::make_unique<DecodedAudio>(name_, options.range, decoder, 1);
  return opened;
}

Input::Opened Input::open(const InputOptions& options, bool video, bool audio) const {
  if (video && !has_video()) {
    throw Failure(kExitNoVideo, name_ + ": no video stream");
  }
  if (audio) {
    static_cast<void>(audio_index(options.audio_track));
  }
  if (kind_ == Kind::kY4m) {
    return {open_y4m(name_, options), nullptr};
  }
  if (kind_ == Kind::kWav) {
    return {nullptr, open_wav(name_, options.range)};
  }
  return video && audio && is_url(name_) ? open_together(options)
                                         : open_separately(options, video, audio);
}

std::unique_ptr<VideoSource> open_video(const std::string& input, const InputOptions& options) {
  return Input(input).open(options, true, false).video;
}

std::unique_ptr<AudioSource> open_audio_source(const std::string& input,
                                               const InputOptions& options) {
  if (input == kStandardInput) {
    return open_wav(input, options.range);
  }
  return Input(input).open(options, false, true).audio;
}

}  // namespace mien::app
