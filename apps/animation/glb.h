// The container of binary glTF: a JSON document and the bytes of buffer 0 (Khronos, glTF 2.0,
// section 4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "apps/animation/fault.h"

namespace mien::animation {

inline constexpr std::string_view kGlbMagic = "glTF";
inline constexpr std::size_t kGlbHeaders = 12 + 2 * 8;  // bytes of a file besides its chunks

struct GlbChunks {
  std::string_view json;
  std::optional<std::string_view> data;
};

// Finds the chunks of a file that starts with kGlbMagic. They refer to `bytes`.
[[nodiscard]] bool split_glb(std::string_view bytes, GlbChunks& chunks, Fault& fault);

// Both chunks are padded. The file must not exceed 4 GiB.
[[nodiscard]] std::string glb_file(std::string json, std::string data);

// Numbers in the byte order of glTF. `count`: bytes, at most 4.
[[nodiscard]] std::uint32_t little_endian(std::string_view bytes, std::size_t at,
                                          std::size_t count = 4);
void put_u32(std::string& bytes, std::uint32_t value);

}  // namespace mien::animation
