// Writes animations in all formats.
#include "apps/mien/report/exports.h"

#include "apps/mien/pages/packed_text.h"

namespace mien::app {
namespace {

PackedText written(const std::vector<animation::Frame>& frames, animation::AnimationFormat format,
                   const animation::WriteOptions& writing) {
  const auto writer = animation::animation_writer(format, writing);
  PackedText text;
  text.write(writer->begin());
  for (const animation::Frame& frame : frames) {
    text.write(writer->frame(frame));
  }
  text.write(writer->finish());
  return text;
}

}  // namespace

std::string block(const std::string& id, const std::string& base64) {
  return "<script type=\"text/plain\" id=\"" + id + "\">" + base64 + "</script>\n";
}

Exports exports_of(const std::vector<animation::Frame>& frames,
                   const animation::WriteOptions& writing, const std::string& stem) {
  Exports exports;
  for (const animation::FormatName& format : animation::kFormatNames) {
    PackedText text = written(frames, format.format, writing);
    exports.list.push_back({{"format", format.name},
                            {"file", stem + std::string(format.ending)},
                            {"holds", format.holds},
                            {"bytes", text.bytes()}});
    exports.blocks += block("export-" + std::string(format.name), text.finish());
  }
  return exports;
}

}  // namespace mien::app
