// The files of golden/, as embed_golden.cmake puts them into the program.
#pragma once

#include <cstddef>

namespace mien::conformance {

struct Embedded {
  const unsigned char* data;  // at a multiple of 64
  std::size_t bytes;
};

extern const Embedded kMiniFile;
extern const Embedded kEncoderInput, kEncoderOutput;
extern const Embedded kPnetInput, kPnetOutput0, kPnetOutput1;
extern const Embedded kTemporalInput, kTemporalOutput;

}  // namespace mien::conformance
