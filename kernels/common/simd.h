// Vectors for kernels whose vector tiers share one source, FAMILY/simd.cpp. It is compiled for each
// tier, with MIEN_TIER as the tier's namespace. Every tier supplies:
//
//   Vec: kLanes floats, 4 or 8. splat, load, store; add, subtract, divide, max, exp;
//     sum_of_lanes, largest_lane: in all lanes
//   lane_mask(first, channels): the lanes of channels first .. first + kLanes - 1 that exist;
//     only(mask, x): 0 elsewhere; choose(mask, x, other)
//   BlockVec: the kBlock channels of a block, one vector or two. splat_block, load_block,
//     load_block_or_zero, store_block; add, max, either; block_mask(block, channels), only
//   LaneShift: kBlock consecutive channels of two blocks
//   BlockActivator: begin(x, block) is an activation, except for curves, which finish(y, pixels,
//     block) then applies to the values of a block in place
#pragma once

#if defined(MIEN_HAVE_AVX2)
#include "kernels/common/avx2_simd.h"
#elif defined(MIEN_HAVE_WASM)
#include "kernels/common/wasm_simd.h"
#else
#include "kernels/common/neon_simd.h"
#endif
