// Parses PGM and PPM images.
#include "formats/pnm.h"

#include <optional>

namespace mien::formats {
namespace {

bool is_space(std::byte byte) {
  const char c = static_cast<char>(byte);
  return c == ' ' || (c >= '\t' && c <= '\r');
}

bool is_digit(std::byte byte) { return byte >= std::byte{'0'} && byte <= std::byte{'9'}; }

// Reads the tokens of the header.
class Header {
 public:
  explicit Header(std::span<const std::byte> file) : file_(file) {}

  // A decimal number up to `limit` after white space and comments.
  std::optional<std::uint32_t> number(std::uint32_t limit) {
    if (!skip_space()) {
      return std::nullopt;
    }
    std::uint32_t value = 0;
    const std::size_t first = at_;
    for (; at_ < file_.size() && is_digit(file_[at_]); ++at_) {
      value = value * 10 + static_cast<std::uint32_t>(file_[at_]) - '0';
      if (value > limit) {
        return std::nullopt;
      }
    }
    return at_ > first ? std::optional(value) : std::nullopt;
  }

  // The bytes after the single white space that ends the header.
  std::optional<std::span<const std::byte>> rest() const {
    if (at_ >= file_.size() || !is_space(file_[at_])) {
      return std::nullopt;
    }
    return file_.subspan(at_ + 1);
  }

 private:
  // Returns false without any. A comment extends from '#' to the end of its line.
  bool skip_space() {
    const std::size_t first = at_;
    bool comment = false;
    for (; at_ < file_.size(); ++at_) {
      const bool starts = file_[at_] == std::byte{'#'};
      comment = starts || (comment && file_[at_] != std::byte{'\n'});
      if (!comment && !is_space(file_[at_])) {
        break;
      }
    }
    return at_ > first;
  }

  std::span<const std::byte> file_;
  std::size_t at_ = 2;  // after the signature
};

std::uint32_t channels_of(std::span<const std::byte> file) {
  if (file.size() < 2 || file[0] != std::byte{'P'}) {
    return 0;
  }
  return file[1] == std::byte{'5'} ? 1 : file[1] == std::byte{'6'} ? 3 : 0;
}

}  // namespace

const char* message(PnmStatus status) {
  switch (status) {
    case PnmStatus::kOk:
      return "ok";
    case PnmStatus::kBadSignature:
      return "not a binary PGM or PPM image";
    case PnmStatus::kBadHeader:
      return "image header: malformed";
    case PnmStatus::kBadSize:
      return "width or height: out of range (expected 1 to 16384)";
    case PnmStatus::kUnsupportedDepth:
      return "maximum value: unsupported (expected 255)";
    case PnmStatus::kTruncated:
      return "truncated inside the image";
    case PnmStatus::kTrailingBytes:
      return "trailing bytes after the image";
  }
  return "unknown status";
}

PnmStatus read_pnm(std::span<const std::byte> file, PnmImage* image) {
  *image = {};
  const std::uint32_t channels = channels_of(file);
  if (channels == 0) {
    return PnmStatus::kBadSignature;
  }
  Header header(file);
  const std::uint32_t width = header.number(kMaxImageSide).value_or(0);
  const std::uint32_t height = width == 0 ? 0 : header.number(kMaxImageSide).value_or(0);
  if (width == 0 || height == 0) {
    return PnmStatus::kBadSize;
  }
  if (header.number(65535).value_or(0) != 255) {
    return PnmStatus::kUnsupportedDepth;
  }
  const auto pixels = header.rest();
  if (!pixels) {
    return PnmStatus::kBadHeader;
  }
  const std::size_t bytes = std::size_t{width} * height * channels;  // below 2^30
  if (pixels->size() != bytes) {
    return pixels->size() < bytes ? PnmStatus::kTruncated : PnmStatus::kTrailingBytes;
  }
  *image = {width, height, channels, *pixels};
  return PnmStatus::kOk;
}

}  // namespace mien::formats
