/* std::bit_cast for standard libraries that lack it, such as that of Emscripten 3.1.6 (Debian 12).
 */
#pragma once

#ifdef __cplusplus
#include <bit>

#ifndef __cpp_lib_bit_cast
namespace std {  // NOLINT: where the standard has it

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

}  // namespace std
#endif
#endif
