// Inputs that find faults: signed, zero, denormal, huge and ordinary numbers, from one seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "kernels/families.h"

namespace mien::tests {

class RandomValues {
 public:
  explicit RandomValues(unsigned seed) : random_(seed) {}

  int between(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  float value() {
    const float ordinary = std::normal_distribution<float>()(random_);
    switch (between(0, 19)) {
      case 0:
        return 0.0f;
      case 1:
        return -0.0f;
      case 2:
        return ordinary * 1e-40f;  // denormal
      case 3:
        return ordinary * 1e4f;
      default:
        return ordinary;
    }
  }

  // Blocks of 8 channels [ceil(c/8)][pixels][8]; unused lanes zero.
  std::vector<float> map(int pixels, int channels) {
    const int blocks = (channels + 7) / 8;
    std::vector<float> values(static_cast<std::size_t>(blocks * pixels * 8));
    for (int b = 0; b < blocks; ++b) {
      for (int p = 0; p < pixels; ++p) {
        for (int lane = 0; lane < 8; ++lane) {
          const bool used = b * 8 + lane < channels;
          values[static_cast<std::size_t>((b * pixels + p) * 8 + lane)] = used ? value() : 0.0f;
        }
      }
    }
    return values;
  }

  std::vector<float> plain(int count) {
    std::vector<float> values(static_cast<std::size_t>(count));
    for (float& one : values) {
      one = value();
    }
    return values;
  }

  // fp16 numbers, denormals and zeros among them.
  std::vector<std::uint16_t> halves(int count) {
    std::vector<float> wide(static_cast<std::size_t>(count));
    for (float& one : wide) {
      one = std::normal_distribution<float>(0.0f, 0.3f)(random_) *
            (between(0, 15) == 0 ? 1e-6f : 1.0f);
    }
    std::vector<std::uint16_t> narrow(wide.size());
    kernels::ref::float_to_half({wide.data(), narrow.data(), count});
    return narrow;
  }

  // Weights and biases of output channels that do not exist are zero.
  void clear_unused_outputs(std::vector<std::uint16_t>& panels, int outputs, int reduction) {
    const int padded = (outputs + 7) / 8 * 8;
    for (int o = outputs; o < padded; ++o) {
      const int first = o / 16 * 16;
      const int width = std::min(16, padded - first);
      for (int k = 0; k < reduction; ++k) {
        panels[static_cast<std::size_t>(first * reduction + k * width + o - first)] = 0;
      }
    }
  }

  std::vector<std::uint16_t> panels(int outputs, int reduction) {
    std::vector<std::uint16_t> values = halves((outputs + 7) / 8 * 8 * reduction);
    clear_unused_outputs(values, outputs, reduction);
    return values;
  }

  std::vector<std::uint16_t> bias(int outputs) {
    std::vector<std::uint16_t> values = halves((outputs + 7) / 8 * 8);
    std::fill(values.begin() + outputs, values.end(), std::uint16_t{0});
    return values;
  }

 private:
  std::mt19937 random_;
};

}  // namespace mien::tests
