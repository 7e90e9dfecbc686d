// Memory that a kernel must not leave: pages nobody may touch on both sides, and 0xAA bytes
// wherever the buffer does not reach them.
#pragma once

#include <cstddef>
#include <span>

namespace mien::conformance {

enum class Place {
  kAtEnd,      // the buffer's last byte lies before a page that may not be touched
  kAtStart,    // its first byte lies behind one
  kUnaligned,  // borders on both sides; starts one element behind a multiple of 64
};
inline constexpr Place kPlaces[] = {Place::kAtEnd, Place::kAtStart, Place::kUnaligned};
[[nodiscard]] const char* name(Place place);

// False where the system has no pages to protect (WebAssembly): borders alone are checked there.
[[nodiscard]] bool have_guard_pages();

class GuardedBuffer {
 public:
  GuardedBuffer(std::span<const std::byte> content, std::size_t element_bytes, Place place);
  ~GuardedBuffer();
  GuardedBuffer(const GuardedBuffer&) = delete;
  GuardedBuffer& operator=(const GuardedBuffer&) = delete;

  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::span<const std::byte> content() const { return {data_, bytes_}; }
  // Whether the bytes around the buffer are what they were.
  [[nodiscard]] bool border_intact() const;

 private:
  std::size_t bytes_;
  std::span<std::byte> room_;  // between the guard pages
  std::byte* data_;
};

}  // namespace mien::conformance
