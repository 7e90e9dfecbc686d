#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/mien/sources/ffmpeg.h"
#include "apps/mien/sources/network_input.h"
#include "apps/mien/sources/sound_source.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/subprocess.h"
#include "formats/animation/numbers.h"

namespace mien::app {
namespace {

using nlohmann::json;

void append(std::vector<std::string>& command, const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
}

double number(const json& object, const char* key, double otherwise) {
  if (!object.contains(key)) {
    return otherwise;
  }
  return object[key].is_string() ? std::atof(object[key].get_ref<const std::string&>().c_str())
                                 : object[key].get<double>();
}

// "30000/1001" -> 29.97
double ratio(const std::string& text) {
  const std::size_t slash = text.find('/');
  const double numerator = std::atof(text.c_str());
  const double denominator = slash == std::string::npos ? 1.0 : std::atof(text.c_str() + slash + 1);
  return denominator > 0.0 ? numerator / denominator : 0.0;
}

bool turned_sideways(const json& stream) {
  double degrees = 0.0;
  for (const json& side_data : stream.value("side_data_list", json::array())) {
    degrees = number(side_data, "rotation", degrees);
  }
  return std::lround(std::abs(degrees) / 90.0) % 2 == 1;
}

// `streams` as of ffprobe; empty: all.
json probe(const std::string& input, const std::string& streams) {
  std::vector<std::string> command = {"ffprobe",      "-v",  "error", "-show_streams",
                                      "-show_format", "-of", "json"};
  if (!streams.empty()) {
    command.insert(command.end(), {"-select_streams", streams});
  }
  append(command, input_arguments(input));
  Subprocess ffprobe(command, Subprocess::Pipe::kFromChild, patience_with(input));
  const std::string text = ffprobe.read_all();
  const int status = ffprobe.finish();
  json found = json::parse(text, nullptr, false);
  if (status != 0 || found.is_discarded()) {
    if (is_url(input)) {
      throw Failure(kExitNoInput,
                    input + ": cannot be opened: " + last_line(ffprobe.take_errors()));
    }
    throw Failure(kExitNoVideo, input + ": not a video: " + last_line(ffprobe.take_errors()));
  }
  if (!found.contains("streams") || found["streams"].empty()) {
    throw Failure(kExitNoVideo, input + ": has no video stream");
  }
  return found;
}

void require_file(const std::string& input) {
  if (is_url(input)) {
    return;
  }
  std::error_code ignored;
  if (!std::filesystem::exists(path_of(input), ignored)) {
    throw Failure(kExitNoInput, input + ": no such file");
  }
  if (std::filesystem::is_directory(path_of(input), ignored)) {
    throw Failure(kExitNoInput, input + ": is a directory");
  }
}

// Containers round their frame counts; a few frames less is not a damaged file.
bool too_few(std::int64_t frames, std::int64_t promised) {
  return frames + 2 + promised / 50 < promised;
}

// Frames that an edit list leaves out are counted all the same; only the duration is without them.
std::optional<std::int64_t> frames_promised(const json& probed, double fps) {
  const json& stream = probed["streams"][0];
  const auto counted = static_cast<std::int64_t>(number(stream, "nb_frames", 0.0));
  // How long sound and picture last together says nothing of a picture that is counted.
  const double both_s = counted > 0 ? 0.0 : number(probed["format"], "duration", 0.0);
  constexpr double kRounding = 1e-3;  // of a frame, durations having six digits
  const auto shown =
      static_cast<std::int64_t>(std::floor(number(stream, "duration", both_s) * fps + kRounding));
  const std::int64_t frames =
      counted > 0 && shown > 0 ? std::min(counted, shown) : std::max(counted, shown);
  return frames > 0 ? std::optional(frames) : std::nullopt;
}

VideoInfo info_from(const json& probed, const std::string& input) {
  const json& stream = probed["streams"][0];
  VideoInfo info;
  info.width = stream.value("width", 0);
  info.height = stream.value("height", 0);
  if (info.width <= 0 || info.height <= 0) {
    throw Failure(kExitNoVideo, input + ": the video stream has no size");
  }
  if (turned_sideways(stream)) {
    std::swap(info.width, info.height);
  }
  const double fps = ratio(stream.value("avg_frame_rate", "0/1"));
  info.fps = fps > 0.0 ? fps : 30.0;
  info.frames = frames_promised(probed, fps);
  return info;
}

std::string seconds_text(double seconds) { return std::to_string(seconds); }

std::vector<std::string> video_command(const std::string& input, const VideoRange& range) {
  std::vector<std::string> command = {"ffmpeg",   "-hide_banner", "-nostdin",
                                      "-nostats", "-loglevel",    "level+info"};
  if (range.start_s > 0.0) {
    command.insert(command.end(), {"-ss", seconds_text(range.start_s)});
  }
  if (range.duration_s) {
    command.insert(command.end(), {"-t", seconds_text(*range.duration_s)});
  }
  append(command, input_arguments(input));
  // showinfo reports each frame's own time, which a raw stream does not carry.
  append(command, {"-map", "0:v:0", "-vsync", "passthrough", "-vf", "showinfo=checksum=0",
                   "-pix_fmt", "rgb24", "-f", "rawvideo", "-"});
  return command;
}

class FfmpegSource : public VideoSource {
 public:
  FfmpegSource(const std::string& input, const VideoRange& range)
      : input_(input),
        range_(range),
        info_(probe_video(input)),
        decoder_(video_command(input, range), Subprocess::Pipe::kFromChild, patience_with(input)),
        rgb_(static_cast<std::size_t>(info_.width) * static_cast<std::size_t>(info_.height) * 3) {}

  const VideoInfo& info() const override { return info_; }
  bool next(mien_image& image, std::int64_t& pts_ns) override;

 private:
  void at_end(std::size_t bytes_of_last_frame);
  void collect_log(bool finished);
  void collect_time(std::string_view line);
  std::int64_t time_of(std::int64_t frame) const;
  std::int64_t lacking_at_end() const;

  std::string input_;
  VideoRange range_;
  VideoInfo info_;
  Subprocess decoder_;
  std::vector<unsigned char> rgb_;
  std::vector<double> times_s_;
  double tick_s_ = 0.0;  // what times are counted in
  std::string log_;
  std::string last_error_;
  std::int64_t frames_ = 0;
};

// The number behind a word of a line.
template <typename Number>
bool number_behind(std::string_view line, std::string_view word, Number& value) {
  const std::size_t at = line.find(word);
  if (at == std::string_view::npos) {
    return false;
  }
  line.remove_prefix(at + word.size());
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return formats::parse_number(line.substr(0, line.find(' ')), value);
}

// Lines look like "[Parsed_showinfo_0 @ 0x..] [info] config in time_base: 1/12800, frame_rate:
// 25/1" and
// "[Parsed_showinfo_0 @ 0x..] [info] n:   0 pts: 512 pts_time:0.04 ...", whose pts_time has six
// digits only.
void FfmpegSource::collect_time(std::string_view line) {
  constexpr std::string_view kTick = " config in time_base: ";
  if (const std::size_t at = line.find(kTick); at != std::string_view::npos) {
    tick_s_ = ratio(std::string(line.substr(at + kTick.size())));
  } else if (line.find(" pts_time:") != std::string_view::npos) {
    std::int64_t pts = 0;
    const bool known = number_behind(line, " pts:", pts) && tick_s_ > 0.0;
    times_s_.push_back(known ? static_cast<double>(pts) * tick_s_
                             : static_cast<double>(times_s_.size()) / info_.fps);
  }
}

void FfmpegSource::collect_log(bool finished) {
  log_ += decoder_.take_errors();
  std::size_t begin = 0;
  for (std::size_t end = log_.find('\n'); end != std::string::npos; end = log_.find('\n', begin)) {
    const std::string_view line(log_.data() + begin, end - begin);
    begin = end + 1;
    if (line.find("showinfo") != std::string_view::npos) {
      collect_time(line);
    } else if (line.find("[error]") != std::string_view::npos ||
               line.find("[fatal]") != std::string_view::npos) {
      last_error_ = line;
    }
  }
  log_.erase(0, begin);
  if (finished && !log_.empty() && last_error_.empty()) {
    last_error_ = log_;
  }
}

std::int64_t FfmpegSource::time_of(std::int64_t frame) const {
  const auto index = static_cast<std::size_t>(frame);
  const double seconds =
      index < times_s_.size() ? times_s_[index] : static_cast<double>(frame) / info_.fps;
  return std::llround((range_.start_s + seconds) * 1e9);
}

// A video that was cut without being encoded anew may lack frames in front of its last one, which
// stands before them in the file. Its duration is that of all.
std::int64_t FfmpegSource::lacking_at_end() const {
  constexpr std::int64_t kMost = 16;  // frames that one may stand before, in H.264 and H.265
  if (times_s_.size() < 2) {
    return 0;
  }
  const std::size_t steps = std::min<std::size_t>(kMost, times_s_.size() - 1);
  const double lasted_s = times_s_.back() - times_s_[times_s_.size() - 1 - steps];
  return std::clamp<std::int64_t>(
      std::llround(lasted_s * info_.fps) - static_cast<std::int64_t>(steps), 0, kMost);
}

bool FfmpegSource::next(mien_image& image, std::int64_t& pts_ns) {
  const std::size_t got = decoder_.read(std::as_writable_bytes(std::span(rgb_)));
  if (got < rgb_.size()) {
    at_end(got);
    return false;
  }
  collect_log(false);
  mien_image_default(&image);
  image.format = MIEN_IMAGE_RGB;
  image.width = info_.width;
  image.height = info_.height;
  image.planes[0] = rgb_.data();
  image.row_stride_bytes[0] = info_.width * 3;
  pts_ns = time_of(frames_++);
  return true;
}

void FfmpegSource::at_end(std::size_t bytes_of_last_frame) {
  const int status = decoder_.finish();
  collect_log(true);
  if (status != 0 && frames_ == 0) {
    throw Failure(kExitNoVideo, input_ + ": cannot be decoded: " + last_line(last_error_));
  }
  const bool whole_file = range_.start_s <= 0.0 && !range_.duration_s;
  const bool cut_off =
      whole_file && info_.frames && too_few(frames_ + lacking_at_end(), *info_.frames);
  if (status != 0 || bytes_of_last_frame != 0 || cut_off) {
    throw Failure(kExitTruncated,
                  input_ + ": truncated after " + std::to_string(frames_) + " frames" +
                      (info_.frames ? " of " + std::to_string(*info_.frames) : std::string()) +
                      (last_error_.empty() ? "" : ": " + last_line(last_error_)));
  }
  if (frames_ == 0) {
    throw Failure(kExitNoVideo, input_ + ": no frame in the range asked for");
  }
}

}  // namespace

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

InputStreams probe_streams(const std::string& input) {
  if (is_y4m(input)) {
    return {.video = true};
  }
  require_file(input);
  if (is_wav(input)) {
    return {.sound = true};
  }
  InputStreams streams;
  const json probed = probe(input, "");
  for (const json& stream : probed["streams"]) {
    const std::string kind = stream.value("codec_type", "");
    const json disposition = stream.value("disposition", json::object());
    streams.video |= kind == "video" && disposition.value("attached_pic", 0) == 0;
    streams.sound |= kind == "audio";
  }
  if (!streams.video && !streams.sound) {
    throw Failure(kExitNoVideo, input + ": has neither video nor sound");
  }
  return streams;
}

VideoInfo probe_video(const std::string& input) {
  require_file(input);
  return info_from(probe(input, "v:0"), input);
}

std::unique_ptr<VideoSource> open_with_ffmpeg(const std::string& input, const VideoRange& range) {
  return std::make_unique<FfmpegSource>(input, range);
}

}  // namespace mien::app
