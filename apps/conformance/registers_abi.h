/* Which calling convention the register check of this build is for; none where there is no assembly
   for it (WebAssembly, which has no registers, and everything not listed). Read by C++ and by the
   assembler. */
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
