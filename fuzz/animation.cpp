// The bytes are an animation: in the format that their content indicates, and in every other.
#include "apps/animation/animation.h"

#include <string_view>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace formats = mien::formats;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  formats::Clip clip;
  formats::Fault fault;
  if (formats::read_animation(formats::format_by_content(bytes), bytes, {}, clip, fault)) {
    // An accepted animation can be written in every format.
    for (const formats::FormatName& known : formats::kFormatNames) {
      const auto writer = formats::animation_writer(known.format, {});
      std::size_t written = writer->begin().size();
      std::size_t count = 0;
      for (const formats::Frame& frame : clip.frames) {
        written += writer->frame(frame).size();
        if (++count == 50) {
          break;
        }
      }
      if (written + writer->finish().size() == 0) {
        __builtin_trap();
      }
      static_cast<void>(formats::losses(clip, known.format));
    }
  }
  for (const formats::FormatName& known : formats::kFormatNames) {
    static_cast<void>(formats::read_animation(known.format, bytes, {}, clip, fault));
  }
  return 0;
}
