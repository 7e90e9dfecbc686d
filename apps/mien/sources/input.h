// A file, a stream on standard input, or a URL, and what it holds.
#pragma once

#include <memory>
#include <string>

#include "apps/mien/sources/audio_source.h"
#include "apps/mien/sources/recording.h"
#include "apps/mien/sources/video_source.h"
#include "apps/mien/system/exit_codes.h"

namespace mien::app {

class Input {
 public:
  // Throws Failure where there is no such file, or neither video nor audio in it.
  explicit Input(std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool has_video() const { return kind_ == Kind::kY4m || recording_.video; }
  [[nodiscard]] bool has_audio() const { return kind_ == Kind::kWav || !recording_.audio.empty(); }
  [[nodiscard]] std::size_t audio_tracks() const {
    return kind_ == Kind::kWav ? 1 : recording_.audio.size();
  }

  struct Opened {
    std::unique_ptr<VideoSource> video;
    std::unique_ptr<AudioSource> sound;
  };
  // What is asked for of both, on one clock. Throws Failure where it is not there.
  [[nodiscard]] Opened open(const InputOptions& options, bool video, bool sound) const;

 private:
  enum class Kind { kY4m, kWav, kFfmpeg };

  void probe();
  void probe_instead(ExitCode code, const std::string& refusal);
  [[nodiscard]] int audio_index(int track) const;
  [[nodiscard]] Opened open_apart(const InputOptions& options, bool video, bool sound) const;
  [[nodiscard]] Opened open_together(const InputOptions& options) const;

  std::string name_;
  Kind kind_ = Kind::kFfmpeg;
  Recording recording_;  // of kFfmpeg
};

}  // namespace mien::app
