// The files of golden/, embedded by embed_golden.cmake.
#pragma once

#include <cstddef>

namespace mien::conformance {

struct Embedded {
  const unsigned char* data;  // 64-byte aligned
  std::size_t bytes;
};

extern const Embedded kMiniFile;
extern const Embedded kEncoderInput, kEncoderOutput;
extern const Embedded kPnetInput, kPnetOutput0, kPnetOutput1;
extern const Embedded kTemporalInput, kTemporalOutput;

}  // namespace mien::conformance
