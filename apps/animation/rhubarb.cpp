// Writes mouth cues.
#include "apps/animation/rhubarb.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "apps/animation/json.h"
#include "apps/animation/numbers.h"
#include "apps/animation/rhubarb_dat.h"
#include "apps/animation/xml.h"
#include "formats/vocabulary/visemes.h"

namespace mien::animation {
namespace {

constexpr std::int64_t kMinCue_ns = 80'000'000;

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

// A whole second, so that it is representable in hundredths and frames as well, with a frame after
// it.
constexpr std::int64_t kLastCue_ns = kLastTime_ns - kLastTime_ns % kSecond_ns;

// Rhubarb counts from the start of the audio and has no negative times, so a clip that starts
// earlier is shifted.
class Clock {
 public:
  explicit Clock(const FrameSequence& frames)
      : begin_ns_(std::min<std::int64_t>(frames.first_time_ns(), 0)) {}
  [[nodiscard]] std::int64_t at(std::int64_t time_ns) const {
    return std::min(time_ns - begin_ns_, kLastCue_ns);
  }

 private:
  std::int64_t begin_ns_;
};

// Cues as read from a file: the last frame is their end.
Cues cues_as_read(const FrameSequence& frames) {
  const Clock clock(frames);
  Cues result;
  std::size_t left = frames.size();
  for (const Frame& frame : frames) {
    if (--left > 0) {
      add(result.cues, {clock.at(frame.time_ns), frame.mouth_shape});
    }
  }
  result.end_ns = clock.at(frames.last_time_ns());
  return result;
}

char shape_of(const Frame& frame) {
  if (frame.mouth_shape != 0) {
    return frame.mouth_shape;
  }
  if (!frame.visemes.empty()) {
    return formats::mouth_shape_of(std::span<const double, formats::kVisemeCount>(frame.visemes));
  }
  return formats::mouth_shape_of(formats::visemes_of(frame.controls));
}

Cues cues_from_visemes(const FrameSequence& frames) {
  const Clock clock(frames);
  Cues result;
  if (frames.first_time_ns() > 0) {
    add(result.cues, {0, 'X'});
  }
  for (const Frame& frame : frames) {
    add(result.cues, {clock.at(frame.time_ns), shape_of(frame)});
  }
  // At most twice the allowed range, which does not overflow.
  const double step_ns = std::min(mean_step_s(frames) * 1e9, static_cast<double>(kLastCue_ns));
  const std::int64_t end_ns = clock.at(frames.last_time_ns()) + std::llround(step_ns);
  result.end_ns = std::min(end_ns, kLastCue_ns);
  std::vector<Cue> lasting;
  for (std::size_t i = 0; i < result.cues.size(); ++i) {
    if (lasting.empty() || result.end_of(i) - result.cues[i].begin_ns >= kMinCue_ns) {
      add(lasting, result.cues[i]);
    }
  }
  result.cues = std::move(lasting);
  return result;
}

Cues cues_of(const FrameSequence& frames) {
  if (frames.empty()) {
    return {};
  }
  bool read = true;
  for (const Frame& frame : frames) {
    read = read && frame.mouth_shape != 0;
  }
  return read && frames.size() > 1 ? cues_as_read(frames) : cues_from_visemes(frames);
}

std::string seconds(std::int64_t time_ns) { return fixed(static_cast<double>(time_ns) * 1e-9, 2); }

class RhubarbWriter : public WholeClipWriter {
 public:
  RhubarbWriter(RhubarbForm form, const std::string& audio_file)
      : form_(form), audio_file_(audio_file) {}

 protected:
  std::string whole(const FrameSequence& frames) override {
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
    std::string text = "{\n  \"metadata\": {\n    \"soundFile\": " + json_string(audio_file_) +
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
        xml_text(audio_file_) + "</soundFile>\n    <duration>" + seconds(cues.end_ns) +
        "</duration>\n  </metadata>\n  <mouthCues>\n";
    for (std::size_t i = 0; i < cues.cues.size(); ++i) {
      text += "    <mouthCue start=\"" + seconds(cues.cues[i].begin_ns) + "\" end=\"" +
              seconds(cues.end_of(i)) + "\">" + cues.cues[i].shape + "</mouthCue>\n";
    }
    return text + "  </mouthCues>\n</rhubarbResult>\n";
  }

  // Of cues that start in the same frame the first one counts, as in Rhubarb.
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
  std::string audio_file_;
};

}  // namespace

std::unique_ptr<AnimationWriter> rhubarb_writer(RhubarbForm form, const std::string& audio_file) {
  return std::make_unique<RhubarbWriter>(form, audio_file);
}

}  // namespace mien::animation
