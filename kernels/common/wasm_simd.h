// The vectors of kernels/common/simd.h on WebAssembly.
#pragma once

#include "kernels/common/unrolled.h"
#include "kernels/common/wasm_activation.h"

#include "kernels/common/two_vectors.h"
