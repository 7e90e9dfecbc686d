// The faulty kernels of the self-test.
#include "apps/conformance/faulty_kernels.h"

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <vector>

#include "apps/conformance/crash_guard.h"
#include "apps/conformance/guarded_buffer.h"
#include "apps/conformance/registers.h"
#include "apps/conformance/registers_abi.h"
#include "formats/fp16.h"

namespace mien::conformance {
namespace {

using kernels::AnyKernel;
using kernels::FullyConnectedArgs;

int padded(int outputs) { return (outputs + 7) / 8 * 8; }

// The volatile sink keeps the compiler from removing faulty accesses.
volatile float sink;

void correct(const FullyConnectedArgs& a) {
  kernels::find<FullyConnectedArgs>(kernels::bit(kernels::Tier::kRef))(a);
}

void wrong_tail(const FullyConnectedArgs& a) {
  correct(a);
  a.y[a.out_c - 1] *= 1.0f + 0x1p-15f;
}

void omits_tail(const FullyConnectedArgs& a) {
  const float before = a.y[padded(a.out_c) - 1];
  correct(a);
  a.y[padded(a.out_c) - 1] = before;
}

void lanes_not_cleared(const FullyConnectedArgs& a) {
  correct(a);
  for (int o = a.out_c; o < padded(a.out_c); ++o) {
    a.y[o] = 0x1p-100f;
  }
}

void writes_past_end(const FullyConnectedArgs& a) {
  correct(a);
  a.y[padded(a.out_c)] = 1.0f;
}

void writes_behind_border(const FullyConnectedArgs& a) {
  correct(a);
  a.y[padded(a.out_c) + 3] = 1.0f;
}

void writes_before_start(const FullyConnectedArgs& a) {
  correct(a);
  a.y[-1] = 1.0f;
}

void reads_past_end(const FullyConnectedArgs& a) {
  correct(a);
  sink = a.x[a.in_elems];
}

void reads_before_start(const FullyConnectedArgs& a) {
  correct(a);
  sink = a.x[-1];
}

void reads_weights_past_end(const FullyConnectedArgs& a) {
  correct(a);
  sink = a.weights[std::ptrdiff_t{a.in_elems} * padded(a.out_c)];
}

void adds_to_output(const FullyConnectedArgs& a) {
  const float before = a.y[0];
  correct(a);
  a.y[0] += 0.0f * before;
}

void changes_input(const FullyConnectedArgs& a) {
  correct(a);
  const_cast<float*>(a.x)[0] += 1.0f;
}

// Computes as if sums were in fp16.
void rounds_to_half(const FullyConnectedArgs& a) {
  correct(a);
  for (int o = 0; o < a.out_c; ++o) {
    a.y[o] = formats::float_from_fp16(formats::fp16_from_float(a.y[o]));
  }
}

// Correct for positive inputs.
void forgets_signs(const FullyConnectedArgs& a) {
  float magnitudes[8 * 64];
  const int n = a.in_elems < 8 * 64 ? a.in_elems : 8 * 64;
  for (int k = 0; k < n; ++k) {
    magnitudes[k] = std::abs(a.x[k]);
  }
  FullyConnectedArgs of_magnitudes = a;
  of_magnitudes.x = magnitudes;
  correct(of_magnitudes);
}

// Multiplies before scaling: 1e29 overflows fp32.
void overflows_early(const FullyConnectedArgs& a) {
  correct(a);
  volatile float large = a.y[0];
  large = large * 1e9f;
  a.y[0] = large * 1e-9f;
}

void ignores_activation(const FullyConnectedArgs& a) {
  FullyConnectedArgs plain = a;
  plain.activation = {};
  correct(plain);
}

void illegal_instruction(const FullyConnectedArgs& a) {
  correct(a);
  __builtin_trap();
}

// Not sanitized, because a sanitizer would end the program first.
__attribute__((no_sanitize("undefined"))) void null_pointer(const FullyConnectedArgs& a) {
  correct(a);
  const float* volatile nothing = nullptr;
  sink = *nothing;  // NOLINT: on purpose
}

void changes_rounding_mode(const FullyConnectedArgs& a) {
  correct(a);
  std::fesetround(FE_TOWARDZERO);
}

using kernels::InvertedResidualArgs;

void correct_block(const InvertedResidualArgs& a) {
  kernels::find<InvertedResidualArgs>(kernels::bit(kernels::Tier::kRef))(a);
}

// The biases of a layer whose inputs of 8 bits are too large by `shift`. `max`: integer of their
// bound.
std::vector<std::uint16_t> shifted_bias(const InvertedResidualArgs::Weights& layer, int outputs,
                                        float shift, float max) {
  std::vector<std::uint16_t> bias(layer.bias, layer.bias + padded(outputs));
  for (std::size_t o = 0; o < bias.size(); ++o) {
    const float scale = layer.scales[o] * layer.input_bound / max;
    const float shifted = formats::float_from_fp16(bias[o]) + shift * layer.sums[o] * scale;
    bias[o] = formats::fp16_from_float(shifted);
  }
  return bias;
}

// Takes unsigned inputs of 8 bits, to which kInt8Shift was added, for signed ones.
void forgets_int8_offsets(const InvertedResidualArgs& a) {
  if (a.expand.quads == nullptr) {
    return correct_block(a);
  }
  InvertedResidualArgs wrong = a;
  const auto bias = shifted_bias(a.expand, a.hidden_c, kernels::kInt8Shift, kernels::kInt8MapMax);
  wrong.expand.bias = bias.data();
  correct_block(wrong);
}

// Takes signed inputs of project, from which kInt8Shift was subtracted, for unsigned ones.
void forgets_signed_offsets(const InvertedResidualArgs& a) {
  if (a.project.quads == nullptr) {
    return correct_block(a);
  }
  InvertedResidualArgs wrong = a;
  const auto bias = shifted_bias(a.project, a.out_c, -kernels::kInt8Shift, kernels::kInt8BandMax);
  wrong.project.bias = bias.data();
  correct_block(wrong);
}

// Saturates inputs of 8 bits at half of their bound.
void saturates_int8_early(const InvertedResidualArgs& a) {
  if (a.expand.quads == nullptr) {
    return correct_block(a);
  }
  InvertedResidualArgs wrong = a;
  const std::ptrdiff_t elems = std::ptrdiff_t{padded(a.in_c)} * a.in_h * a.in_w;
  std::vector<float> x(a.x, a.x + elems);
  for (float& one : x) {
    one = std::clamp(one, -a.expand.input_bound / 2.0f, a.expand.input_bound / 2.0f);
  }
  wrong.x = x.data();
  correct_block(wrong);
}

using kernels::QuantizeToInt8Args;

void correct_panels(const QuantizeToInt8Args& a) {
  kernels::find<QuantizeToInt8Args>(kernels::bit(kernels::Tier::kRef))(a);
}

// Writes the panels of tiers that multiply another number of outputs at once.
void confuses_panels(const QuantizeToInt8Args& a) {
  QuantizeToInt8Args wrong = a;
  wrong.panel = 24 - a.panel;  // 8 for 16, and 16 for 8
  correct_panels(wrong);
}

template <class Args>
AnyKernel any(void (*kernel)(const Args&)) {
  return reinterpret_cast<AnyKernel>(kernel);
}

}  // namespace

#if defined(MIEN_REGISTERS_SYSV) || defined(MIEN_REGISTERS_WIN64) || \
    defined(MIEN_REGISTERS_AARCH64) || defined(MIEN_REGISTERS_ARM)
extern "C" void mien_loses_general_register();
#else
static void mien_loses_general_register() {}
#endif
#if defined(MIEN_REGISTERS_WIN64) || defined(MIEN_REGISTERS_AARCH64) || defined(MIEN_REGISTERS_ARM)
extern "C" void mien_loses_vector_register();
static constexpr bool kHaveVectorRegisters = true;
#else  // System V preserves none
static void mien_loses_vector_register() {}
static constexpr bool kHaveVectorRegisters = false;
#endif

// The assembly calls this after it has changed a register.
extern "C" void mien_correct_kernel(const FullyConnectedArgs& args);
void mien_correct_kernel(const FullyConnectedArgs& args) { correct(args); }

std::span<const FaultyKernel> faulty_kernels() {
  static const bool pages = have_guard_pages(), crashes = can_catch_crashes() && pages,
                    registers = register_convention() != nullptr;
  constexpr const char* kDense = "fully_connected";
  constexpr const char* kBlock = "inverted_residual";
  constexpr const char* kToInt8 = "quantize_to_int8";
  constexpr kernels::Tier kInt8 = kernels::Tier::kAvxVnni, kSigned = kernels::Tier::kNeonDot,
                          kMatrix = kernels::Tier::kNeonI8mm;
  // The first buffers end at a guard page; without guard pages, a stray write changes the border.
  static const Fault stray = crashes ? Fault::kCrashes : Fault::kTouchesBorder;
  static const FaultyKernel kFaults[] = {
      {"nothing: the kernel is correct", kDense, any(correct), Fault::kNone, true},
      {"last element wrong by 2^-15", kDense, any(wrong_tail), Fault::kWrongResult, true},
      {"last element not written", kDense, any(omits_tail), Fault::kWrongResult, true},
      {"unused lanes not zero", kDense, any(lanes_not_cleared), Fault::kWrongResult, true},
      {"writes past the end", kDense, any(writes_past_end), stray, true},
      {"writes near the end", kDense, any(writes_behind_border), stray, true},
      {"writes before the start", kDense, any(writes_before_start), Fault::kTouchesBorder, true},
      {"reads past the end", kDense, any(reads_past_end), Fault::kCrashes, crashes},
      {"reads before the start", kDense, any(reads_before_start), Fault::kCrashes, crashes},
      {"reads weights past the end", kDense, any(reads_weights_past_end), Fault::kCrashes, crashes},
      {"adds to what it should overwrite", kDense, any(adds_to_output), Fault::kWrongResult, true},
      {"changes its input", kDense, any(changes_input), Fault::kChangesInput, true},
      {"rounds sums to fp16", kDense, any(rounds_to_half), Fault::kWrongResult, true},
      {"correct for positive inputs only", kDense, any(forgets_signs), Fault::kWrongResult, true},
      {"overflows early", kDense, any(overflows_early), Fault::kWrongResult, true},
      {"ignores the activation", kDense, any(ignores_activation), Fault::kWrongResult, true},
      {"illegal instruction", kDense, any(illegal_instruction), Fault::kCrashes, crashes},
      {"null pointer", kDense, any(null_pointer), Fault::kCrashes, crashes},
      {"loses a general register", kDense, mien_loses_general_register, Fault::kClobbersRegister,
       registers},
      {"loses a vector register", kDense, mien_loses_vector_register, Fault::kClobbersRegister,
       kHaveVectorRegisters},
      {"leaves another rounding mode", kDense, any(changes_rounding_mode), Fault::kClobbersRegister,
       registers},
      {"nothing: the block is correct", kBlock, any(correct_block), Fault::kNone, true, kInt8},
      {"forgets offsets of 8 bits", kBlock, any(forgets_int8_offsets), Fault::kWrongResult, true,
       kInt8},
      {"8 bits saturate early", kBlock, any(saturates_int8_early), Fault::kWrongResult, true,
       kInt8},
      {"nothing: block with signed 8 bits", kBlock, any(correct_block), Fault::kNone, true,
       kSigned},
      {"forgets offsets of signed 8 bits", kBlock, any(forgets_signed_offsets), Fault::kWrongResult,
       true, kSigned},
      {"signed 8 bits saturate early", kBlock, any(saturates_int8_early), Fault::kWrongResult, true,
       kSigned},
      {"nothing: panels of 8 outputs", kToInt8, any(correct_panels), Fault::kNone, true, kMatrix},
      {"panels of 16 outputs for 8", kToInt8, any(confuses_panels), Fault::kWrongResult, true,
       kMatrix},
      {"panels of 8 outputs for 16", kToInt8, any(confuses_panels), Fault::kWrongResult, true,
       kSigned},
  };
  return kFaults;
}

}  // namespace mien::conformance
