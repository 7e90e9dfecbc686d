// Transcodes videos for pages.
#include "apps/mien/pages/web_video.h"

#include <vector>

#include "apps/mien/sources/animation_file.h"
#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/recording.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/subprocess.h"

namespace mien::app {
namespace {

// Square pixels; H.264 in 4:2:0 needs even sizes.
constexpr const char* kScaleFilter =
    "scale=w='iw*sar':h=ih,setsar=1,"
    "scale=w='min(640,iw)':h='min(640,ih)':"
    "force_original_aspect_ratio=decrease:force_divisible_by=2";

void add_input(std::vector<std::string>& command, const std::string& file,
               const WebVideo& request) {
  if (request.start_s > 0.0) {
    command.insert(command.end(), {"-ss", std::to_string(request.start_s)});
  }
  command.insert(command.end(), {"-t", std::to_string(request.duration_s)});
  const std::vector<std::string> input = input_arguments(file);
  command.insert(command.end(), input.begin(), input.end());
}

std::vector<std::string> transcode_command(const WebVideo& request, const std::string& output) {
  std::vector<std::string> command = {"ffmpeg",    "-hide_banner", "-nostdin",
                                      "-loglevel", "error",        "-xerror"};
  const bool apart =
      !request.video.empty() && !request.audio.empty() && request.audio != request.video;
  if (request.rotation) {
    command.emplace_back("-noautorotate");
  }
  add_input(command, request.video.empty() ? request.audio : request.video, request);
  if (apart) {
    add_input(command, request.audio, request);
  }
  if (!request.video.empty()) {
    command.insert(command.end(), {"-map", "0:v:0", "-vsync", "vfr", "-vf",
                                   rotation_filter(request.rotation.value_or(0)) + kScaleFilter});
    command.insert(command.end(), {"-pix_fmt", "yuv420p"});
    command.insert(command.end(), {"-c:v", "libx264", "-preset", "veryfast", "-crf", "26"});
    command.insert(command.end(), {"-maxrate", "1500k", "-bufsize", "3000k"});
    // without B-frames the first frame has time 0 in every player
    command.insert(command.end(), {"-bf", "0", "-force_key_frames", "expr:gte(t,n_forced)"});
  }
  if (!request.audio.empty()) {
    command.insert(command.end(), {"-map", (apart ? "1:a:" : "0:a:") +
                                               std::to_string(request.audio_track - 1) + "?"});
  }
  command.insert(command.end(), {"-c:a", "aac", "-ac", "1", "-b:a", "64k"});
  command.insert(command.end(),
                 {"-movflags", "+faststart", "-f", "mp4", "-y", output_file(output)});
  return command;
}

}  // namespace

std::string web_video(const WebVideo& request, const PartialFile& file) {
  const std::string& name = request.video.empty() ? request.audio : request.video;
  if (!request.video.empty()) {
    require_video(request.video);
  }
  Subprocess transcoder(transcode_command(request, file.name()), Subprocess::Pipe::kFromChild);
  transcoder.read_all();
  if (transcoder.finish() != 0) {
    throw Failure(kExitTruncated,
                  name + ": cannot be transcoded: " + last_line(transcoder.take_errors()));
  }
  std::string video = read_whole(file.name());
  if (video.empty()) {
    throw Failure(kExitNoVideo, name + ": no frame in the time range of the curves");
  }
  return video;
}

}  // namespace mien::app
