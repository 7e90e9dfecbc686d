// Converts controls by the library's vocabularies.
#include "apps/mien/outputs/vocabulary_values.h"

#include <mien/mien.h>

#include <algorithm>
#include <array>

#include "apps/mien/system/failure.h"

namespace mien::app {

std::vector<float> vocabulary_values(int vocabulary, const animation::Frame& frame) {
  std::array<float, formats::kControlCount> controls;
  std::transform(frame.controls.begin(), frame.controls.end(), controls.begin(),
                 [](double value) { return static_cast<float>(formats::or_zero(value)); });
  std::vector<float> values(static_cast<std::size_t>(mien_vocabulary_size(vocabulary)));
  if (mien_vocabulary_values(vocabulary, controls.data(), values.data(),
                             static_cast<std::int32_t>(values.size())) != MIEN_OK) {
    throw Failure(kExitInternal, "unknown vocabulary");
  }
  return values;
}

}  // namespace mien::app
