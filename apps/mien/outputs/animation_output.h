// Files of an animated face, in whatever format.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/mien/outputs/output_file.h"
#include "formats/animation/animation.h"

namespace mien::app {

inline constexpr const char* kStandardOutput = "-";

// What a person says of an animation that is to be written.
struct AnimationOptions {
  std::vector<std::string> files;    // none: standard output
  std::vector<std::string> formats;  // names of them; none: by the files' endings
  formats::WriteOptions writing;
  const char* format_option = "--format";  // for messages
};

struct AnimationTarget {
  std::string file;
  formats::AnimationFormat format;
};

// One for each file. A file without an ending, as a device or a pipe, is CSV. Throws
// Failure(kExitUsage) where it cannot be told what is meant.
std::vector<AnimationTarget> targets(const AnimationOptions& options);

// Throws Failure(kExitUsage) where there is no such format.
formats::AnimationFormat format_asked_for(const std::string& name);

// The files that are written for it, the animation first.
std::vector<std::string> files_of(const AnimationTarget& target);

class AnimationOutput {
 public:
  // Throws Failure(kExitOutput), as the others.
  AnimationOutput(const AnimationTarget& target, const formats::WriteOptions& options);

  void frame(const formats::Frame& frame);
  void finish();

  // Whether there is anybody to write for: a reader of standard output may have gone.
  [[nodiscard]] bool wanted() const { return wanted_; }

 private:
  void write(const std::string& text);

  std::unique_ptr<formats::AnimationWriter> writer_;
  std::unique_ptr<OutputFile> file_;    // none: standard output
  std::unique_ptr<OutputFile> beside_;  // what the file itself cannot say
  bool wanted_ = true;
};

}  // namespace mien::app
