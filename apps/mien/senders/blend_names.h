// Names of expressions in the vocabularies of avatars.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/mien/senders/destination.h"
#include "apps/protocols/vmc.h"

namespace mien::app {

class BlendNames {
 public:
  // `vocabularies`: names of pascal, camel, vrm0, vrm1, separated by commas. Throws Failure.
  BlendNames(const std::string& vocabularies, const Destination& destination);

  // The values of all vocabularies, valid until the next call.
  std::span<const protocols::NamedValue> values(const animation::Frame& frame);

 private:
  struct Vocabulary {
    int number = 0;                  // a mien_vocabulary
    std::vector<std::string> names;  // as sent
  };
  std::vector<Vocabulary> vocabularies_;
  std::vector<protocols::NamedValue> values_;
};

}  // namespace mien::app
