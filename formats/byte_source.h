// The byte source of stream parsers: a pipe, a file or a span.
#pragma once

#include <cstddef>
#include <cstdio>
#include <span>

namespace mien::formats {

struct ByteSource {
  // Fills `into` and returns the number of bytes; less than into.size() only at the end.
  std::size_t (*read)(void* context, std::span<std::byte> into);
  void* context;
};

// Reads the stream, which remains the caller's and must stay open.
ByteSource file_source(std::FILE* file);

// Reads the span at `remaining` and removes the bytes read from its front.
ByteSource span_source(std::span<const std::byte>* remaining);

}  // namespace mien::formats
