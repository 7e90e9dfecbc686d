// Reads Y4M video: parses the stream and frame headers, then the planes.
#include "formats/y4m.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>

namespace mien::formats {
namespace {

struct Line {
  std::array<char, kMaxY4mHeaderBytes> text;
  std::size_t bytes = 0;
  bool ended = false;  // by a newline, which `text` excludes

  std::string_view view() const { return {text.data(), bytes}; }
};

// Reads byte by byte, because the bytes after the line must stay in the stream.
Line read_line(const ByteSource& source) {
  Line line;
  std::byte next{};
  while (line.bytes < line.text.size() && source.read(source.context, {&next, 1}) == 1) {
    if (next == std::byte{'\n'}) {
      line.ended = true;
      break;
    }
    line.text[line.bytes++] = static_cast<char>(next);
  }
  return line;
}

// Accepts digits only: no sign, no space, no overflow.
std::optional<std::uint32_t> parse_number(std::string_view digits, std::uint32_t limit) {
  std::uint32_t value = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc() || stop != end || value == 0 || value > limit) {
    return std::nullopt;
  }
  return value;
}

bool parse_side(std::string_view digits, std::uint32_t* side) {
  *side = parse_number(digits, kMaxVideoSide).value_or(0);
  return *side != 0;
}

bool parse_rate(std::string_view text, Y4mHeader* header) {
  constexpr std::uint32_t kMaxTerm = 0x7fffffff;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    return false;
  }
  header->rate_num = parse_number(text.substr(0, colon), kMaxTerm).value_or(0);
  header->rate_den = parse_number(text.substr(colon + 1), kMaxTerm).value_or(0);
  return header->rate_num != 0 && header->rate_den != 0;
}

// "0:0" means unknown; malformed ratios are treated the same.
void parse_aspect(std::string_view text, Y4mHeader* header) {
  constexpr std::uint32_t kMaxTerm = 0x7fffffff;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    return;
  }
  const auto numerator = parse_number(text.substr(0, colon), kMaxTerm);
  const auto denominator = parse_number(text.substr(colon + 1), kMaxTerm);
  header->aspect_num = denominator ? numerator.value_or(0) : 0;
  header->aspect_den = numerator ? denominator.value_or(0) : 0;
}

bool parse_colour(std::string_view name, Y4mColour* colour) {
  struct Known {
    std::string_view name;
    Y4mColour colour;
  };
  // The variants of 4:2:0 differ in the position of chroma samples, by at most half a pixel.
  constexpr Known kKnown[] = {{"420", Y4mColour::k420},      {"420jpeg", Y4mColour::k420},
                              {"420mpeg2", Y4mColour::k420}, {"420paldv", Y4mColour::k420},
                              {"422", Y4mColour::k422},      {"444", Y4mColour::k444},
                              {"mono", Y4mColour::kMono}};
  for (const Known& known : kKnown) {
    if (known.name == name) {
      *colour = known.colour;
      return true;
    }
  }
  return false;
}

// Ignores interlacing and comments, which do not affect how frames are stored.
Y4mStatus parse_parameter(std::string_view parameter, Y4mHeader* header) {
  const std::string_view value = parameter.substr(1);
  switch (parameter.front()) {
    case 'W':
      return parse_side(value, &header->width) ? Y4mStatus::kOk : Y4mStatus::kBadSize;
    case 'H':
      return parse_side(value, &header->height) ? Y4mStatus::kOk : Y4mStatus::kBadSize;
    case 'F':
      return parse_rate(value, header) ? Y4mStatus::kOk : Y4mStatus::kBadRate;
    case 'C':
      return parse_colour(value, &header->colour) ? Y4mStatus::kOk : Y4mStatus::kUnsupportedColour;
    case 'X':
      header->full_range = header->full_range || value == "COLORRANGE=FULL";
      return Y4mStatus::kOk;
    case 'A':
      parse_aspect(value, header);
      return Y4mStatus::kOk;
    case 'I':
      return Y4mStatus::kOk;
    default:
      return Y4mStatus::kBadParameter;
  }
}

Y4mStatus parse_parameters(std::string_view text, Y4mHeader* header) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (end > 0) {
      const Y4mStatus status = parse_parameter(text.substr(0, end), header);
      if (status != Y4mStatus::kOk) {
        return status;
      }
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (header->width == 0 || header->height == 0) {
    return Y4mStatus::kBadSize;
  }
  return header->rate_num == 0 ? Y4mStatus::kBadRate : Y4mStatus::kOk;
}

Y4mStatus parse_stream_header(const Line& line, Y4mHeader* header) {
  constexpr std::string_view kSignature = "YUV4MPEG2";
  const std::string_view text = line.view();
  if (!text.starts_with(kSignature)) {
    return Y4mStatus::kBadSignature;
  }
  if (!line.ended) {
    return line.bytes == line.text.size() ? Y4mStatus::kHeaderTooLong : Y4mStatus::kTruncatedHeader;
  }
  const std::string_view parameters = text.substr(kSignature.size());
  if (!parameters.empty() && parameters.front() != ' ') {
    return Y4mStatus::kBadSignature;
  }
  return parse_parameters(parameters, header);
}

}  // namespace

const char* message(Y4mStatus status) {
  switch (status) {
    case Y4mStatus::kOk:
      return "ok";
    case Y4mStatus::kEnd:
      return "end of the stream";
    case Y4mStatus::kBadSignature:
      return "not a YUV4MPEG2 stream";
    case Y4mStatus::kHeaderTooLong:
      return "stream header: too long";
    case Y4mStatus::kTruncatedHeader:
      return "truncated inside the stream header";
    case Y4mStatus::kBadSize:
      return "width or height: missing or out of range (expected 1 to 16384)";
    case Y4mStatus::kBadRate:
      return "frame rate: missing or not a positive fraction";
    case Y4mStatus::kUnsupportedColour:
      return "colour format: unsupported (expected 8-bit 4:2:0, 4:2:2, 4:4:4 or mono)";
    case Y4mStatus::kBadParameter:
      return "stream header: unknown parameter";
    case Y4mStatus::kBadFrameHeader:
      return "frame header: malformed (expected FRAME)";
    case Y4mStatus::kTruncatedFrame:
      return "truncated inside a frame";
    case Y4mStatus::kBufferTooSmall:
      return "buffer too small for a frame";
  }
  return "unknown status";
}

double Y4mHeader::pixel_aspect() const {
  constexpr double kMin = 0.1, kMax = 10.0;
  const double aspect = aspect_den == 0 ? 1.0 : static_cast<double>(aspect_num) / aspect_den;
  return aspect >= kMin && aspect <= kMax ? aspect : 1.0;
}

std::uint32_t Y4mHeader::chroma_width() const {
  switch (colour) {
    case Y4mColour::kMono:
      return 0;
    case Y4mColour::k444:
      return width;
    case Y4mColour::k420:
    case Y4mColour::k422:
      break;
  }
  return (width + 1) / 2;
}

std::uint32_t Y4mHeader::chroma_height() const {
  switch (colour) {
    case Y4mColour::kMono:
      return 0;
    case Y4mColour::k420:
      return (height + 1) / 2;
    case Y4mColour::k422:
    case Y4mColour::k444:
      break;
  }
  return height;
}

// At most 3 * 2^28 bytes, because sides are at most 2^14.
std::size_t Y4mHeader::frame_bytes() const {
  return std::size_t{width} * height + 2 * std::size_t{chroma_width()} * chroma_height();
}

Y4mStatus Y4mReader::open(ByteSource source) {
  *this = Y4mReader();
  Y4mHeader header;
  const Y4mStatus status = parse_stream_header(read_line(source), &header);
  if (status == Y4mStatus::kOk) {
    source_ = source;
    header_ = header;
  }
  return status;
}

Y4mStatus Y4mReader::read_frame(std::span<std::byte> frame) {
  const std::size_t bytes = header_.frame_bytes();
  if (bytes == 0) {
    return Y4mStatus::kEnd;
  }
  if (frame.size() < bytes) {
    return Y4mStatus::kBufferTooSmall;
  }
  const Line line = read_line(source_);
  if (line.bytes == 0 && !line.ended) {
    return Y4mStatus::kEnd;
  }
  // A frame cannot change size or colour format; its parameters describe interlacing.
  if (!line.ended || (line.view() != "FRAME" && !line.view().starts_with("FRAME "))) {
    return Y4mStatus::kBadFrameHeader;
  }
  const bool whole = source_.read(source_.context, frame.first(bytes)) == bytes;
  return whole ? Y4mStatus::kOk : Y4mStatus::kTruncatedFrame;
}

}  // namespace mien::formats
