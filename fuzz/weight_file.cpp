// The bytes are a weight file.
#include "fuzz/read_all.h"
#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mien::fuzz::read_all(std::as_bytes(std::span(data, size)));
  return 0;
}
