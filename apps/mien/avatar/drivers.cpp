// Matches names of morph targets and expressions with vocabularies.
#include "apps/mien/avatar/drivers.h"

#include <mien/mien.h>

#include <algorithm>
#include <cstdint>

#include "apps/mien/outputs/vocabulary_values.h"
#include "apps/mien/system/failure.h"
#include "formats/vocabulary/plain_name.h"

namespace mien::app {
namespace {

constexpr std::size_t kMinArkitNames = 20;  // of a VRM with "perfect sync"

std::string plain_name(const std::string& name) {
  return std::string(formats::PlainName(name).text());
}

// The drivers of a vocabulary, by plain name.
Drivers table(int vocabulary) {
  Drivers drivers;
  for (std::int32_t i = 0; i < mien_vocabulary_size(vocabulary); ++i) {
    const auto value = static_cast<std::size_t>(i);
    drivers[plain_name(mien_vocabulary_name(vocabulary, i))] = {vocabulary, {value, value}};
  }
  return drivers;
}

Drivers found(const std::vector<std::string>& names, const Drivers& table) {
  Drivers drivers;
  for (const std::string& name : names) {
    if (const auto known = table.find(plain_name(name)); known != table.end()) {
      drivers[name] = known->second;
    }
  }
  return drivers;
}

}  // namespace

Drivers morph_drivers(const std::vector<std::string>& names) {
  std::vector<const char*> texts(names.size());
  std::transform(names.begin(), names.end(), texts.begin(),
                 [](const std::string& name) { return name.c_str(); });
  std::vector<std::int32_t> vocabularies(names.size()), indices(names.size());
  if (mien_vocabulary_match(texts.data(), static_cast<std::int32_t>(names.size()),
                            vocabularies.data(), indices.data()) != MIEN_OK) {
    throw Failure(kExitInternal, "morph targets: unexpected names");
  }
  Drivers drivers;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (indices[i] >= 0) {
      const auto value = static_cast<std::size_t>(indices[i]);
      drivers[names[i]] = {vocabularies[i], {value, value}};
    }
  }
  return drivers;
}

Drivers expression_drivers(const std::vector<std::string>& names) {
  Drivers drivers = found(names, table(MIEN_VOCABULARY_ARKIT));
  if (drivers.size() > kMinArkitNames) {
    return drivers;
  }
  Drivers presets = table(MIEN_VOCABULARY_VRM1);
  presets.merge(table(MIEN_VOCABULARY_VRM0));
  const Driver left = presets.at("blinkleft"), right = presets.at("blinkright");
  if (found(names, {{"blinkleft", left}, {"blinkright", right}}).empty()) {
    presets["blink"] = {left.vocabulary, {left.values[0], right.values[0]}};
  }
  drivers.merge(found(names, presets));
  return drivers;
}

DriverValues::DriverValues(const animation::Frame& frame) {
  for (int vocabulary = MIEN_VOCABULARY_ARKIT; vocabulary <= MIEN_VOCABULARY_VISEMES;
       ++vocabulary) {
    values_.push_back(vocabulary_values(vocabulary, frame));
  }
}

double DriverValues::of(const Driver& driver) const {
  const std::vector<float>& values = values_[static_cast<std::size_t>(driver.vocabulary)];
  return (double{values[driver.values[0]]} + double{values[driver.values[1]]}) / 2.0;
}

}  // namespace mien::app
