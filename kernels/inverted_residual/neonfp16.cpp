// Strips and bands in half precision, 16 channels of a pixel together: two vectors.
#include "kernels/common/neon_half.h"
#include "kernels/families.h"
#include "kernels/inverted_residual/neon_slide.h"
#include "kernels/inverted_residual/neonfp16_product.h"

namespace mien::kernels::neonfp16 {
namespace {

struct Halves {
  using Value = Half;
  using Vec = HalfVec;
  static constexpr int kLanes = kHalves;
  static constexpr int kVecs = 2;
  static Vec load(const Half* at) { return load_halves(at); }
  static void store(Half* at, Vec x) { store_halves(at, x); }
  static Vec weights(const Half* at) { return load_halves(at); }
  static Vec fma(Vec sum, Vec a, Vec b) { return vfmaq_f16(sum, a, b); }
  static Vec clamped(Vec x, Vec low, Vec high) { return vminq_f16(vmaxq_f16(x, low), high); }
};

// The map in half precision and the band: [panel of 16 channels][pixel][16].
class HalfStrips {
 public:
  using Value = Half;
  static constexpr std::int32_t kPanel = neonfp16::kPanel;

  explicit HalfStrips(const InvertedResidualArgs& args)
      : a_(args),
        x_(reinterpret_cast<Half*>(args.narrow)),
        band_(reinterpret_cast<Half*>(args.band)) {}

  void begin(std::int32_t first, std::int32_t rows) {
    if (a_.expand.weights == nullptr) {
      return;
    }
    first_row_ = first;
    x_panel_elems_ = std::ptrdiff_t{rows} * a_.in_w * kPanel;
    const std::int32_t blocks = blocks_of(a_.in_c);
    for (std::int32_t block = 0; block < blocks; block += 2) {
      narrow(block, blocks - block, first, rows * a_.in_w, x_ + block / 2 * x_panel_elems_);
    }
  }

  void expand(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    const StripClamp clamp = clamp_of(a_.expand.activation);
    const std::ptrdiff_t channel = std::ptrdiff_t{part.first} * kBlock;
    HalfProduct product{};
    product.x = x_ + std::ptrdiff_t{row - first_row_} * a_.in_w * kPanel;
    product.x_panel_elems = x_panel_elems_;
    product.in_blocks = blocks_of(a_.in_c);
    product.pixels = rows * a_.in_w;
    product.weights = a_.expand.weights + channel * product.in_blocks * kBlock;
    product.bias = a_.expand.bias + channel;
    product.out_blocks = part.count;
    product.low = clamp.low;
    product.high = clamp.high;
    multiply_to_strip(product, {y, part.panel_elems, part.row_elems, a_.in_w});
  }

  void copy(const StripPart& part, std::int32_t row, std::int32_t rows, Half* y) const {
    for (std::int32_t block = 0; block < part.count; block += 2) {
      for (std::int32_t i = 0; i < rows; ++i) {
        narrow(part.first + block, part.count - block, row + i, a_.in_w,
               y + block / 2 * part.panel_elems + i * part.row_elems);
      }
    }
  }

  void slide(const Slide<Half>& s) const {
    const std::ptrdiff_t taps_elems = std::ptrdiff_t{a_.kernel_h} * a_.kernel_w * kBlock;
    const bool both = s.blocks > 1;  // else the upper vector is computed like the lower, for nobody
    const Taps<Halves> taps(a_.slide.weights + s.block * taps_elems, both ? taps_elems : 0,
                            a_.slide.bias + std::ptrdiff_t{s.block} * kBlock, both ? kBlock : 0,
                            splat_halves(s.clamp.low), splat_halves(s.clamp.high));
    const std::ptrdiff_t y_row = std::ptrdiff_t{a_.out_w} * kPanel;
    Half* y = band_ + (std::ptrdiff_t{s.block / 2} * s.band_rows + s.row) * y_row;
    slide_rows<Halves, kPanel>(a_, taps, {s.x, s.x_row_elems, y, y_row}, s.rows);
  }

  void project(std::int32_t first, std::int32_t rows) const {
    const StripClamp clamp = clamp_of(a_.project.activation);
    HalfProduct product{};
    product.x = band_;
    product.x_panel_elems = std::ptrdiff_t{rows} * a_.out_w * kPanel;
    product.in_blocks = blocks_of(a_.hidden_c);
    product.pixels = rows * a_.out_w;
    product.weights = a_.project.weights;
    product.bias = a_.project.bias;
    product.out_blocks = blocks_of(a_.out_c);
    product.low = clamp.low;
    product.high = clamp.high;
    MapRows to{};
    to.y = a_.y + std::ptrdiff_t{first} * a_.out_w * kBlock;
    to.plane_elems = std::ptrdiff_t{a_.out_h} * a_.out_w * kBlock;
    to.row_pixels = a_.out_w;
    if (a_.residual != nullptr) {
      const std::ptrdiff_t pixel =
          std::ptrdiff_t{first + a_.residual_top} * a_.residual_w + a_.residual_left;
      to.residual = a_.residual + pixel * kBlock;
      to.residual_plane_elems = std::ptrdiff_t{a_.residual_h} * a_.residual_w * kBlock;
      to.residual_row_elems = std::ptrdiff_t{a_.residual_w} * kBlock;
    }
    multiply_to_map(product, to);
  }

 private:
  // `pixels` pixels from the beginning of a row of the map on, of one block or two.
  void narrow(std::int32_t block, std::int32_t blocks, std::int32_t row, std::int32_t pixels,
              Half* y) const {
    const std::ptrdiff_t plane = std::ptrdiff_t{a_.in_h} * a_.in_w * kBlock;
    const float* x = a_.x + block * plane + std::ptrdiff_t{row} * a_.in_w * kBlock;
    const std::ptrdiff_t upper = blocks > 1 ? plane : 0;
    for (std::int32_t p = 0; p < pixels; ++p, x += kBlock, y += kPanel) {
      store_halves(y, narrowed(load_pair(x)));
      store_halves(y + kHalves, narrowed(load_pair(x + upper)));
    }
  }

  const InvertedResidualArgs& a_;
  Half* x_;  // from row `first_row_` on
  Half* band_;
  std::int32_t first_row_ = 0;
  std::ptrdiff_t x_panel_elems_ = 0;
};

}  // namespace

void inverted_residual(const InvertedResidualArgs& a) { InvertedResidual<HalfStrips>(a).run(); }

}  // namespace mien::kernels::neonfp16
