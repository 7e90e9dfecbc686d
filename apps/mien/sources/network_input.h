// Inputs from a network: "rtsp://camera/stream".
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace mien::app {

[[nodiscard]] bool is_url(const std::string& input);

// ffmpeg's and ffprobe's arguments for an input. A file name always names a file, and a playlist
// can refer to files only. A URL can use the network protocols that it needs, but no files. Throws
// Failure(kExitUsage) for an unsupported protocol.
[[nodiscard]] std::vector<std::string> input_arguments(const std::string& input);

// The timeout for an ffmpeg that outputs nothing: endless for network inputs, which may pause.
[[nodiscard]] std::chrono::milliseconds timeout_of(const std::string& input);

}  // namespace mien::app
