// Reads the frames of `mien track` and feeds them to the tracker.
#include "apps/mien/tracking/frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/mien/system/failure.h"
#include "apps/mien/tracking/loaded_tracker.h"

namespace mien::app {
namespace {

constexpr float kSilence = 1e-4f;  // -80 dB of full scale

bool has_audio(const InputTracks& tracks, const TrackOptions& options) {
  if (options.audio == kStandardInput) {
    return true;
  }
  const std::optional<Input>& from = options.audio.empty() ? tracks.input : tracks.audio;
  return from && from->has_audio();
}

std::string damage_note(const std::string& input, const char* what, const Damage& damage) {
  return input + ": " + what + ": " + std::to_string(damage.complaints) +
         (damage.complaints == 1 ? " decoding error: " : " decoding errors, the last: ") +
         damage.last;
}

}  // namespace

InputTracks choose(const TrackOptions& options) {
  InputTracks tracks;
  const bool pipes_sound = options.mode == Mode::kAudio && options.audio.empty();
  if (pipes_sound && options.input == kStandardInput) {
    tracks.sound = options.input;
    return tracks;
  }
  if (options.audio == kStandardInput && options.input == kStandardInput) {
    throw Failure(kExitUsage, "--audio: standard input is already used for video");
  }
  if (options.mode != Mode::kAudio || options.audio.empty()) {
    tracks.input.emplace(options.input);
  }
  tracks.video =
      options.mode == Mode::kAny ? tracks.input->has_video() : options.mode != Mode::kAudio;
  if (options.mode == Mode::kVideo) {
    return tracks;
  }
  if (!options.audio.empty() && options.audio != kStandardInput) {
    tracks.audio.emplace(options.audio);
  }
  const std::string& source = options.audio.empty() ? options.input : options.audio;
  const bool has_track = has_audio(tracks, options);
  const bool is_required = options.mode != Mode::kAny || !tracks.video || !options.audio.empty();
  if (is_required && !has_track) {
    throw Failure(kExitNoAudio, source + ": no audio");
  }
  if (is_required || (has_track && has_audionet(options.models))) {
    tracks.sound = source;
  }
  return tracks;
}

VideoRange range_of(const TrackOptions& options) {
  constexpr double kMaxSeconds = 1e9;  // 31 years
  VideoRange range;
  range.start_s = std::min(options.start_s, kMaxSeconds);
  if (options.duration_s) {
    range.duration_s = std::min(*options.duration_s, kMaxSeconds);
  }
  return range;
}

Frames::Frames(const TrackOptions& options, const InputTracks& tracks, Tracker& tracker)
    : options_(options),
      tracks_(tracks),
      start_ns_(std::llround(range_of(options).start_s * 1e9)),
      tracker_(tracker) {
  const InputOptions how{range_of(options), options.rotation, options.audio_track};
  std::unique_ptr<AudioSource> sound;
  if (tracks.input) {
    const bool own_sound = !tracks.sound.empty() && options.audio.empty();
    Input::Opened opened = tracks.input->open(how, tracks.video, own_sound);
    video_ = std::move(opened.video);
    sound = std::move(opened.audio);
  }
  if (tracks.audio) {
    sound = tracks.audio->open(how, false, true).audio;
  } else if (tracks.sound == kStandardInput) {
    sound = open_audio_source(kStandardInput, how);
  }
  if (sound) {
    sound_.emplace(tracks.sound, std::move(sound));
    check(tracker.set_audio_offset(std::llround(options.av_offset_ms * 1e6)), options.input);
  }
}

std::size_t Frames::audio_tracks() const {
  const std::optional<Input>& from = tracks_.audio ? tracks_.audio : tracks_.input;
  return from ? from->audio_tracks() : 1;
}

std::string Frames::silence_note() const {
  const std::size_t tracks = audio_tracks();
  std::string note =
      tracks_.sound + ": audio track " + std::to_string(options_.audio_track) + " is silent";
  return tracks > 1 ? note + "; --audio-track selects one of " + std::to_string(tracks) : note;
}

MediaReport Frames::report() const {
  MediaReport report;
  if (video_) {
    const Damage damage = video_->damage();
    report.video = video_->info();
    report.video_decoding_errors = damage.complaints;
    if (damage.complaints > 0) {
      report.notes.push_back(damage_note(options_.input, "video", damage));
    }
    if (damage.frames_lost) {
      report.lost = options_.input + ": frames could not be decoded: " + damage.last;
    }
  }
  if (sound_) {
    const Damage damage = sound_->damage();
    report.audio = {options_.audio_track, audio_tracks(), sound_->peak(), damage.complaints};
    if (damage.complaints > 0) {
      report.notes.push_back(damage_note(tracks_.sound, "audio", damage));
    }
    if (sound_->peak() < kSilence) {
      report.notes.push_back(silence_note());
    }
  }
  return report;
}

void Frames::set_listener(AudioFeed::Listener listener) {
  if (sound_) {
    sound_->set_listener(std::move(listener));
  }
}

bool Frames::next() {
  ++number_;
  return video_ ? next_image() : next_sound();
}

bool Frames::next_image() {
  std::int64_t pts_ns = 0;
  if (!video_->next(image_, pts_ns)) {
    return false;
  }
  if (sound_) {
    sound_->push_until(pts_ns, tracker_);
  }
  check(tracker_.push_video(image_, pts_ns), where());
  return true;
}

bool Frames::next_sound() {
  const std::int64_t pts_ns = start_ns_ + number_ * 1'000'000'000 / 30;
  sound_->push_until(pts_ns, tracker_);
  if (!sound_->lasts_until(pts_ns)) {
    return false;
  }
  check(tracker_.advance(pts_ns), where());
  return true;
}

}  // namespace mien::app
