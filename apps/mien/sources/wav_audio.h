// PCM WAV from a file or standard input, without ffmpeg.
#pragma once

#include <memory>
#include <string>

#include "apps/mien/sources/audio_source.h"

namespace mien::app {

[[nodiscard]] bool is_wav(const std::string& input);  // by its name

// The reason why only ffmpeg can read a WAV file, or "" if this program can. Throws Failure if the
// file does not exist.
[[nodiscard]] std::string wav_refusal(const std::string& path);

std::unique_ptr<AudioSource> open_wav(const std::string& input, const VideoRange& range);

}  // namespace mien::app
