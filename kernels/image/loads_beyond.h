// MIEN_LOADS_BEYOND precedes functions that load vectors of samples in the warp: they may extend
// beyond a copy to uninitialized values that are never used. clang's memory sanitizer does not
// track single lanes through a permutation.
#pragma once

#ifdef __has_feature
#if __has_feature(memory_sanitizer)
#define MIEN_LOADS_BEYOND __attribute__((no_sanitize("memory")))
#endif
#endif
#ifndef MIEN_LOADS_BEYOND
#define MIEN_LOADS_BEYOND
#endif
