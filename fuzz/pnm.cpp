// The bytes are a PNM image.
#include "formats/pnm.h"

#include <cstdlib>
#include <vector>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mien::formats::PnmImage image;
  const auto status = mien::formats::read_pnm(std::as_bytes(std::span(data, size)), &image);
  const std::vector<std::byte> pixels(image.pixels.begin(), image.pixels.end());
  const bool whole = pixels.size() == std::size_t{image.width} * image.height * image.channels;
  if (!whole || (status == mien::formats::PnmStatus::kOk) != !pixels.empty()) {
    std::abort();
  }
  return 0;
}
