// Helpers for calls of the ffmpeg and ffprobe programs. mien links no code of ffmpeg.
#pragma once

#include <string>

namespace mien::app {

// The argument that makes ffmpeg write to the file `path`, even if its name looks like a protocol
// or an option. For inputs, see input_arguments.
std::string output_file(const std::string& path);

// The last line of ffmpeg's messages, which names the reason why it stopped.
std::string last_line(const std::string& text);

// ffmpeg's video filters for a clockwise rotation by `degrees`, a multiple of 90. Each filter ends
// with a comma.
std::string rotation_filter(int degrees);

}  // namespace mien::app
