// MIEN_UNROLLED precedes an innermost loop over vectors: gcc otherwise unrolls it too late to keep
// arrays in registers. clang does not need it.
#pragma once

#ifdef __clang__
#define MIEN_UNROLLED
#else
#define MIEN_UNROLLED _Pragma("GCC unroll 32")
#endif
