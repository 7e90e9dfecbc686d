// Converts frames to named expressions.
#include "apps/mien/senders/blend_names.h"

#include <mien/mien.h>

#include <optional>

#include "apps/mien/outputs/vocabulary_values.h"

namespace mien::app {
namespace {

std::optional<int> number_of(const std::string& vocabulary) {
  return vocabulary == "pascal" || vocabulary == "camel" ? std::optional<int>(MIEN_VOCABULARY_ARKIT)
         : vocabulary == "vrm0"                          ? std::optional<int>(MIEN_VOCABULARY_VRM0)
         : vocabulary == "vrm1"                          ? std::optional<int>(MIEN_VOCABULARY_VRM1)
                                                         : std::nullopt;
}

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

}  // namespace

BlendNames::BlendNames(const std::string& vocabularies, const Destination& destination) {
  for (std::size_t begin = 0; begin <= vocabularies.size();) {
    const std::size_t end = std::min(vocabularies.find(',', begin), vocabularies.size());
    const std::string name = vocabularies.substr(begin, end - begin);
    begin = end + 1;
    const std::optional<int> number = number_of(name);
    if (!number) {
      destination.fail("names: unknown vocabulary '" + name +
                       "', supported are pascal, camel, vrm0, vrm1, separated by commas");
    }
    Vocabulary vocabulary{*number, {}};
    for (std::int32_t i = 0; i < mien_vocabulary_size(*number); ++i) {
      vocabulary.names.emplace_back(mien_vocabulary_name(*number, i));
      if (name == "pascal") {
        vocabulary.names.back()[0] = upper(vocabulary.names.back()[0]);
      }
    }
    vocabularies_.push_back(std::move(vocabulary));
  }
}

std::span<const protocols::NamedValue> BlendNames::values(const animation::Frame& frame) {
  values_.clear();
  for (const Vocabulary& vocabulary : vocabularies_) {
    const std::vector<float> values = vocabulary_values(vocabulary.number, frame);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values_.push_back({vocabulary.names[i], double{values[i]}});
    }
  }
  return values_;
}

}  // namespace mien::app
