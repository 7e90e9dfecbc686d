// Reorders, pads and rounds weights.
#include "formats/weight_packing.h"

#include <algorithm>

#include "formats/fp16.h"

namespace mien::formats {
namespace {

constexpr std::size_t kPanel = 16;
constexpr std::size_t kBlock = 8;

// padded8 for sizes in memory.
std::size_t padded(std::size_t n) { return (n + kBlock - 1) / kBlock * kBlock; }

// `count` elements from `first` on, `step` apart, then zeros to a multiple of 8.
void append_padded(ReductionOrder* order, std::size_t first, std::size_t count, std::size_t step) {
  for (std::size_t i = 0; i < padded(count); ++i) {
    order->push_back(i < count ? first + i * step : kZero);
  }
}

}  // namespace

ReductionOrder conv2d_order(std::size_t channels, std::size_t taps) {
  ReductionOrder order;
  for (std::size_t tap = 0; tap < taps; ++tap) {
    for (std::size_t c = 0; c < channels; ++c) {
      order.push_back(c * taps + tap);
    }
  }
  return order;
}

ReductionOrder map_order(std::size_t channels, std::size_t pixels) {
  ReductionOrder order;
  for (std::size_t block = 0; block < channels; block += kBlock) {
    const std::size_t lanes = std::min(kBlock, channels - block);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      append_padded(&order, block * pixels + pixel, lanes, pixels);
    }
  }
  return order;
}

ReductionOrder causal_conv_order(std::size_t channels) {
  ReductionOrder order;
  append_padded(&order, 0, channels, 2);
  append_padded(&order, 1, channels, 2);
  return order;
}

ReductionOrder lstm_order(std::size_t inputs, std::size_t hidden) {
  ReductionOrder order;
  append_padded(&order, 0, inputs, 1);
  append_padded(&order, inputs, hidden, 1);
  return order;
}

Halves pack_panels(std::span<const float> values, std::size_t outputs,
                   const ReductionOrder& order) {
  const std::size_t row = values.size() / outputs;
  const std::size_t width = padded(outputs);
  Halves packed;
  packed.reserve(width * order.size());
  for (std::size_t panel = 0; panel < width; panel += kPanel) {
    for (const std::size_t element : order) {
      for (std::size_t o = panel; o < std::min(panel + kPanel, width); ++o) {
        const bool zero = element == kZero || o >= outputs;
        packed.push_back(zero ? std::uint16_t{0} : fp16_from_float(values[o * row + element]));
      }
    }
  }
  return packed;
}

Halves pack_depthwise(std::span<const float> values, std::size_t channels, std::size_t taps) {
  Halves packed;
  packed.reserve(padded(channels) * taps);
  for (std::size_t block = 0; block < channels; block += kBlock) {
    for (std::size_t tap = 0; tap < taps; ++tap) {
      for (std::size_t c = block; c < block + kBlock; ++c) {
        packed.push_back(c < channels ? fp16_from_float(values[c * taps + tap]) : std::uint16_t{0});
      }
    }
  }
  return packed;
}

Halves pack_vector(std::span<const float> values) {
  Halves packed(padded(values.size()), 0);
  std::transform(values.begin(), values.end(), packed.begin(), fp16_from_float);
  return packed;
}

}  // namespace mien::formats
