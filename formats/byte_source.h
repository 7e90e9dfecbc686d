// Where stream parsers get their bytes: a pipe, a file, a span.
#pragma once

#include <cstddef>
#include <cstdio>
#include <span>

namespace mien::formats {

struct ByteSource {
  // Fills `into` as far as there are bytes and returns how many; fewer than asked only at the end.
  std::size_t (*read)(void* context, std::span<std::byte> into);
  void* context;
};

// Reads the stream; it stays the caller's and must stay open.
ByteSource file_source(std::FILE* file);

// Reads the span that `remaining` points to and shortens it from the front.
ByteSource span_source(std::span<const std::byte>* remaining);

}  // namespace mien::formats
