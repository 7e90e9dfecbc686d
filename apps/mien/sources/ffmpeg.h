// What all that call the ffmpeg and ffprobe programs need. Nothing of them is linked.
#pragma once

#include <string>

namespace mien::app {

// What ffmpeg is told to write a file by: whatever its name holds, it names a file and no protocol
// or option. For inputs: input_arguments.
std::string output_file(const std::string& path);

// The line of what ffmpeg said on stderr that tells why it stopped.
std::string last_line(const std::string& text);

// ffmpeg's video filters that turn a frame by `degrees` clockwise, a multiple of 90; each ends in a
// comma.
std::string rotation_filter(int degrees);

}  // namespace mien::app
