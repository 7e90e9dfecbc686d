// Compressed data as text, which a page unpacks with DecompressionStream('deflate').
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace mien::app {

// Compresses bytes as they arrive and keeps only the result.
class PackedText {
 public:
  PackedText();
  ~PackedText();
  PackedText(PackedText&&) noexcept;
  PackedText& operator=(PackedText&&) noexcept;

  void write(std::string_view bytes);

  // The number of bytes written.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  // Returns everything written, deflated (RFC 1950), in base64. Nothing can be written afterwards.
  [[nodiscard]] std::string finish();

 private:
  struct Stream;
  void deflate_all(int flush);

  std::unique_ptr<Stream> stream_;
  std::string packed_;
  std::uint64_t bytes_ = 0;
};

}  // namespace mien::app
