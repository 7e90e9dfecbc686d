// Bytes as text that a page unpacks with DecompressionStream('deflate').
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace mien::app {

// Takes bytes as they come, and keeps only what they are packed into.
class PackedText {
 public:
  PackedText();
  ~PackedText();
  PackedText(PackedText&&) noexcept;
  PackedText& operator=(PackedText&&) noexcept;

  void write(std::string_view bytes);

  // How many were written.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  // All that was written, deflated (RFC 1950), in base64. Nothing is written after that.
  [[nodiscard]] std::string finish();

 private:
  struct Stream;
  void deflate_all(int flush);

  std::unique_ptr<Stream> stream_;
  std::string packed_;
  std::uint64_t bytes_ = 0;
};

}  // namespace mien::app
