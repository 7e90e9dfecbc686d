// Chroma samples that are gigabytes apart, as an image may have.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "tests/kernels/warp_output.h"

namespace mien::kernels {
namespace {

// Memory whose untouched pages do not exist.
class SparseBytes {
 public:
  explicit SparseBytes(std::size_t bytes)
      : bytes_(bytes),
        memory_(mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)) {}
  ~SparseBytes() {
    if (there()) {
      munmap(memory_, bytes_);
    }
  }
  SparseBytes(const SparseBytes&) = delete;
  SparseBytes& operator=(const SparseBytes&) = delete;
  [[nodiscard]] bool there() const { return memory_ != MAP_FAILED; }
  [[nodiscard]] std::uint8_t* data() const { return static_cast<std::uint8_t*>(memory_); }

 private:
  std::size_t bytes_;
  void* memory_;
};

// The offset of the last sample of a row exceeds 32 bits.
TEST(Warp, ChromaSamplesMayBeFarApart) {
  if (sizeof(void*) < 8) {
    GTEST_SKIP() << "such a plane needs 64-bit addresses";
  }
  constexpr std::int32_t kSamples = 3;
  constexpr std::ptrdiff_t kStep = 0x7fffffff;
  constexpr std::array<std::uint8_t, kSamples> kU = {90, 120, 200}, kV = {170, 40, 128};
  const SparseBytes u((kSamples - 1) * std::size_t{kStep} + 1);
  const SparseBytes v((kSamples - 1) * std::size_t{kStep} + 1);
  if (!u.there() || !v.there()) {
    GTEST_SKIP() << "no address space for 8 GB";
  }
  for (std::ptrdiff_t i = 0; i < kSamples; ++i) {
    u.data()[i * kStep] = kU[static_cast<std::size_t>(i)];
    v.data()[i * kStep] = kV[static_cast<std::size_t>(i)];
  }
  const std::array<std::uint8_t, 2 * kSamples> luma = {10, 60, 110, 160, 210, 250};
  const float matrix[6] = {0.07f, 0.0f, -0.1f, 0.0f, 0.01f, 0.5f};
  for_each_tier([&](Tier tier) {
    const auto warp = [&](Output& out, const Plane& first, const Plane& second) {
      out.args.plane[0] = {luma.data(), 2 * kSamples, 1};
      out.args.plane[1] = first;
      out.args.plane[2] = second;
      out.args.image_width = 2 * kSamples;
      out.args.image_height = 1;
      std::copy_n(matrix, 6, out.args.matrix);
      find<WarpArgs>(bit(tier))(out.args);
    };
    Output near(PixelFormat::kYuv420), far(PixelFormat::kYuv420);
    warp(near, {kU.data(), kSamples, 1}, {kV.data(), kSamples, 1});
    warp(far, {u.data(), 0, kStep}, {v.data(), 0, kStep});
    EXPECT_EQ(near.picture, far.picture) << name(tier);
  });
}

}  // namespace
}  // namespace mien::kernels
