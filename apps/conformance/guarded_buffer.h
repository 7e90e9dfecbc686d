// A buffer that detects out-of-bounds access: inaccessible pages on both sides, and 0xAA bytes
// between the buffer and these.
#pragma once

#include <cstddef>
#include <span>

namespace mien::conformance {

enum class Placement {
  kAtEnd,      // the last byte is next to an inaccessible page
  kAtStart,    // the first byte is next to an inaccessible page
  kUnaligned,  // borders on both sides; starts one element after a multiple of 64
};
inline constexpr Placement kPlacements[] = {Placement::kAtEnd, Placement::kAtStart,
                                            Placement::kUnaligned};
[[nodiscard]] const char* name(Placement place);

// False on systems without page protection (WebAssembly), which only check the borders.
[[nodiscard]] bool have_guard_pages();

class GuardedBuffer {
 public:
  GuardedBuffer(std::span<const std::byte> content, std::size_t element_bytes, Placement place);
  ~GuardedBuffer();
  GuardedBuffer(const GuardedBuffer&) = delete;
  GuardedBuffer& operator=(const GuardedBuffer&) = delete;

  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::span<const std::byte> content() const { return {data_, bytes_}; }
  // Whether the bytes around the buffer are unchanged.
  [[nodiscard]] bool border_intact() const;

 private:
  std::size_t bytes_;
  std::span<std::byte> memory_;  // between the guard pages
  std::byte* data_;
};

}  // namespace mien::conformance
