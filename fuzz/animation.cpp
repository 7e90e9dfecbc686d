// The bytes are an animation: in the format that their content indicates, and in every other.
#include "apps/animation/animation.h"

#include <string_view>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace animation = mien::animation;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  animation::Clip clip;
  animation::Fault fault;
  if (animation::read_animation(animation::format_by_content(bytes), bytes, {}, clip, fault)) {
    // An accepted animation can be written in every format.
    for (const animation::FormatName& known : animation::kFormatNames) {
      const auto writer = animation::animation_writer(known.format, {});
      std::size_t written = writer->begin().size();
      std::size_t count = 0;
      for (const animation::Frame& frame : clip.frames) {
        written += writer->frame(frame).size();
        if (++count == 50) {
          break;
        }
      }
      if (written + writer->finish().size() == 0) {
        __builtin_trap();
      }
      static_cast<void>(animation::losses(clip, known.format));
    }
  }
  for (const animation::FormatName& known : animation::kFormatNames) {
    static_cast<void>(animation::read_animation(known.format, bytes, {}, clip, fault));
  }
  return 0;
}
