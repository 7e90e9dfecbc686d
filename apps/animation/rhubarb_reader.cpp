// Reads mouth cues.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "apps/animation/json.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rhubarb.h"
#include "apps/animation/rhubarb_dat.h"
#include "apps/animation/xml.h"
#include "formats/vocabulary/visemes.h"

namespace mien::animation {
namespace {

constexpr const char* kNoShape = "unknown mouth shape, expected A to H or X";
constexpr const char* kDecreasingTime = "decreasing time";
constexpr const char* kNoCues = "mouthCues: no cues";

// Without surrounding blanks and line ends.
std::string_view stripped(std::string_view text) { return trimmed(text, " \t\r\n"); }

bool is_shape(std::string_view text) {
  return text.size() == 1 && formats::kMouthShapes.find(text[0]) != formats::kMouthShapes.npos;
}

// Rhubarb counts from the start of the audio.
bool cue_time(double seconds, std::int64_t& time_ns) {
  return seconds >= 0.0 && time_of(seconds, kSecond_ns, time_ns);
}

// `line` is reported if the clip takes too much memory.
bool add_cue(Clip& clip, std::int64_t begin_ns, char shape, std::size_t line, Fault& fault) {
  Frame frame;
  frame.number = static_cast<std::int64_t>(clip.frames.size());
  frame.time_ns = begin_ns;
  frame.mouth_shape = shape;
  frame.controls = formats::controls_of_visemes(formats::visemes_of_mouth_shape(shape));
  return add_frame(clip, frame, line, fault);
}

// Consecutive cues with end times. In gaps between them the mouth rests.
class Intervals {
 public:
  Intervals(Clip& clip, Fault& fault) : clip_(clip), fault_(fault) {}

  // Returns false with a fault, without a position if times decrease.
  bool add(std::int64_t begin_ns, std::int64_t end_ns, char shape) {
    if (!clip_.frames.empty() && begin_ns > end_ns_ && !add_cue(clip_, end_ns_, 'X', 1, fault_)) {
      return false;
    }
    end_ns_ = end_ns;
    return add_cue(clip_, begin_ns, shape, 1, fault_);
  }
  [[nodiscard]] bool goes_back(std::int64_t begin_ns, std::int64_t end_ns) const {
    return begin_ns < end_ns_ || end_ns < begin_ns;
  }
  bool finish() { return add_cue(clip_, end_ns_, 'X', 1, fault_); }

 private:
  Clip& clip_;
  Fault& fault_;
  std::int64_t end_ns_ = 0;
};

bool time_in(const JsonValue& cue, std::string_view key, std::int64_t& time_ns, Fault& fault) {
  const std::optional<JsonValue> found = cue.find(key);
  return (found && found->is(JsonValue::Kind::kNumber) && cue_time(found->number(), time_ns)) ||
         found.value_or(cue).fail_here(std::string(key) + ": expected a time in seconds", fault);
}

bool read_cue(const JsonValue& cue, Intervals& intervals, Fault& fault) {
  std::int64_t begin_ns = 0, end_ns = 0;
  if (!time_in(cue, "start", begin_ns, fault) || !time_in(cue, "end", end_ns, fault)) {
    return false;
  }
  if (intervals.goes_back(begin_ns, end_ns)) {
    return cue.fail_here(kDecreasingTime, fault);
  }
  const std::optional<JsonValue> shape = cue.find("value");
  const std::string text = shape ? shape->text() : "";
  if (!is_shape(text)) {
    return shape.value_or(cue).fail_here(std::string("value: ") + kNoShape, fault);
  }
  return intervals.add(begin_ns, end_ns, text[0]);
}

bool read_json(std::string_view text, Clip& clip, Fault& fault) {
  JsonDocument document;
  if (!document.parse(text, fault)) {
    return false;
  }
  const JsonValue root = document.root();
  const std::optional<JsonValue> cues = root.find("mouthCues");
  if (!cues || !cues->is(JsonValue::Kind::kArray) || cues->empty()) {
    return cues.value_or(root).fail_here(kNoCues, fault);
  }
  Intervals intervals(clip, fault);
  for (const JsonValue cue : cues->items()) {
    if (!read_cue(cue, intervals, fault)) {
      return false;
    }
  }
  const std::optional<JsonValue> metadata = root.find("metadata");
  const std::optional<JsonValue> sound = metadata ? metadata->find("soundFile") : std::nullopt;
  clip.audio_file = sound ? sound->text() : "";
  return intervals.finish();
}

class RhubarbXml {
 public:
  RhubarbXml(Clip& clip, Fault& fault) : clip_(clip), fault_(fault), intervals_(clip, fault) {}

  bool read(std::string_view text) {
    if (!parse_xml(
            text, [this](const XmlTag& tag) { return visit(tag); }, fault_)) {
      return false;
    }
    return clip_.frames.empty() ? fail(fault_, line_, column_, kNoCues) : intervals_.finish();
  }

 private:
  bool visit(const XmlTag& tag) {
    if (line_ == 0) {
      line_ = tag.line;
      column_ = tag.column;
      return tag.name == "rhubarbResult" || tag.fail_here("expected rhubarbResult", fault_);
    }
    if (!tag.closes && tag.name == "soundFile" && !has_audio_) {
      has_audio_ = true;
      clip_.audio_file = tag.text;
    }
    return tag.closes || tag.name != "mouthCue" || add_cue_of(tag);
  }

  bool add_cue_of(const XmlTag& cue) {
    std::int64_t begin_ns = 0, end_ns = 0;
    if (!time_in(cue, "start", begin_ns) || !time_in(cue, "end", end_ns)) {
      return false;
    }
    if (intervals_.goes_back(begin_ns, end_ns)) {
      return cue.fail_here(kDecreasingTime, fault_);
    }
    return is_shape(cue.text)
               ? intervals_.add(begin_ns, end_ns, cue.text[0])
               : cue.fail_here(std::string(kNoShape) + " (got " + quoted(cue.text) + ")", fault_);
  }

  bool time_in(const XmlTag& cue, std::string_view key, std::int64_t& time_ns) {
    const std::string* found = cue.find(key);
    double time_s = 0.0;
    return (found != nullptr && parse_number(*found, time_s) && cue_time(time_s, time_ns)) ||
           cue.fail_here(std::string(key) + ": expected a time in seconds", fault_);
  }

  Clip& clip_;
  Fault& fault_;
  Intervals intervals_;
  std::size_t line_ = 0, column_ = 0;  // of the root element
  bool has_audio_ = false;
};

// Lines one by one, without line ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line) {
    if (rest_.empty()) {
      return false;
    }
    line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
    ++number_;
    return true;
  }
  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

bool read_tsv(std::string_view text, Clip& clip, Fault& fault) {
  Lines lines(text);
  for (std::string_view row; lines.next(row);) {
    if (row.ends_with('\r')) {
      row.remove_suffix(1);
    }
    if (row.empty()) {
      continue;
    }
    const std::size_t tab = row.find('\t');
    double begin_s = 0.0;
    std::int64_t begin_ns = 0;
    if (!parse_number(row.substr(0, tab), begin_s) || !cue_time(begin_s, begin_ns)) {
      return fail(fault, lines.number(), 1,
                  quoted(row.substr(0, tab)) + " is not a time in seconds");
    }
    if (tab == std::string_view::npos || !is_shape(row.substr(tab + 1))) {
      const std::size_t at = tab == std::string_view::npos ? row.size() : tab + 1;
      return fail(fault, lines.number(), at + 1, kNoShape);
    }
    if (!clip.frames.empty() && begin_ns < clip.frames.last_time_ns()) {
      return fail(fault, lines.number(), 1, kDecreasingTime);
    }
    if (!add_cue(clip, begin_ns, row[tab + 1], lines.number(), fault)) {
      return false;
    }
  }
  return clip.frames.size() > 1 || fail(fault, lines.number() + 1, 1, "no cues");
}

// Returns 0 if the name is neither one of Rhubarb's letters nor, with `blair`, one of Preston
// Blair's names.
char dat_shape(std::string_view name, bool blair) {
  constexpr std::pair<std::string_view, char> kPrestonBlair[] = {
      {"MBP", 'A'}, {"etc", 'B'}, {"E", 'C'}, {"AI", 'D'},  {"O", 'E'},
      {"U", 'F'},   {"FV", 'G'},  {"L", 'H'}, {"rest", 'X'}};
  for (const auto& [known, shape] : kPrestonBlair) {
    if (blair && name == known) {
      return shape;
    }
  }
  return !blair && is_shape(name) ? name[0] : '\0';
}

// Whether this is one of Preston Blair's names. "E" is in both alphabets, so the rest of the file
// decides: it ends with "rest" or X.
bool named_after_blair(std::string_view name, std::string_view rest) {
  return name == "E" ? stripped(rest).ends_with("rest") : !is_shape(name);
}

bool read_dat(std::string_view text, Clip& clip, Fault& fault) {
  Lines lines(text);
  std::int64_t last = 0;
  std::optional<bool> blair;
  for (std::string_view line; lines.next(line);) {
    const std::string_view row = stripped(line);
    if (lines.number() == 1 || row.empty()) {
      continue;  // the first line identifies the format
    }
    const std::size_t space = std::min(row.find(' '), row.size());
    std::int64_t frame = 0;
    if (!parse_number(row.substr(0, space), frame) || frame < 1 ||
        frame > dat_frame(kLastTime_ns)) {
      return fail(fault, lines.number(), 1,
                  quoted(row.substr(0, space)) + " is not a frame, 1 or later");
    }
    const std::string_view name = trimmed(row.substr(space));
    blair = blair.has_value() ? blair : named_after_blair(name, lines.rest());
    const char shape = dat_shape(name, *blair);
    if (shape == '\0') {
      return fail(fault, lines.number(), std::min(space + 1, row.size()) + 1,
                  "unknown mouth shape, expected a name of Rhubarb or Preston Blair");
    }
    if (frame <= last) {
      return fail(fault, lines.number(), 1, kDecreasingTime);
    }
    last = frame;
    if (!add_cue(clip, dat_time(frame), shape, lines.number(), fault)) {
      return false;
    }
  }
  return clip.frames.size() > 1 || fail(fault, lines.number() + 1, 1, "no cues");
}

bool read_form(std::string_view text, Clip& clip, Fault& fault) {
  const std::string_view start = stripped(text);
  return start.starts_with('{')        ? read_json(text, clip, fault)
         : start.starts_with('<')      ? RhubarbXml(clip, fault).read(text)
         : start.starts_with(kDatHead) ? read_dat(text, clip, fault)
                                       : read_tsv(text, clip, fault);
}

}  // namespace

bool read_rhubarb(std::string_view text, Clip& clip, Fault& fault) {
  Clip read;
  read.frames.limit_bytes(max_clip_bytes(text.size()));
  if (!read_form(text, read, fault)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::animation
