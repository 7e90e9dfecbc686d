// The argument structs of all kernel families and the declarations of all kernels.
#pragma once

#include "kernels/activation/activation.h"
#include "kernels/causal_conv/causal_conv.h"
#include "kernels/combine/combine.h"
#include "kernels/concat/concat.h"
#include "kernels/conv2d/conv2d.h"
#include "kernels/curve/curve.h"
#include "kernels/depthwise/depthwise.h"
#include "kernels/fma_peak/fma_peak.h"
#include "kernels/fully_connected/fully_connected.h"
#include "kernels/global_average_pool/global_average_pool.h"
#include "kernels/image/warp.h"
#include "kernels/inverted_residual/inverted_residual.h"
#include "kernels/lstm/lstm.h"
#include "kernels/matrix_vector/matrix_vector.h"
#include "kernels/max_pool/max_pool.h"
#include "kernels/normalize/normalize.h"
#include "kernels/pointwise/pointwise.h"
#include "kernels/power_spectrum/power_spectrum.h"
#include "kernels/quantize_to_int8/quantize_to_int8.h"
#include "kernels/quantize_weights/quantize_weights.h"
#include "kernels/rearrange/rearrange.h"
#include "kernels/residual_add/residual_add.h"
#include "kernels/resize/resize.h"
#include "kernels/slice/slice.h"
#include "kernels/softmax/softmax.h"

namespace mien::kernels {

#define MIEN_KERNEL(family, Args, tier) \
  namespace tier {                      \
  void family(const Args& args);        \
  }
#include "kernels/kernels.inc"
#undef MIEN_KERNEL

}  // namespace mien::kernels
