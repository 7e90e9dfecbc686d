#include "apps/conformance/guarded_buffer.h"

#include <algorithm>

#include "apps/conformance/guard_pages.h"

namespace mien::conformance {
namespace {

constexpr std::byte kBorder{0xAA};
constexpr std::size_t kBorderBytes = 256;  // at least, on one side
constexpr std::size_t kLineBytes = 64;

std::byte* placed(std::span<std::byte> room, std::size_t bytes, std::size_t element_bytes,
                  Place place) {
  // Without guard pages a stray write is to hit the border, not what the heap keeps beside the
  // room.
  const std::size_t margin = have_guard_pages() ? 0 : kLineBytes;
  switch (place) {
    case Place::kAtEnd:
      return room.data() + room.size() - margin - bytes;
    case Place::kAtStart:
      return room.data() + margin;
    case Place::kUnaligned:
      return room.data() + kLineBytes + element_bytes;
  }
  return room.data();
}

}  // namespace

const char* name(Place place) {
  switch (place) {
    case Place::kAtEnd:
      return "buffers end at a guard page";
    case Place::kAtStart:
      return "buffers begin at a guard page";
    case Place::kUnaligned:
      return "buffers not aligned";
  }
  return "";
}

GuardedBuffer::GuardedBuffer(std::span<const std::byte> content, std::size_t element_bytes,
                             Place place)
    : bytes_(content.size()),
      room_(make_guarded_room(content.size() + kBorderBytes)),
      data_(placed(room_, bytes_, element_bytes, place)) {
  std::fill(room_.begin(), room_.end(), kBorder);
  std::copy(content.begin(), content.end(), data_);
}

GuardedBuffer::~GuardedBuffer() { release_guarded_room(room_); }

bool GuardedBuffer::border_intact() const {
  const auto is_border = [](std::byte one) { return one == kBorder; };
  return std::all_of(room_.data(), data_, is_border) &&
         std::all_of(data_ + bytes_, room_.data() + room_.size(), is_border);
}

}  // namespace mien::conformance
