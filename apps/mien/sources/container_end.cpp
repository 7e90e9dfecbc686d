// Compares sizes in the structure of media files with the size of the file.
#include "apps/mien/sources/container_end.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "apps/mien/system/paths.h"

namespace mien::app {
namespace {

using namespace std::string_view_literals;

class File {
 public:
  explicit File(const std::string& path) : stream_(path_of(path), std::ios::binary) {
    std::error_code unknown;
    size_ = std::filesystem::file_size(path_of(path), unknown);
    if (unknown) {
      size_ = 0;
    }
  }

  [[nodiscard]] std::uint64_t size() const { return size_; }

  // Returns fewer bytes at the end of the file.
  std::string at(std::uint64_t position, std::size_t bytes) {
    std::string text(bytes, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(position));
    stream_.read(text.data(), static_cast<std::streamsize>(bytes));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream_.gcount())));
    return text;
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char c : bytes) {
    value = value << 8 | static_cast<unsigned char>(c);
  }
  return value;
}

std::uint64_t little_endian(std::string_view bytes) {
  std::string reversed(bytes.rbegin(), bytes.rend());
  return big_endian(reversed);
}

// Whether `bytes` from `position` on exceed the file. The subtraction avoids an overflow.
bool beyond(const File& file, std::uint64_t position, std::uint64_t bytes) {
  return position > file.size() || bytes > file.size() - position;
}

// MP4 (ISO 14496-12): 32-bit size, type, and a 64-bit size if the first is 1.
bool mp4_ends_early(File& file) {
  constexpr std::array kNeeded = {"mdat"sv, "moov"sv, "moof"sv};
  for (std::uint64_t position = 0; position < file.size();) {
    const std::string head = file.at(position, 16);
    if (head.size() < 8) {
      return false;
    }
    const std::string_view view(head);
    std::uint64_t size = big_endian(view.substr(0, 4));
    if (size == 1 && head.size() == 16) {
      size = big_endian(view.substr(8));
    }
    if (size < 8) {  // 0: the box extends to the end of the file
      return false;
    }
    if (beyond(file, position, size)) {
      return std::find(kNeeded.begin(), kNeeded.end(), view.substr(4, 4)) != kNeeded.end();
    }
    position += size;
  }
  return false;
}

struct EbmlSize {
  std::uint64_t value = 0;
  std::size_t bytes = 0;  // length of the number itself; 0: no number, or unknown size
};

EbmlSize ebml_size(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.empty() ? '\0' : text[0]);
  std::size_t bytes = 1;
  while (bytes <= 8 && (first & (0x80u >> (bytes - 1))) == 0) {
    ++bytes;
  }
  if (bytes > 8 || text.size() < bytes) {
    return {};
  }
  const std::uint64_t mask = (std::uint64_t{1} << (7 * bytes)) - 1;
  const std::uint64_t value = big_endian(text.substr(0, bytes)) & mask;
  return value == mask ? EbmlSize{} : EbmlSize{value, bytes};
}

// Matroska (RFC 8794): a header, then the segment.
bool matroska_ends_early(File& file) {
  const std::string head = file.at(0, 12);
  const EbmlSize header = ebml_size(std::string_view(head).substr(4));
  const std::uint64_t position = 4 + header.bytes + header.value;
  const std::string segment = file.at(position, 12);
  if (header.bytes == 0 || !segment.starts_with("\x18\x53\x80\x67")) {
    return false;
  }
  const EbmlSize size = ebml_size(std::string_view(segment).substr(4));
  return size.bytes > 0 && beyond(file, position + 4 + size.bytes, size.value);
}

bool avi_ends_early(File& file) {
  for (std::uint64_t position = 0; position < file.size();) {
    const std::string head = file.at(position, 8);
    if (!head.starts_with("RIFF") || head.size() < 8) {
      return false;
    }
    const std::uint64_t size = little_endian(std::string_view(head).substr(4));
    if (size == 0 || size == 0xFFFFFFFFu) {  // never filled in
      return false;
    }
    if (beyond(file, position + 8, size)) {
      return true;
    }
    position += 8 + size + size % 2;
  }
  return false;
}

// FLV: tags of 11 bytes and their data, each followed by its length.
bool flv_ends_early(File& file) {
  const std::string head = file.at(0, 9);
  std::uint64_t position = head.size() < 9 ? file.size() : big_endian(head.substr(5)) + 4;
  while (position < file.size()) {
    const std::string tag = file.at(position, 4);
    if (tag.size() < 4) {
      return false;
    }
    const std::uint64_t data = big_endian(std::string_view(tag).substr(1));
    if (beyond(file, position, 11 + data)) {
      return true;
    }
    position += 11 + data + 4;
  }
  return false;
}

// Ogg (RFC 3533): the last page must be complete.
bool ogg_ends_early(File& file) {
  constexpr std::size_t kMaxPage = 27 + 255 + 255 * 255;
  const std::uint64_t position = file.size() > kMaxPage ? file.size() - kMaxPage : 0;
  const std::string end = file.at(position, kMaxPage);
  const std::size_t page = end.rfind("OggS");
  if (page == std::string::npos) {
    return false;
  }
  if (end.size() - page < 27) {
    return true;
  }
  const auto segments = static_cast<unsigned char>(end[page + 26]);
  std::uint64_t bytes = 27u + segments;
  for (std::size_t i = page + 27; i < std::min(end.size(), page + 27 + segments); ++i) {
    bytes += static_cast<unsigned char>(end[i]);
  }
  return beyond(file, position + page, bytes);
}

// ASF: objects with a 16-byte id and an 8-byte size. The second object has the packets.
bool asf_ends_early(File& file) {
  const std::uint64_t header = little_endian(file.at(16, 8));
  const std::string data = file.at(header, 24);
  return data.size() == 24 && data.starts_with("\x36\x26\xB2\x75\x8E\x66\xCF\x11") &&
         beyond(file, header, little_endian(data.substr(16)));
}

bool is_mp4(std::string_view head) {
  constexpr std::array kFirst = {"ftyp"sv, "moov"sv, "mdat"sv, "free"sv,
                                 "skip"sv, "wide"sv, "styp"sv, "moof"sv};
  return head.size() >= 8 &&
         std::find(kFirst.begin(), kFirst.end(), head.substr(4, 4)) != kFirst.end();
}

}  // namespace

bool ends_early(const std::string& path) {
  File file(path);
  const std::string head = file.at(0, 16);
  if (is_mp4(head)) {
    return mp4_ends_early(file);
  }
  if (head.starts_with("\x1A\x45\xDF\xA3")) {
    return matroska_ends_early(file);
  }
  if (head.starts_with("RIFF") && head.find("AVI ") == 8) {
    return avi_ends_early(file);
  }
  if (head.starts_with("FLV")) {
    return flv_ends_early(file);
  }
  if (head.starts_with("OggS")) {
    return ogg_ends_early(file);
  }
  return head.starts_with("\x30\x26\xB2\x75\x8E\x66\xCF\x11") && asf_ends_early(file);
}

}  // namespace mien::app
