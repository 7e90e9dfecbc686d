/* Selects the calling convention of the register check; none without assembly for it (WebAssembly,
   which has no registers, and all other targets). Included by C++ and assembly. */
#ifndef MIEN_CONFORMANCE_REGISTERS_ABI_H
#define MIEN_CONFORMANCE_REGISTERS_ABI_H

#if defined(__x86_64__) && defined(_WIN32)
#define MIEN_REGISTERS_WIN64
#elif defined(__x86_64__) && defined(__LP64__)
#define MIEN_REGISTERS_SYSV
#elif defined(__aarch64__) && !defined(_WIN32)
#define MIEN_REGISTERS_AARCH64
#elif defined(__arm__) && defined(__ARM_FP) && !defined(__SOFTFP__) && !defined(_WIN32)
#define MIEN_REGISTERS_ARM
#endif

#if defined(__APPLE__)
#define MIEN_SYMBOL(name) _##name
#else
#define MIEN_SYMBOL(name) name
#endif

#endif
