#include "apps/conformance/planted_faults.h"

#include <cfenv>
#include <cmath>
#include <cstring>

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

// The compiler cannot know what becomes of this, so it leaves no faulty access out.
volatile float sink;

void right(const FullyConnectedArgs& a) {
  kernels::find<FullyConnectedArgs>(kernels::bit(kernels::Tier::kRef))(a);
}

void wrong_tail(const FullyConnectedArgs& a) {
  right(a);
  a.y[a.out_c - 1] *= 1.0f + 0x1p-15f;
}

void leaves_tail_out(const FullyConnectedArgs& a) {
  const float before = a.y[padded(a.out_c) - 1];
  right(a);
  a.y[padded(a.out_c) - 1] = before;
}

void lanes_not_cleared(const FullyConnectedArgs& a) {
  right(a);
  for (int o = a.out_c; o < padded(a.out_c); ++o) {
    a.y[o] = 0x1p-100f;
  }
}

void writes_past_end(const FullyConnectedArgs& a) {
  right(a);
  a.y[padded(a.out_c)] = 1.0f;
}

void writes_behind_border(const FullyConnectedArgs& a) {
  right(a);
  a.y[padded(a.out_c) + 3] = 1.0f;
}

void writes_before_start(const FullyConnectedArgs& a) {
  right(a);
  a.y[-1] = 1.0f;
}

void reads_past_end(const FullyConnectedArgs& a) {
  right(a);
  sink = a.x[a.in_elems];
}

void reads_before_start(const FullyConnectedArgs& a) {
  right(a);
  sink = a.x[-1];
}

void reads_weights_past_end(const FullyConnectedArgs& a) {
  right(a);
  sink = a.weights[std::ptrdiff_t{a.in_elems} * padded(a.out_c)];
}

void adds_to_output(const FullyConnectedArgs& a) {
  const float before = a.y[0];
  right(a);
  a.y[0] += 0.0f * before;
}

void changes_input(const FullyConnectedArgs& a) {
  right(a);
  const_cast<float*>(a.x)[0] += 1.0f;
}

// As if fp16 had been used for the sums.
void rounds_to_half(const FullyConnectedArgs& a) {
  right(a);
  for (int o = 0; o < a.out_c; ++o) {
    a.y[o] = formats::float_from_fp16(formats::fp16_from_float(a.y[o]));
  }
}

// Right wherever inputs are positive.
void forgets_signs(const FullyConnectedArgs& a) {
  float magnitudes[8 * 64];
  const int n = a.in_elems < 8 * 64 ? a.in_elems : 8 * 64;
  for (int k = 0; k < n; ++k) {
    magnitudes[k] = std::abs(a.x[k]);
  }
  FullyConnectedArgs of_magnitudes = a;
  of_magnitudes.x = magnitudes;
  right(of_magnitudes);
}

// Multiplies before it scales: 1e29 leaves fp32.
void overflows_early(const FullyConnectedArgs& a) {
  right(a);
  volatile float large = a.y[0];
  large = large * 1e9f;
  a.y[0] = large * 1e-9f;
}

void ignores_activation(const FullyConnectedArgs& a) {
  FullyConnectedArgs plain = a;
  plain.activation = {};
  right(plain);
}

void illegal_instruction(const FullyConnectedArgs& a) {
  right(a);
  __builtin_trap();
}

// A sanitizer would end the program before the fault does.
__attribute__((no_sanitize("undefined"))) void null_pointer(const FullyConnectedArgs& a) {
  right(a);
  const float* volatile nothing = nullptr;
  sink = *nothing;  // NOLINT: on purpose
}

void changes_rounding_mode(const FullyConnectedArgs& a) {
  right(a);
  std::fesetround(FE_TOWARDZERO);
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
#else  // System V keeps none
static void mien_loses_vector_register() {}
static constexpr bool kHaveVectorRegisters = false;
#endif

// Where the assembly goes on, with its register lost.
extern "C" void mien_right_kernel(const FullyConnectedArgs& args);
void mien_right_kernel(const FullyConnectedArgs& args) { right(args); }

std::span<const PlantedFault> planted_faults() {
  static const bool pages = have_guard_pages(), crashes = can_catch_crashes() && pages,
                    registers = register_convention() != nullptr;
  constexpr const char* kDense = "fully_connected";
  // The first buffers end at a guarded page; where there is none, a stray write shows in the
  // border.
  static const Fault stray = crashes ? Fault::kCrashes : Fault::kTouchesBorder;
  static const PlantedFault kFaults[] = {
      {"nothing: the kernel is right", kDense, any(right), Fault::kNone, true},
      {"last element wrong by 2^-15", kDense, any(wrong_tail), Fault::kWrongResult, true},
      {"last element not written", kDense, any(leaves_tail_out), Fault::kWrongResult, true},
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
      {"right for positive inputs only", kDense, any(forgets_signs), Fault::kWrongResult, true},
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
  };
  return kFaults;
}

}  // namespace mien::conformance
