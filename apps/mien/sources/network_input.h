// Inputs that come over a network: "rtsp://camera/stream".
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace mien::app {

[[nodiscard]] bool is_url(const std::string& input);

// What ffmpeg and ffprobe are given for an input. A file's name names a file, whatever it holds,
// and what the file refers to is looked for among files alone. A URL may lead to the protocols of
// the network that it needs and never to files. Throws Failure(kExitUsage) for a protocol that is
// not taken.
[[nodiscard]] std::vector<std::string> input_arguments(const std::string& input);

// How long ffmpeg may give nothing of an input: what comes over a network may pause.
[[nodiscard]] std::chrono::milliseconds patience_with(const std::string& input);

}  // namespace mien::app
