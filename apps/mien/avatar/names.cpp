// Simplifies names of avatars.
#include "apps/mien/avatar/names.h"

#include <cctype>
#include <utility>

#include "formats/vocabulary/vocabulary.h"

namespace mien::app {

std::string plain_name(std::string name) {
  name.erase(0, name.find_last_of(".:|") + 1);
  for (char& letter : name) {
    letter = formats::to_lower(letter);
  }
  for (const auto& [side, spelled] : {std::pair{"_l", "left"}, std::pair{"_r", "right"}}) {
    if (name.ends_with(side)) {
      name.replace(name.size() - 2, 2, spelled);
    }
  }
  std::erase_if(name, [](unsigned char c) { return c >= 128 || std::isalnum(c) == 0; });
  return name;
}

}  // namespace mien::app
