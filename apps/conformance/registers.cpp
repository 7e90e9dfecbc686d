// Calls the register check of this calling convention.
#include "apps/conformance/registers.h"

#include "apps/conformance/registers_abi.h"

namespace mien::conformance {
namespace {

#if defined(MIEN_REGISTERS_SYSV)
constexpr const char* kConvention = "x86-64 System V: rbx, rbp, r12-r15, direction flag, modes";
constexpr const char* kNames[] = {
    "rbx", "rbp", "r12", "r13", "r14", "r15", "direction flag", "mxcsr", "x87 control word"};
#elif defined(MIEN_REGISTERS_WIN64)
constexpr const char* kConvention =
    "x86-64 Windows: rbx, rbp, rdi, rsi, r12-r15, xmm6-xmm15, direction flag, modes";
constexpr const char* kNames[] = {"rbx",
                                  "rbp",
                                  "rdi",
                                  "rsi",
                                  "r12",
                                  "r13",
                                  "r14",
                                  "r15",
                                  "xmm6",
                                  "xmm7",
                                  "xmm8",
                                  "xmm9",
                                  "xmm10",
                                  "xmm11",
                                  "xmm12",
                                  "xmm13",
                                  "xmm14",
                                  "xmm15",
                                  "direction flag",
                                  "mxcsr",
                                  "x87 control word"};
#elif defined(MIEN_REGISTERS_AARCH64)
constexpr const char* kConvention = "AArch64: x19-x29, d8-d15, modes";
constexpr const char* kNames[] = {"x19", "x20", "x21", "x22", "x23", "x24", "x25",
                                  "x26", "x27", "x28", "x29", "d8",  "d9",  "d10",
                                  "d11", "d12", "d13", "d14", "d15", "fpcr"};
#elif defined(MIEN_REGISTERS_ARM)
constexpr const char* kConvention = "ARMv7: r4-r11, d8-d15, modes";
constexpr const char* kNames[] = {"r4", "r5",  "r6",  "r7",  "r8",  "r9",  "r10", "r11",  "d8",
                                  "d9", "d10", "d11", "d12", "d13", "d14", "d15", "fpscr"};
#else
constexpr const char* kConvention = nullptr;
constexpr const char* kNames[] = {""};
#endif

}  // namespace

const char* register_convention() { return kConvention; }

#if defined(MIEN_REGISTERS_SYSV) || defined(MIEN_REGISTERS_WIN64) || \
    defined(MIEN_REGISTERS_AARCH64) || defined(MIEN_REGISTERS_ARM)

extern "C" std::uint32_t mien_call_checked(void (*kernel)(), const void* args);

std::uint32_t call_checked(void (*kernel)(), const void* args) {
  return mien_call_checked(kernel, args);
}

#else

std::uint32_t call_checked(void (*)(), const void*) { return 0; }

#endif

std::string register_names(std::uint32_t changed) {
  std::string names;
  for (const char* one : kNames) {
    if ((changed & 1u) != 0) {
      names += (names.empty() ? "" : ", ") + std::string(one);
    }
    changed >>= 1;
  }
  return names;
}

}  // namespace mien::conformance
