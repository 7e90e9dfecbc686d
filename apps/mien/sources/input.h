// An input of the program: a file, standard input, or a URL.
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
  // Throws Failure if the file does not exist or has neither video nor audio.
  explicit Input(std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool has_video() const { return kind_ == Kind::kY4m || recording_.video; }
  [[nodiscard]] bool has_audio() const { return kind_ == Kind::kWav || !recording_.audio.empty(); }
  [[nodiscard]] std::size_t audio_tracks() const {
    return kind_ == Kind::kWav ? 1 : recording_.audio.size();
  }

  struct Opened {
    std::unique_ptr<VideoSource> video;
    std::unique_ptr<AudioSource> audio;
  };
  // Opens video and audio, as requested, on one clock. Throws Failure if one is missing.
  [[nodiscard]] Opened open(const InputOptions& options, bool video, bool audio) const;

 private:
  enum class Kind { kY4m, kWav, kFfmpeg };

  void probe();
  void probe_or_fail(ExitCode code, const std::string& refusal);
  [[nodiscard]] int audio_index(int track) const;
  [[nodiscard]] Opened open_separately(const InputOptions& options, bool video, bool audio) const;
  [[nodiscard]] Opened open_together(const InputOptions& options) const;

  std::string name_;
  Kind kind_ = Kind::kFfmpeg;
  Recording recording_;  // only for kFfmpeg
};

}  // namespace mien::app
