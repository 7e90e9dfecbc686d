// The floating-point state in which the library computes, independent of the caller's.
#pragma once

#include <cstdint>

#if defined(__i386__) && !defined(__SSE2_MATH__)
#error "mien requires -msse2 -mfpmath=sse on 32-bit x86: the x87 rounds to another precision"
#endif
#if defined(__SSE2_MATH__) || defined(_M_X64)
#include <xmmintrin.h>
#endif

namespace mien::kernels {

// While an object lives, the calling thread rounds to nearest, traps nothing and treats denormal
// numbers as zero, because arithmetic on them takes about a hundred times as long. Results
// therefore do not depend on the caller's state, which the destructor restores, sticky flags
// included. Costs tens of cycles.
class FloatMode {
 public:
  FloatMode() : callers_(get()) { set(kOurs); }
  ~FloatMode() { set(callers_); }
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
#if defined(__i386__)
  // State of SSE and of the x87, which functions of the C library use: 14 words of 16 bits.
  struct State {
    std::uint32_t mxcsr;
    std::uint16_t x87[14];
  };
  // MXCSR as below; x87: all exceptions masked, 64 bits of precision, no flag set, no register
  // used.
  static constexpr State kOurs = {0x1F80u | 0x8000u | 0x0040u, {0x037F, 0, 0, 0, 0xFFFF}};
  static State get() {
    State state{_mm_getcsr(), {}};
    asm volatile("fnstenv %0" : "=m"(state.x87));
    return state;
  }
  static void set(const State& state) {
    _mm_setcsr(state.mxcsr);
    asm volatile("fldenv %0" ::"m"(state.x87));
  }
#elif defined(__SSE2_MATH__) || defined(_M_X64)
  using State = std::uint32_t;
  // MXCSR: all exceptions masked, flush to zero, denormals are zero.
  static constexpr State kOurs = 0x1F80u | 0x8000u | 0x0040u;
  static State get() { return _mm_getcsr(); }
  static void set(State state) { _mm_setcsr(state); }
#elif defined(__aarch64__)
  struct State {
    std::uint64_t control, flags;
  };
  static constexpr State kOurs = {std::uint64_t{1} << 24, 0};  // FPCR.FZ
  static State get() {
    State state{};
    asm volatile("mrs %0, fpcr\n\tmrs %1, fpsr" : "=r"(state.control), "=r"(state.flags));
    return state;
  }
  static void set(const State& state) {
    asm volatile("msr fpcr, %0\n\tmsr fpsr, %1" ::"r"(state.control), "r"(state.flags));
  }
#elif defined(__arm__) && defined(__ARM_FP)
  using State = std::uint32_t;
  static constexpr State kOurs = std::uint32_t{1} << 24;  // FPSCR.FZ, which NEON always implies
  static State get() {
    State state = 0;
    asm volatile("vmrs %0, fpscr" : "=r"(state));
    return state;
  }
  static void set(State state) { asm volatile("vmsr fpscr, %0" ::"r"(state)); }
#else  // WebAssembly has no such state; other machines only have the reference tier
  using State = int;
  static constexpr State kOurs = 0;
  static State get() { return 0; }
  static void set(State) {}
#endif

  State callers_;
};

}  // namespace mien::kernels
