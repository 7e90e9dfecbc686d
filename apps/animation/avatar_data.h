// The packed avatar, from avatar.packed.
#pragma once

#include <cstddef>
#include <span>

namespace mien::animation {

[[nodiscard]] std::span<const std::byte> avatar_data();

}  // namespace mien::animation
