#include "apps/mien/convert/convert.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/sources/animation_file.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/shown.h"
#include "formats/animation/resample.h"

namespace mien::app {
namespace {

using formats::Clip;
using formats::Frame;

using Faces = std::map<std::int64_t, std::vector<Frame>>;

// Frames without an id belong to whoever comes next.
Faces by_face(const Clip& clip) {
  Faces faces;
  for (const Frame& frame : clip.frames) {
    faces[frame.face_id].push_back(frame);
  }
  return faces;
}

std::size_t count_named(const Faces& faces) { return faces.size() - (faces.contains(0) ? 1 : 0); }

bool same_time_or_later(const Frame& a, const Frame& b) { return a.time_ns < b.time_ns; }

// The frames of one face, and those without any.
std::vector<Frame> only(const Faces& faces, std::int64_t id) {
  std::vector<Frame> frames = faces.at(id);
  if (id != 0 && faces.contains(0)) {
    const std::vector<Frame>& nobody = faces.at(0);
    frames.insert(frames.end(), nobody.begin(), nobody.end());
    std::stable_sort(frames.begin(), frames.end(), same_time_or_later);
  }
  return frames;
}

std::int64_t most_seen(const Faces& faces) {
  const auto most = std::max_element(faces.begin(), faces.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first != 0, a.second.size()) < std::pair(b.first != 0, b.second.size());
  });
  return most->first;
}

// At even times, each face by itself.
std::vector<Frame> at_rate(const Clip& clip, double fps) {
  constexpr double kMostFrames = 1e7;
  const std::int64_t first_ns = clip.frames.front().time_ns;
  const auto span_ns = static_cast<double>(clip.frames.back().time_ns - first_ns);
  if (!(span_ns * 1e-9 * fps <= kMostFrames)) {
    throw Failure(kExitUsage, "--fps: these would be more than ten million frames");
  }
  const Faces faces = by_face(clip);
  if (count_named(faces) <= 1) {
    return formats::resampled(clip.frames, fps, first_ns);
  }
  std::vector<Frame> all;
  for (const auto& [id, frames] : faces) {
    const std::vector<Frame> even = formats::resampled(frames, fps, first_ns);
    all.insert(all.end(), even.begin(), even.end());
  }
  std::stable_sort(all.begin(), all.end(), same_time_or_later);
  return all;
}

// What was lost on the way; also leaves one face where the format holds no more.
std::vector<std::string> fit(Clip& clip, const ConvertOptions& options,
                             formats::AnimationFormat format) {
  std::vector<std::string> lost;
  const Faces faces = by_face(clip);
  if (options.face && !faces.contains(*options.face)) {
    throw Failure(kExitUsage, "--face: there is no face " + std::to_string(*options.face) + " in " +
                                  options.input);
  }
  const bool too_many = count_named(faces) > 1 && !formats::holds_several_faces(format);
  if (options.face || too_many) {
    const std::int64_t id = options.face.value_or(most_seen(faces));
    clip.frames = only(faces, id);
    if (!options.face) {
      lost.push_back("all faces but " + std::to_string(id) + ", the one seen most (--face)");
    }
  }
  if (options.fps) {
    clip.frames = at_rate(clip, *options.fps);
  }
  if (clip.out_of_range > 0) {
    lost.push_back(std::to_string(clip.out_of_range) + " values beyond 0..1 were brought there");
  }
  for (const std::string& what : formats::losses(clip, format)) {
    lost.push_back(what);
  }
  return lost;
}

void report(const ConvertOptions& options, formats::AnimationFormat format, const Clip& clip,
            const std::vector<std::string>& lost) {
  if (options.json) {
    const nlohmann::ordered_json text = {{"input", options.input},
                                         {"output", options.output},
                                         {"format", formats::name(format)},
                                         {"frames", clip.frames.size()},
                                         {"notes", clip.notes},
                                         {"left_out", lost}};
    std::fprintf(stderr, "%s\n", json_text(text, -1).c_str());
    return;
  }
  if (options.quiet) {
    return;
  }
  print_notes(options.input, clip);
  std::fprintf(stderr, "%s: %zu frames\n", shown(options.output).c_str(), clip.frames.size());
  for (const std::string& what : lost) {
    std::fprintf(stderr, "  left out: %s\n", shown(what).c_str());
  }
}

// `beside`: gets the names of other files that the input refers to, when they are read.
formats::ReadOptions reading_options(const ConvertOptions& options,
                                     std::vector<std::string>& beside) {
  formats::ReadOptions reading = read_options_for(options.input);
  reading.rotation = options.from_rotation ? options.from_rotation : reading.rotation;
  reading.timecode_fps =
      options.from_timecode_fps ? options.from_timecode_fps : reading.timecode_fps;
  reading.bvh_unit = options.from_bvh_unit;
  if (reading.load_beside) {
    reading.load_beside =
        [load = reading.load_beside, &beside, folder = path_of(options.input).parent_path()](
            const std::string& name, std::size_t bytes, std::string& data, std::string& why) {
          beside.push_back(name_of(folder / path_of(name)));
          return load(name, bytes, data, why);
        };
  }
  return reading;
}

}  // namespace

void convert(const ConvertOptions& options) {
  AnimationOptions asked;
  asked.files = {options.output};
  asked.writing = options.writing;
  asked.format_option = "--to";
  if (!options.to.empty()) {
    asked.formats = {options.to};
  }
  const AnimationTarget target = targets(asked).front();
  require_distinct_files({options.input, live_link_notes_of(options.input)}, files_of(target));
  std::optional<formats::AnimationFormat> from;
  if (!options.from.empty()) {
    from = format_asked_for(options.from);
  }
  std::vector<std::string> beside;
  Clip clip = parse_animation(read_whole(options.input), options.input, from,
                              reading_options(options, beside));
  require_distinct_files(beside, files_of(target));
  const std::vector<std::string> lost = fit(clip, options, target.format);
  const bool ids = std::any_of(clip.frames.begin(), clip.frames.end(),
                               [](const Frame& frame) { return frame.face_id != 0; });
  formats::WriteOptions writing = options.writing;
  writing.several_faces = ids && formats::holds_several_faces(target.format);
  writing.sound_file = clip.sound_file;
  AnimationOutput output(target, writing);
  for (std::size_t i = 0; i < clip.frames.size() && output.wanted(); ++i) {
    output.frame(clip.frames[i]);
  }
  output.finish();
  report(options, target.format, clip, lost);
}

}  // namespace mien::app
