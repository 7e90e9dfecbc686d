// Converts animations and reports omitted data.
#include "apps/mien/convert/convert.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "apps/mien/convert/even_frames.h"
#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/sources/animation_file.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"

namespace mien::app {
namespace {

using animation::Clip;
using animation::Frame;
using animation::FrameSequence;

// The number of frames of each face. Frames without an id belong to the face of the following
// frame.
using Faces = std::map<std::int64_t, std::size_t>;

Faces count_faces(const FrameSequence& frames) {
  Faces faces;
  for (const Frame& frame : frames) {
    ++faces[frame.face_id];
  }
  return faces;
}

std::size_t count_with_id(const Faces& faces) { return faces.size() - (faces.contains(0) ? 1 : 0); }

std::int64_t most_frequent(const Faces& faces) {
  const auto most_frequent =
      std::max_element(faces.begin(), faces.end(), [](const auto& a, const auto& b) {
        return std::pair(a.first != 0, a.second) < std::pair(b.first != 0, b.second);
      });
  return most_frequent->first;
}

// The frames of face `id`, and those without a face.
FrameSequence only(FrameSequence frames, std::int64_t id) {
  FrameSequence kept;
  frames.consume([&](const Frame& frame) {
    if (frame.face_id == id || frame.face_id == 0) {
      kept.push_back(frame);
    }
  });
  return kept;
}

// Keeps one face if one was requested or the format supports one only, and records the omission.
void choose_face(Clip& clip, const ConvertOptions& options, animation::AnimationFormat format,
                 std::vector<std::string>& lost) {
  const Faces faces = count_faces(clip.frames);
  if (options.face && !faces.contains(*options.face)) {
    throw Failure(kExitUsage,
                  "--face: unknown face " + std::to_string(*options.face) + " in " + options.input);
  }
  const bool too_many = count_with_id(faces) > 1 && !animation::holds_several_faces(format);
  if (options.face || too_many) {
    const std::int64_t id = options.face.value_or(most_frequent(faces));
    clip.frames = only(std::move(clip.frames), id);
    if (!options.face) {
      lost.push_back("all faces but " + std::to_string(id) + ", the most frequent one (--face)");
    }
  }
  if (clip.out_of_range > 0) {
    lost.push_back(std::to_string(clip.out_of_range) + " values clamped to 0..1");
  }
}

// Writes the frames of a clip.
class ClipWriter {
 public:
  ClipWriter(const AnimationTarget& target, const animation::WriteOptions& options)
      : losses_(target.format), output_(target, options) {}

  void write(const FrameSequence& frames) {
    evenly_spaced_ = animation::evenly_spaced(frames);
    for (auto at = frames.begin(); at != FrameSequence::end() && output_.wanted(); ++at) {
      write_frame(*at);
    }
    output_.finish();
  }

  void write(EvenFrames& frames) {
    evenly_spaced_ = true;
    while (const std::optional<Frame> frame = output_.wanted() ? frames.next() : std::nullopt) {
      write_frame(*frame);
    }
    output_.finish();
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::vector<std::string> lost() const { return losses_.found(evenly_spaced_); }

 private:
  void write_frame(const Frame& frame) {
    losses_.add(frame);
    output_.frame(frame);
    ++count_;
  }

  animation::Losses losses_;
  AnimationOutput output_;
  std::size_t count_ = 0;
  bool evenly_spaced_ = false;
};

void report(const ConvertOptions& options, animation::AnimationFormat format, const Clip& clip,
            std::size_t frames, const std::vector<std::string>& lost) {
  if (options.json) {
    const nlohmann::ordered_json text = {
        {"input", options.input}, {"output", options.output}, {"format", animation::name(format)},
        {"frames", frames},       {"notes", clip.notes},      {"left_out", lost}};
    std::fprintf(stderr, "%s\n", json_text(text, -1).c_str());
    return;
  }
  if (options.quiet) {
    return;
  }
  print_notes(options.input, clip);
  std::fprintf(stderr, "%s: %zu frames\n", printable(options.output).c_str(), frames);
  for (const std::string& what : lost) {
    std::fprintf(stderr, "  omitted: %s\n", printable(what).c_str());
  }
}

// `beside` receives the names of other files that the input refers to, when they are read.
animation::ReadOptions reading_options(const ConvertOptions& options,
                                       std::vector<std::string>& beside) {
  animation::ReadOptions reading = read_options_for(options.input);
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
  AnimationOptions animation;
  animation.files = {options.output};
  animation.writing = options.writing;
  animation.avatar = options.avatar;
  animation.format_option = "--to";
  if (!options.to.empty()) {
    animation.formats = {options.to};
  }
  const AnimationTarget target = targets(animation).front();
  require_distinct_files({options.input, live_link_notes_of(options.input), options.avatar},
                         files_of(target));
  std::optional<animation::AnimationFormat> from;
  if (!options.from.empty()) {
    from = format_asked_for(options.from);
  }
  std::vector<std::string> beside;
  Clip clip = parse_animation(read_whole(options.input), options.input, from,
                              reading_options(options, beside));
  require_distinct_files(beside, files_of(target));
  std::vector<std::string> lost;
  choose_face(clip, options, target.format, lost);
  animation::WriteOptions writing = options.writing;
  writing.several_faces =
      count_with_id(count_faces(clip.frames)) > 0 && animation::holds_several_faces(target.format);
  writing.audio_file = clip.audio_file;
  std::optional<EvenFrames> even;
  if (options.fps) {
    even.emplace(std::move(clip.frames), *options.fps);
  }
  ClipWriter writer(target, writing);
  even ? writer.write(*even) : writer.write(clip.frames);
  const std::vector<std::string> of_format = writer.lost();
  lost.insert(lost.end(), of_format.begin(), of_format.end());
  if (!target.avatar.empty()) {
    lost.emplace_back("everything but the controls, head and eyes that the avatar has");
  }
  report(options, target.format, clip, writer.count(), lost);
}

}  // namespace mien::app
