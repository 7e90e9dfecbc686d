// The table of embedded networks.
#include "apps/conformance/golden.h"

#include "apps/conformance/golden_bytes.h"

namespace mien::conformance {
namespace {

std::span<const float> floats(const Embedded& file) {
  return {reinterpret_cast<const float*>(file.data), file.bytes / sizeof(float)};
}

}  // namespace

std::span<const std::byte> golden_file() {
  return {reinterpret_cast<const std::byte*>(kMiniFile.data), kMiniFile.bytes};
}

std::span<const GoldenNetwork> golden_networks() {
  static const GoldenNetwork kNetworks[] = {
      {"encoder", {}, floats(kEncoderInput), {floats(kEncoderOutput)}},
      {"pnet", {31, 31, 3}, floats(kPnetInput), {floats(kPnetOutput0), floats(kPnetOutput1)}},
      {"temporal", {}, floats(kTemporalInput), {floats(kTemporalOutput)}},
  };
  return kNetworks;
}

}  // namespace mien::conformance
