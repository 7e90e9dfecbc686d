// Places buffers next to guard pages and fills their borders.
#include "apps/conformance/guarded_buffer.h"

#include <algorithm>

#include "apps/conformance/guard_pages.h"

namespace mien::conformance {
namespace {

constexpr std::byte kBorder{0xAA};
constexpr std::size_t kBorderBytes = 256;  // minimum, on one side
constexpr std::size_t kLineBytes = 64;

std::byte* placed(std::span<std::byte> memory, std::size_t bytes, std::size_t element_bytes,
                  Placement place) {
  // Without guard pages, a stray write must hit the border, not the allocator's data.
  const std::size_t margin = have_guard_pages() ? 0 : kLineBytes;
  switch (place) {
    case Placement::kAtEnd:
      return memory.data() + memory.size() - margin - bytes;
    case Placement::kAtStart:
      return memory.data() + margin;
    case Placement::kUnaligned:
      return memory.data() + kLineBytes + element_bytes;
  }
  return memory.data();
}

}  // namespace

const char* name(Placement place) {
  switch (place) {
    case Placement::kAtEnd:
      return "buffers end at a guard page";
    case Placement::kAtStart:
      return "buffers begin at a guard page";
    case Placement::kUnaligned:
      return "buffers not aligned";
  }
  return "";
}

GuardedBuffer::GuardedBuffer(std::span<const std::byte> content, std::size_t element_bytes,
                             Placement place)
    : bytes_(content.size()),
      memory_(make_guarded_memory(content.size() + kBorderBytes)),
      data_(placed(memory_, bytes_, element_bytes, place)) {
  std::fill(memory_.begin(), memory_.end(), kBorder);
  std::copy(content.begin(), content.end(), data_);
}

GuardedBuffer::~GuardedBuffer() { release_guarded_memory(memory_); }

bool GuardedBuffer::border_intact() const {
  const auto is_border = [](std::byte one) { return one == kBorder; };
  return std::all_of(memory_.data(), data_, is_border) &&
         std::all_of(data_ + bytes_, memory_.data() + memory_.size(), is_border);
}

}  // namespace mien::conformance
