// PCM WAV from a file or standard input, without ffmpeg.
#pragma once

#include <memory>
#include <string>

#include "apps/mien/sources/audio_source.h"

namespace mien::app {

[[nodiscard]] bool is_wav(const std::string& input);  // by its name

// Why a WAV file cannot be read without ffmpeg; empty where it can. Throws Failure where there is
// no such file.
[[nodiscard]] std::string wav_refusal(const std::string& path);

std::unique_ptr<AudioSource> open_wav(const std::string& input, const VideoRange& range);

}  // namespace mien::app
