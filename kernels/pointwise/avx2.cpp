// Register tiles of up to 6 pixels x 16 output channels: 12 sums, two weight vectors, one
// broadcast.
#include "kernels/common/avx2.h"
#include "kernels/families.h"

namespace mien::kernels::avx2 {
namespace {

constexpr int kTilePixels = 6;

// Fewer pixels leave registers for more partial sums, which hide the latency of the multiply-adds.
constexpr int partial_sums(int pixels) { return pixels == 1 ? 4 : pixels <= 3 ? 2 : 1; }

struct Target {
  std::int32_t block;  // first output block
  std::int32_t pixel;  // first pixel
};

const float* residual_at(const PointwiseArgs& a, std::int32_t block, std::int32_t pixel) {
  const std::int32_t y = pixel / a.w + a.residual_top;
  const std::int32_t x = pixel % a.w + a.residual_left;
  const std::ptrdiff_t plane = std::ptrdiff_t{a.residual_h} * a.residual_w;
  return a.residual + (block * plane + std::ptrdiff_t{y} * a.residual_w + x) * kLanes;
}

void store(const PointwiseArgs& a, Vec sum, std::int32_t block, std::int32_t pixel) {
  Vec value = _mm256_add_ps(sum, load_half(a.bias + block * kLanes));
  value = activated(value, a.activation, block, a.out_c);
  if (a.residual != nullptr) {
    value = _mm256_add_ps(value, _mm256_loadu_ps(residual_at(a, block, pixel)));
  }
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w;
  _mm256_storeu_ps(a.y + (block * plane + pixel) * kLanes, value);
}

template <int kPixels, int kVecs>
void tile(const PointwiseArgs& a, const std::uint16_t* w, Target target) {
  constexpr int kSums = partial_sums(kPixels);
  Vec sum[kSums][kPixels][kVecs];
  for (auto& partial : sum) {
    for (auto& pixel : partial) {
      for (Vec& one : pixel) {
        one = _mm256_setzero_ps();
      }
    }
  }
  const std::ptrdiff_t plane = std::ptrdiff_t{a.h} * a.w * kLanes;
  const float* x = a.x + std::ptrdiff_t{target.pixel} * kLanes;
  for (std::int32_t block = 0; block < blocks_of(a.in_c); ++block, x += plane) {
    for (int lane = 0; lane < kLanes; lane += kSums) {
      for (int s = 0; s < kSums; ++s, w += kVecs * kLanes) {
        Vec weight[kVecs];
        for (int v = 0; v < kVecs; ++v) {
          weight[v] = load_half(w + v * kLanes);
        }
        for (int p = 0; p < kPixels; ++p) {
          const Vec value = _mm256_broadcast_ss(x + p * kLanes + lane + s);
          for (int v = 0; v < kVecs; ++v) {
            sum[s][p][v] = _mm256_fmadd_ps(value, weight[v], sum[s][p][v]);
          }
        }
      }
    }
  }
  for (int p = 0; p < kPixels; ++p) {
    for (int v = 0; v < kVecs; ++v) {
      Vec total = sum[0][p][v];
      for (int s = 1; s < kSums; ++s) {
        total = _mm256_add_ps(total, sum[s][p][v]);
      }
      store(a, total, target.block + v, target.pixel + p);
    }
  }
}

template <int kVecs>
void tile_of(const PointwiseArgs& a, const std::uint16_t* w, Target target, std::int32_t pixels) {
  switch (pixels) {
    case 1:
      return tile<1, kVecs>(a, w, target);
    case 2:
      return tile<2, kVecs>(a, w, target);
    case 3:
      return tile<3, kVecs>(a, w, target);
    case 4:
      return tile<4, kVecs>(a, w, target);
    case 5:
      return tile<5, kVecs>(a, w, target);
    default:
      return tile<6, kVecs>(a, w, target);
  }
}

// Tiles of nearly equal size: 9 pixels are 5 + 4, not 6 + 3.
template <int kVecs>
void panel(const PointwiseArgs& a, const std::uint16_t* w, std::int32_t block) {
  const std::int32_t pixels = a.h * a.w;
  const std::int32_t tiles = (pixels + kTilePixels - 1) / kTilePixels;
  std::int32_t pixel = 0;
  for (std::int32_t left = tiles; left > 0; --left) {
    const std::int32_t count = (pixels - pixel + left - 1) / left;
    tile_of<kVecs>(a, w, {block, pixel}, count);
    pixel += count;
  }
}

}  // namespace

void pointwise(const PointwiseArgs& a) {
  const std::ptrdiff_t reduction = std::ptrdiff_t{blocks_of(a.in_c)} * kLanes;
  const std::int32_t blocks = blocks_of(a.out_c);
  const std::uint16_t* w = a.weights;
  std::int32_t block = 0;
  for (; block + 2 <= blocks; block += 2, w += reduction * kPanel) {
    panel<2>(a, w, block);
  }
  if (block < blocks) {
    panel<1>(a, w, block);
  }
}

}  // namespace mien::kernels::avx2
