#include "formats/animation/rhubarb.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "formats/animation/json.h"
#include "formats/animation/numbers.h"
#include "formats/animation/visemes.h"
#include "formats/animation/xml.h"

namespace mien::formats {
namespace {

using Kind = JsonValue::Kind;

// Without blanks and ends of lines around it.
std::string_view stripped(std::string_view text) { return trimmed(text, " \t\r\n"); }

constexpr std::int64_t kShortest_ns = 80'000'000;

struct Cue {
  std::int64_t begin_ns;
  char shape;
};

struct Cues {
  std::vector<Cue> cues;
  std::int64_t end_ns = 0;

  [[nodiscard]] std::int64_t end_of(std::size_t i) const {
    return i + 1 < cues.size() ? cues[i + 1].begin_ns : end_ns;
  }
};

void add(std::vector<Cue>& cues, const Cue& cue) {
  if (cues.empty() || cues.back().shape != cue.shape) {
    cues.push_back(cue);
  }
}

// A whole second, so that it is allowed in hundredths and in frames, too, and with a frame behind
// it.
constexpr std::int64_t kLastCue_ns = kLastTime_ns - kLastTime_ns % kSecond_ns;

// Rhubarb counts from the beginning of the sound, and has nothing before it: a clip that begins
// earlier is moved to there.
class Clock {
 public:
  explicit Clock(const std::vector<Frame>& frames)
      : begin_ns_(std::min<std::int64_t>(frames.front().time_ns, 0)) {}
  [[nodiscard]] std::int64_t at(const Frame& frame) const {
    return std::min(frame.time_ns - begin_ns_, kLastCue_ns);
  }

 private:
  std::int64_t begin_ns_;
};

// Cues as a file had them: the last frame is where they end.
Cues cues_as_read(const std::vector<Frame>& frames) {
  const Clock clock(frames);
  Cues made;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    add(made.cues, {clock.at(frames[i]), frames[i].mouth_shape});
  }
  made.end_ns = clock.at(frames.back());
  return made;
}

char shape_seen(const Frame& frame) {
  if (frame.mouth_shape != 0) {
    return frame.mouth_shape;
  }
  if (!frame.visemes.empty()) {
    return mouth_shape_of(std::span<const double, kVisemeCount>(frame.visemes));
  }
  return mouth_shape_of(visemes_of(frame.controls));
}

Cues cues_seen(const std::vector<Frame>& frames) {
  const Clock clock(frames);
  Cues made;
  if (frames.front().time_ns > 0) {
    add(made.cues, {0, 'X'});
  }
  for (const Frame& frame : frames) {
    add(made.cues, {clock.at(frame), shape_seen(frame)});
  }
  // At most twice what is allowed, which still fits.
  const double step_ns = std::min(mean_step_s(frames) * 1e9, static_cast<double>(kLastCue_ns));
  const std::int64_t end_ns = clock.at(frames.back()) + std::llround(step_ns);
  made.end_ns = std::min(end_ns, kLastCue_ns);
  std::vector<Cue> lasting;
  for (std::size_t i = 0; i < made.cues.size(); ++i) {
    if (lasting.empty() || made.end_of(i) - made.cues[i].begin_ns >= kShortest_ns) {
      add(lasting, made.cues[i]);
    }
  }
  made.cues = std::move(lasting);
  return made;
}

Cues cues_of(const std::vector<Frame>& frames) {
  if (frames.empty()) {
    return {};
  }
  const bool read = std::all_of(frames.begin(), frames.end(),
                                [](const Frame& frame) { return frame.mouth_shape != 0; });
  return read && frames.size() > 1 ? cues_as_read(frames) : cues_seen(frames);
}

std::string seconds(std::int64_t time_ns) { return fixed(static_cast<double>(time_ns) * 1e-9, 2); }

constexpr std::string_view kDatHead = "MohoSwitch1";
constexpr std::int64_t kDatFps = 24;

// Frames count from 1; times of frames were rounded to a nanosecond.
std::int64_t dat_frame(std::int64_t time_ns) {
  const std::int64_t second = (time_ns + 1) / kSecond_ns, rest_ns = (time_ns + 1) % kSecond_ns;
  return 1 + second * kDatFps + rest_ns * kDatFps / kSecond_ns;
}

// The other way.
std::int64_t dat_time(std::int64_t frame) {
  const std::int64_t second = (frame - 1) / kDatFps, rest = (frame - 1) % kDatFps;
  return second * kSecond_ns + (rest * kSecond_ns + kDatFps / 2) / kDatFps;
}

class RhubarbWriter : public WholeClipWriter {
 public:
  RhubarbWriter(RhubarbForm form, const std::string& sound_file)
      : form_(form), sound_file_(sound_file) {}

 protected:
  std::string whole(const std::vector<Frame>& frames) override {
    const Cues cues = cues_of(frames);
    switch (form_) {
      case RhubarbForm::kTsv:
        return tsv(cues);
      case RhubarbForm::kJson:
        return json(cues);
      case RhubarbForm::kXml:
        return xml(cues);
      case RhubarbForm::kDat:
        return dat(cues);
    }
    return {};
  }

 private:
  static std::string tsv(const Cues& cues) {
    std::string text;
    for (const Cue& cue : cues.cues) {
      text += seconds(cue.begin_ns) + "\t" + cue.shape + "\n";
    }
    return text + seconds(cues.end_ns) + "\tX\n";
  }

  std::string json(const Cues& cues) const {
    std::string text = "{\n  \"metadata\": {\n    \"soundFile\": " + json_string(sound_file_) +
                       ",\n    \"duration\": " + seconds(cues.end_ns) +
                       "\n  },\n  \"mouthCues\": [";
    for (std::size_t i = 0; i < cues.cues.size(); ++i) {
      const std::int64_t end = cues.end_of(i);
      text += std::string(i == 0 ? "\n" : ",\n") +
              "    { \"start\": " + seconds(cues.cues[i].begin_ns) + ", \"end\": " + seconds(end) +
              ", \"value\": \"" + cues.cues[i].shape + "\" }";
    }
    return text + "\n  ]\n}\n";
  }

  std::string xml(const Cues& cues) const {
    std::string text =
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<rhubarbResult>\n  <metadata>\n    "
        "<soundFile>" +
        xml_text(sound_file_) + "</soundFile>\n    <duration>" + seconds(cues.end_ns) +
        "</duration>\n  </metadata>\n  <mouthCues>\n";
    for (std::size_t i = 0; i < cues.cues.size(); ++i) {
      text += "    <mouthCue start=\"" + seconds(cues.cues[i].begin_ns) + "\" end=\"" +
              seconds(cues.end_of(i)) + "\">" + cues.cues[i].shape + "</mouthCue>\n";
    }
    return text + "  </mouthCues>\n</rhubarbResult>\n";
  }

  // Of cues that begin in the same frame the first counts, as Rhubarb has it.
  static std::string dat(const Cues& cues) {
    std::string text = std::string(kDatHead) + "\n";
    std::int64_t last = 0;
    for (const Cue& cue : cues.cues) {
      const std::int64_t frame = dat_frame(cue.begin_ns);
      if (frame != last) {
        text += std::to_string(frame) + " " + cue.shape + "\n";
        last = frame;
      }
    }
    return text + std::to_string(std::max(dat_frame(cues.end_ns), last + 1)) + " X\n";
  }

  RhubarbForm form_;
  std::string sound_file_;
};

bool is_shape(std::string_view text) {
  return text.size() == 1 && kMouthShapes.find(text[0]) != kMouthShapes.npos;
}

// Rhubarb counts from the beginning of the sound.
bool cue_time(double seconds, std::int64_t& time_ns) {
  return seconds >= 0.0 && time_of(seconds, kSecond_ns, time_ns);
}

Frame cue_frame(std::int64_t begin_ns, char shape, std::size_t number) {
  Frame frame;
  frame.number = static_cast<std::int64_t>(number);
  frame.time_ns = begin_ns;
  frame.mouth_shape = shape;
  frame.controls = controls_of_visemes(visemes_of_mouth_shape(shape));
  return frame;
}

// Where a cue does not begin at the end of the one before it, the mouth rests in between.
void add_cue(Clip& clip, std::int64_t before_end_ns, std::int64_t begin_ns, char shape) {
  if (!clip.frames.empty() && begin_ns > before_end_ns) {
    clip.frames.push_back(cue_frame(before_end_ns, 'X', clip.frames.size()));
  }
  clip.frames.push_back(cue_frame(begin_ns, shape, clip.frames.size()));
}

bool read_tsv(std::string_view text, Clip& clip, Fault& fault) {
  std::size_t line = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view row = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line;
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
      return fail(fault, line, 1, quoted(row.substr(0, tab)) + " is not a time in seconds");
    }
    if (tab == std::string_view::npos || !is_shape(row.substr(tab + 1))) {
      const std::size_t at = tab == std::string_view::npos ? row.size() : tab + 1;
      return fail(fault, line, at + 1, "is none of the shapes A to H and X");
    }
    clip.frames.push_back(cue_frame(begin_ns, row[tab + 1], clip.frames.size()));
    const std::size_t count = clip.frames.size();
    if (count > 1 && clip.frames[count - 1].time_ns < clip.frames[count - 2].time_ns) {
      return fail(fault, line, 1, "goes back in time");
    }
  }
  return clip.frames.size() > 1 || fail(fault, line + 1, 1, "there are no cues");
}

bool time_in(const JsonValue& cue, std::string_view key, std::int64_t& time_ns, Fault& fault) {
  const JsonValue* found = cue.find(key);
  return (found != nullptr && found->is(Kind::kNumber) && cue_time(found->number, time_ns)) ||
         (found == nullptr ? cue : *found)
             .fail_here(std::string(key) + ": a time in seconds has to be here", fault);
}

bool read_json(std::string_view text, Clip& clip, Fault& fault) {
  JsonValue root;
  if (!parse_json(text, root, fault)) {
    return false;
  }
  const JsonValue* cues = root.find("mouthCues");
  if (cues == nullptr || !cues->is(Kind::kArray) || cues->items.empty()) {
    return (cues == nullptr ? root : *cues).fail_here("mouthCues: there are no cues", fault);
  }
  std::int64_t end_ns = 0;
  for (const JsonValue& cue : cues->items) {
    std::int64_t begin_ns = 0;
    const std::int64_t before_ns = end_ns;
    if (!time_in(cue, "start", begin_ns, fault) || !time_in(cue, "end", end_ns, fault)) {
      return false;
    }
    if (begin_ns < before_ns || end_ns < begin_ns) {
      return cue.fail_here("goes back in time", fault);
    }
    const JsonValue* shape = cue.find("value");
    if (shape == nullptr || !is_shape(shape->text)) {
      return (shape == nullptr ? cue : *shape)
          .fail_here("value: is none of the shapes A to H and X", fault);
    }
    add_cue(clip, before_ns, begin_ns, shape->text[0]);
  }
  clip.frames.push_back(cue_frame(end_ns, 'X', clip.frames.size()));
  const JsonValue* metadata = root.find("metadata");
  const JsonValue* sound = metadata != nullptr ? metadata->find("soundFile") : nullptr;
  clip.sound_file = sound != nullptr ? sound->text : "";
  return true;
}

// The first text between such tags.
std::string text_of(const std::vector<XmlTag>& tags, std::string_view name) {
  const auto found = std::find_if(tags.begin(), tags.end(), [name](const XmlTag& tag) {
    return tag.name == name && !tag.closes;
  });
  return found != tags.end() ? found->text : "";
}

bool time_in(const XmlTag& cue, std::string_view key, std::int64_t& time_ns, Fault& fault) {
  const std::string* found = cue.find(key);
  double time_s = 0.0;
  return (found != nullptr && parse_number(*found, time_s) && cue_time(time_s, time_ns)) ||
         cue.fail_here(std::string(key) + ": a time in seconds has to be here", fault);
}

bool read_xml(std::string_view text, Clip& clip, Fault& fault) {
  std::vector<XmlTag> tags;
  if (!parse_xml(text, tags, fault)) {
    return false;
  }
  if (tags.front().name != "rhubarbResult") {
    return tags.front().fail_here("rhubarbResult has to be here", fault);
  }
  std::int64_t end_ns = 0;
  for (const XmlTag& tag : tags) {
    if (tag.name != "mouthCue" || tag.closes) {
      continue;
    }
    std::int64_t begin_ns = 0;
    const std::int64_t before_ns = end_ns;
    if (!time_in(tag, "start", begin_ns, fault) || !time_in(tag, "end", end_ns, fault)) {
      return false;
    }
    if (begin_ns < before_ns || end_ns < begin_ns) {
      return tag.fail_here("goes back in time", fault);
    }
    if (!is_shape(tag.text)) {
      return tag.fail_here(quoted(tag.text) + " is none of the shapes A to H and X", fault);
    }
    add_cue(clip, before_ns, begin_ns, tag.text[0]);
  }
  if (clip.frames.empty()) {
    return tags.front().fail_here("mouthCues: there are no cues", fault);
  }
  clip.frames.push_back(cue_frame(end_ns, 'X', clip.frames.size()));
  clip.sound_file = text_of(tags, "soundFile");
  return true;
}

// 0 where it is neither one of Rhubarb's letters nor, with `blair`, what it calls them after
// Preston Blair.
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

// Whether this is the name of one of Preston Blair's mouths. "E" is in both alphabets: then the
// rest of the file tells, which has a rest or an X at its end.
bool named_after_blair(std::string_view name, std::string_view rest) {
  return name == "E" ? stripped(rest).ends_with("rest") : !is_shape(name);
}

bool read_dat(std::string_view text, Clip& clip, Fault& fault) {
  std::size_t line = 0;
  std::int64_t last = 0;
  std::optional<bool> blair;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view row = stripped(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (++line == 1 || row.empty()) {
      continue;  // the first is what it was known by
    }
    const std::size_t space = std::min(row.find(' '), row.size());
    std::int64_t frame = 0;
    if (!parse_number(row.substr(0, space), frame) || frame < 1 ||
        frame > dat_frame(kLastTime_ns)) {
      return fail(fault, line, 1, quoted(row.substr(0, space)) + " is not a frame, 1 or later");
    }
    const std::string_view name = trimmed(row.substr(space));
    if (!blair) {
      blair = named_after_blair(name, text);
    }
    const char shape = dat_shape(name, *blair);
    if (shape == '\0') {
      return fail(fault, line, std::min(space + 1, row.size()) + 1,
                  "is no mouth of Rhubarb's or Preston Blair's");
    }
    if (frame <= last) {
      return fail(fault, line, 1, "goes back in time");
    }
    last = frame;
    clip.frames.push_back(cue_frame(dat_time(frame), shape, clip.frames.size()));
  }
  return clip.frames.size() > 1 || fail(fault, line + 1, 1, "there are no cues");
}

bool read_form(std::string_view text, Clip& clip, Fault& fault) {
  const std::string_view start = stripped(text);
  return start.starts_with('{')        ? read_json(text, clip, fault)
         : start.starts_with('<')      ? read_xml(text, clip, fault)
         : start.starts_with(kDatHead) ? read_dat(text, clip, fault)
                                       : read_tsv(text, clip, fault);
}

}  // namespace

std::unique_ptr<AnimationWriter> rhubarb_writer(RhubarbForm form, const std::string& sound_file) {
  return std::make_unique<RhubarbWriter>(form, sound_file);
}

bool read_rhubarb(std::string_view text, Clip& clip, Fault& fault) {
  Clip read;
  if (!read_form(text, read, fault)) {
    return false;
  }
  clip = std::move(read);
  return true;
}

}  // namespace mien::formats
