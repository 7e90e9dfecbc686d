// Helpers for calls of ffmpeg.
#include "apps/mien/sources/ffmpeg.h"

namespace mien::app {

std::string output_file(const std::string& path) { return "file:" + path; }

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \r\n");
  if (end == std::string::npos) {
    return {};
  }
  const std::size_t before = text.find_last_of('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, end + 1 - begin);
}

std::string rotation_filter(int degrees) {
  switch (degrees) {
    case 90:
      return "transpose=clock,";
    case 180:
      return "hflip,vflip,";
    case 270:
      return "transpose=cclock,";
    default:
      return "";
  }
}

}  // namespace mien::app
