// The vectors of kernels/common/simd.h on NEON.
#pragma once

#include "kernels/common/neon_activation.h"

#include "kernels/common/two_vectors.h"
