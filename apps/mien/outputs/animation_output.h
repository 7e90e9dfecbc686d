// Writes animations in any supported format.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/mien/outputs/output_file.h"

namespace mien::app {

inline constexpr const char* kStandardOutput = "-";

// Options of animations to write.
struct AnimationOptions {
  std::vector<std::string> files;    // empty: standard output
  std::vector<std::string> formats;  // format names; empty: selected by the endings of `files`
  animation::WriteOptions writing;
  std::string avatar;             // file into which .glb files bake the animation; empty: none
  bool avatar_in_report = false;  // which needs no .glb file
  const char* format_option = "--format";  // the option's name in messages
};

struct AnimationTarget {
  std::string file;
  animation::AnimationFormat format;
  std::string avatar;  // of a .glb; empty: none
};

// One target per file. A file without an ending, such as a device or a pipe, is CSV. Throws
// Failure(kExitUsage) for an unknown format, a duplicate file, or an avatar without a .glb.
std::vector<AnimationTarget> targets(const AnimationOptions& options);

// Throws Failure(kExitUsage) for an unknown format.
animation::AnimationFormat format_asked_for(const std::string& name);

// The files written for a target, the animation first.
std::vector<std::string> files_of(const AnimationTarget& target);

class AnimationOutput {
 public:
  // All functions throw Failure(kExitOutput) if writing fails.
  AnimationOutput(const AnimationTarget& target, const animation::WriteOptions& options);

  void frame(const animation::Frame& frame);
  void finish();

  // False after the reader of standard output has closed it.
  [[nodiscard]] bool wanted() const { return wanted_; }

 private:
  void write(const std::string& text);

  std::unique_ptr<animation::AnimationWriter> writer_;
  std::unique_ptr<OutputFile> file_;    // null: standard output
  std::unique_ptr<OutputFile> beside_;  // units that the format does not contain
  bool wanted_ = true;
};

}  // namespace mien::app
