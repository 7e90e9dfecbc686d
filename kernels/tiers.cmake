# Lists the source files of each tier, relative to this folder. Every family has a reference kernel; a tier has kernels
# for the families that it accelerates.
set(mien_tier_families
  causal_conv conv2d depthwise fma_peak fully_connected image lstm matrix_vector pointwise power_spectrum)
# Families whose vector tiers share a source, simd.cpp (kernels/common/simd.h).
set(mien_simd_families activation concat global_average_pool max_pool residual_add slice softmax)
if(NOT MIEN_TRIM_LAYERS)
  list(APPEND mien_simd_families combine curve normalize rearrange resize)
endif()
set(mien_ref_extra quantize_to_int8/ref.cpp quantize_weights/ref.cpp inverted_residual/ref.cpp)
set(mien_avx2_extra inverted_residual/avx2.cpp pointwise/avx2_product.cpp)
if(MIEN_WITH_HALF_PRECISION)
  list(APPEND mien_avx2_extra quantize_to_int8/avx2.cpp quantize_weights/avx2.cpp)  # for all quantized tiers of x86
endif()
set(mien_avx2int16_families fma_peak inverted_residual)
set(mien_avx2int16_extra inverted_residual/avx2int16_product.cpp)
set(mien_avxvnni_families fma_peak inverted_residual)
set(mien_avxvnni_extra inverted_residual/avxvnni_product.cpp)
set(mien_avx512_families
  causal_conv conv2d fma_peak fully_connected image inverted_residual lstm pointwise)
set(mien_avx512_extra pointwise/avx512_product.cpp)
set(mien_avx512vnni_families fma_peak inverted_residual)
set(mien_avx512vnni_extra inverted_residual/avx512vnni_product.cpp)
set(mien_avx512fp16_families fma_peak inverted_residual)
set(mien_avx512fp16_extra inverted_residual/avx512fp16_product.cpp)
set(mien_wasmint16_families fma_peak inverted_residual)
set(mien_wasmint16_extra inverted_residual/wasmint16_product.cpp)
if(MIEN_WITH_HALF_PRECISION)
  set(mien_wasm_extra quantize_weights/wasm.cpp)  # for wasmint16
endif()
set(mien_neon_extra inverted_residual/neon.cpp pointwise/neon_product.cpp)
set(mien_neon32_extra ${mien_neon_extra})
set(mien_neonfp16_families causal_conv fully_connected lstm)
set(mien_neonfp16_extra
  fma_peak/neonfp16.cpp inverted_residual/neonfp16.cpp inverted_residual/neonfp16_product.cpp)

set(mien_neondot_families "")
set(mien_neondot_extra
  fma_peak/neondot.cpp inverted_residual/neondot.cpp inverted_residual/neondot_product.cpp
  quantize_to_int8/neondot.cpp)
set(mien_neoni8mm_families "")
set(mien_neoni8mm_extra
  fma_peak/neoni8mm.cpp inverted_residual/neoni8mm.cpp inverted_residual/neoni8mm_product.cpp
  quantize_to_int8/neondot.cpp)

function(mien_tier_sources tier output)
  set(families ${mien_tier_families})
  set(simd_families ${mien_simd_families})
  if(DEFINED mien_${tier}_families)
    set(families ${mien_${tier}_families})
    set(simd_families)
  endif()
  set(file ${tier})
  set(simd_file simd)
  if(tier MATCHES "^neon")  # all NEON tiers share a source (kernels/common/neon.h)
    set(file neon)
  elseif(tier STREQUAL ref)
    set(simd_file ref)
  endif()
  list(TRANSFORM families APPEND /${file}.cpp)
  list(TRANSFORM simd_families APPEND /${simd_file}.cpp)
  set(${output} ${families} ${simd_families} ${mien_${tier}_extra} PARENT_SCOPE)
endfunction()
