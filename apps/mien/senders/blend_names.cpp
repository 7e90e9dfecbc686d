// Converts frames to named expressions.
#include "apps/mien/senders/blend_names.h"

#include <mien/mien.h>

#include <array>
#include <optional>

#include "apps/mien/system/failure.h"

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
  std::array<float, formats::kControlCount> controls;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    controls[i] = static_cast<float>(formats::or_zero(frame.controls[i]));
  }
  values_.clear();
  for (const Vocabulary& vocabulary : vocabularies_) {
    std::vector<float> values(vocabulary.names.size());
    if (mien_vocabulary_values(vocabulary.number, controls.data(), values.data(),
                               static_cast<std::int32_t>(values.size())) != MIEN_OK) {
      throw Failure(kExitInternal, "unknown vocabulary");
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      values_.push_back({vocabulary.names[i], double{values[i]}});
    }
  }
  return values_;
}

}  // namespace mien::app
