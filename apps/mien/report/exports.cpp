// Writes animations in all formats.
#include "apps/mien/report/exports.h"

#include <utility>

#include "apps/mien/pages/packed_text.h"

namespace mien::app {
namespace {

// Passes the file to `take` in parts.
template <typename Take>
void write(const std::vector<animation::Frame>& frames, animation::AnimationWriter& writer,
           Take take) {
  take(writer.begin());
  for (const animation::Frame& frame : frames) {
    take(writer.frame(frame));
  }
  take(writer.finish());
}

}  // namespace

std::string block(const std::string& id, const std::string& base64) {
  return "<script type=\"text/plain\" id=\"" + id + "\">" + base64 + "</script>\n";
}

Exports exports_of(const std::vector<animation::Frame>& frames,
                   const animation::WriteOptions& writing, const std::string& stem,
                   std::unique_ptr<animation::AnimationWriter> glb) {
  using animation::AnimationFormat;
  Exports exports;
  const bool glb_holds_gltf = glb == nullptr;  // the same avatar, from which the page makes .gltf
  for (const animation::FormatName& format : animation::kFormatNames) {
    auto writer = format.format == AnimationFormat::kGlb && glb
                      ? std::move(glb)
                      : animation::animation_writer(format.format, writing);
    std::uint64_t bytes = 0;
    PackedText packed;
    const bool stored = format.format != AnimationFormat::kGltf || !glb_holds_gltf;
    write(frames, *writer, [&](const std::string& part) {
      bytes += part.size();
      if (stored) {
        packed.write(part);
      }
    });
    exports.list.push_back({{"format", format.name},
                            {"file", stem + std::string(format.ending)},
                            {"holds", format.holds},
                            {"bytes", bytes}});
    if (stored) {
      exports.blocks += block("export-" + std::string(format.name), packed.finish());
    }
  }
  return exports;
}

}  // namespace mien::app
