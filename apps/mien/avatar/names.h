// Names of avatars in a spelling that can be compared.
#pragma once

#include <string>

namespace mien::app {

// The letters and digits of a name in lower case, with sides spelled out (_L is left), and without
// what precedes a dot, colon or bar.
[[nodiscard]] std::string plain_name(std::string name);

}  // namespace mien::app
