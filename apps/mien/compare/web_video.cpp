#include "apps/mien/compare/web_video.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "apps/mien/failure.h"
#include "apps/mien/ffmpeg.h"

namespace mien::app {
namespace {

class ScratchFile {
 public:
  explicit ScratchFile(std::string path) : path_(std::move(path)) {}
  ~ScratchFile() { std::remove(path_.c_str()); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string contents() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::string path_;
};

std::vector<std::string> transcode_command(const std::string& input, double start_s,
                                           double duration_s, const std::string& output) {
  std::vector<std::string> command = {"ffmpeg",    "-hide_banner", "-nostdin",
                                      "-loglevel", "error",        "-xerror"};
  if (start_s > 0.0) {
    command.insert(command.end(), {"-ss", std::to_string(start_s)});
  }
  command.insert(command.end(), {"-t", std::to_string(duration_s), "-i", input});
  command.insert(command.end(), {"-map", "0:v:0", "-map", "0:a:0?", "-vsync", "vfr"});
  // H.264 in 4:2:0 needs even sizes.
  command.insert(command.end(), {"-vf",
                                 "scale=w='min(640,iw)':h='min(640,ih)':"
                                 "force_original_aspect_ratio=decrease:force_divisible_by=2",
                                 "-pix_fmt", "yuv420p"});
  command.insert(command.end(), {"-c:v", "libx264", "-preset", "veryfast", "-crf", "26"});
  command.insert(command.end(), {"-maxrate", "1500k", "-bufsize", "3000k"});
  // Without frames that refer ahead the first frame is at time 0 in every player.
  command.insert(command.end(), {"-bf", "0", "-force_key_frames", "expr:gte(t,n_forced)"});
  command.insert(command.end(), {"-c:a", "aac", "-ac", "1", "-b:a", "64k"});
  command.insert(command.end(), {"-movflags", "+faststart", "-y", output});
  return command;
}

}  // namespace

std::string web_video(const std::string& input, double start_s, double duration_s,
                      const std::string& scratch) {
  probe_video(input);
  const ScratchFile made(scratch);
  Subprocess transcoder(transcode_command(input, start_s, duration_s, made.path()),
                        Subprocess::Pipe::kFromChild);
  transcoder.read_all();
  if (transcoder.finish() != 0) {
    throw Failure(kExitTruncated,
                  input + ": cannot be transcoded: " + last_line(transcoder.take_errors()));
  }
  std::string video = made.contents();
  if (video.empty()) {
    throw Failure(kExitNoVideo, input + ": no frame in the time of the curves");
  }
  return video;
}

}  // namespace mien::app
