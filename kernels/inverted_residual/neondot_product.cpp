// Register tiles of up to 9 pixels x 8 outputs. SDOT multiplies 4 inputs of 4 outputs with 4 inputs
// of one pixel, so inputs need no broadcast. The outputs are the halves of a panel of 16, or a last
// panel of 8.
#include "kernels/common/product_sums.h"
#include "kernels/inverted_residual/dot_outputs.h"

namespace mien::kernels::neondot {
namespace {

constexpr int kVecs = kBlock / kLanes;
constexpr std::ptrdiff_t kQuad = 4;  // inputs that an instruction multiplies

// The weights of two quads of inputs, [quad][4 outputs], and their distance.
struct HalfPanel {
  static constexpr std::ptrdiff_t kStep = 2 * kQuad * kPanel;
  static void load(const std::int8_t* w, int8x16_t (&quads)[2][kVecs]) {
    MIEN_UNROLLED for (int i = 0; i < 2 * kVecs; ++i) {
      quads[i / kVecs][i % kVecs] =
          vld1q_s8(w + i / kVecs * kQuad * kPanel + i % kVecs * kQuad * kLanes);
    }
  }
};
struct LastPanel {
  static constexpr std::ptrdiff_t kStep = 2 * kQuad * kBlock;
  static void load(const std::int8_t* w, int8x16_t (&quads)[2][kVecs]) {
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      const int32x4x2_t both =
          vld2q_s32(reinterpret_cast<const std::int32_t*>(w + v * 2 * kQuad * kLanes));
      quads[0][v] = vreinterpretq_s8_s32(both.val[0]);
      quads[1][v] = vreinterpretq_s8_s32(both.val[1]);
    }
  }
};

// Adds the products of a quad of inputs: of all pixels, because each sum waits for its previous
// one.
template <int kLane, int kPixels, int kParts>
[[gnu::always_inline]] inline void add_quad(const int8x16_t (&w)[kVecs],
                                            const int8x16_t (&x)[kPixels],
                                            int32x4_t (&sums)[kParts][kPixels][kVecs]) {
  MIEN_UNROLLED for (int i = 0; i < kPixels * kVecs; ++i) {
    const int p = i / kVecs, v = i % kVecs;
    int32x4_t& sum = sums[kLane % kParts][p][v];
    sum = vdotq_laneq_s32(sum, w[v], x[p], kLane);
  }
}

template <int kPixels>
[[gnu::always_inline]] inline void load_pixels(const std::int8_t* x, int8x16_t (&y)[kPixels]) {
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) { y[p] = vld1q_s8(x + p * kPanel); }
}

template <class Panel, class To, int kPixels>
[[gnu::noinline]] void tile(const DotProduct& a, const std::int8_t* x, const std::int8_t* w,
                            const To& by, typename To::Place at) {
  constexpr int kParts = partial_sums(kPixels * kVecs);
  int32x4_t sums[kParts][kPixels][kVecs];
  MIEN_UNROLLED for (int i = 0; i < kParts * kPixels * kVecs; ++i) {
    sums[i / (kPixels * kVecs)][i / kVecs % kPixels][i % kVecs] = vdupq_n_s32(0);
  }
  const std::ptrdiff_t step = a.plane_elems;
  for (std::int32_t left = a.to.in_blocks / 2; left > 0; --left, w += 2 * Panel::kStep, x += step) {
    int8x16_t values[kPixels], quads[2][kVecs];
    load_pixels(x, values);
    Panel::load(w, quads);
    add_quad<0>(quads[0], values, sums);
    add_quad<1>(quads[1], values, sums);
    Panel::load(w + Panel::kStep, quads);
    add_quad<2>(quads[0], values, sums);
    add_quad<3>(quads[1], values, sums);
  }
  if (a.to.in_blocks % 2 != 0) {
    int8x16_t values[kPixels], quads[2][kVecs];
    load_pixels(x, values);
    Panel::load(w, quads);
    add_quad<0>(quads[0], values, sums);
    add_quad<1>(quads[1], values, sums);
  }
  const To to = by;
  MIEN_UNROLLED for (int p = 0; p < kPixels; ++p) {
    int32x4_t total[kVecs];
    MIEN_UNROLLED for (int v = 0; v < kVecs; ++v) {
      total[v] = sums[0][p][v];
      MIEN_UNROLLED for (int part = 1; part < kParts; ++part) {
        total[v] = vaddq_s32(total[v], sums[part][p][v]);
      }
    }
    to.store({vcvtq_f32_s32(total[0]), vcvtq_f32_s32(total[1])}, at);
  }
}

template <class Panel, class To, int... kSizes>
Tiling<Run<To>> tiling_of_sizes(std::int32_t pixels) {
  static constexpr SizedTile<Run<To>> kTiles[] = {{kSizes, &tile<Panel, To, kSizes>}...};
  return tiling_of(kTiles, pixels);
}
template <class Panel, class To>
Tiling<Run<To>> tiles_for(std::int32_t pixels) {
  return tiling_of_sizes<Panel, To, 1, 2, 4, 6, 8, 9>(pixels);
}

template <class To, class Rows>
void multiply(const DotProduct& a, const Rows& rows) {
  const std::int32_t whole = a.to.out_blocks / 2 * 2;  // blocks of panels of 16
  const std::ptrdiff_t block_bytes = std::ptrdiff_t{(a.to.in_blocks + 1) / 2} * kPanel * kBlock;
  const auto tiles = tiles_for<HalfPanel, To>(a.to.pixels);
  for (std::int32_t block = 0; block < whole; ++block) {
    const std::int32_t half = block % 2;
    multiply_block<kPanel>(a, tiles, a.quads + (block - half) * block_bytes + half * kQuad * kBlock,
                           To(a, rows, block));
  }
  if (whole < a.to.out_blocks) {
    multiply_block<kPanel>(a, tiles_for<LastPanel, To>(a.to.pixels), a.quads + whole * block_bytes,
                           To(a, rows, whole));
  }
}

}  // namespace

void multiply_to_strip(const DotProduct& a, const StripRows& to) { multiply<ToStrip>(a, to); }
void multiply_to_map(const DotProduct& a, const MapRows& to) { multiply<ToMap>(a, to); }

}  // namespace mien::kernels::neondot
