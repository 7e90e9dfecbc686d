// Matches names of morph targets and expressions with vocabularies, as bindings/js/matching.js.
#include "apps/mien/avatar/drivers.h"

#include <mien/mien.h>

#include <algorithm>
#include <utility>

#include "apps/mien/avatar/names.h"
#include "apps/mien/outputs/vocabulary_values.h"

namespace mien::app {
namespace {

// Fewer names that may be of visemes or vowels, such as "A", mean something else.
constexpr std::size_t kMinMouthNames = 3;
constexpr std::size_t kMinArkitNames = 20;  // of a VRM with "perfect sync"

// Drivers by plain names.
Drivers table(int vocabulary) {
  Drivers drivers;
  for (std::int32_t i = 0; i < mien_vocabulary_size(vocabulary); ++i) {
    const auto value = static_cast<std::size_t>(i);
    drivers[plain_name(mien_vocabulary_name(vocabulary, i))] = {vocabulary, {value, value}};
  }
  return drivers;
}

Drivers face_table() {
  Drivers drivers = table(MIEN_VOCABULARY_ARKIT);
  drivers.merge(table(MIEN_VOCABULARY_ROBLOX));
  return drivers;
}

Drivers viseme_table() {
  const Drivers visemes = table(MIEN_VOCABULARY_VISEMES);
  Drivers drivers = visemes;
  for (const auto& [name, driver] : visemes) {
    drivers["viseme" + name] = drivers["v" + name] = driver;
  }
  for (std::size_t i = 0; i < formats::kVisemeCount; ++i) {
    drivers[plain_name(std::string(formats::kReadyPlayerMeNames[i]))] = {MIEN_VOCABULARY_VISEMES,
                                                                         {i, i}};
  }
  return drivers;
}

Drivers vrm0_table() {
  Drivers drivers = table(MIEN_VOCABULARY_VRM0);
  // Morph targets of VRoid Studio.
  constexpr std::pair<const char*, const char*> kVroid[] = {{"Fcl_ALL_Joy", "Joy"},
                                                            {"Fcl_ALL_Angry", "Angry"},
                                                            {"Fcl_ALL_Sorrow", "Sorrow"},
                                                            {"Fcl_ALL_Fun", "Fun"},
                                                            {"Fcl_MTH_A", "A"},
                                                            {"Fcl_MTH_I", "I"},
                                                            {"Fcl_MTH_U", "U"},
                                                            {"Fcl_MTH_E", "E"},
                                                            {"Fcl_MTH_O", "O"},
                                                            {"Fcl_EYE_Close_L", "Blink_L"},
                                                            {"Fcl_EYE_Close_R", "Blink_R"}};
  for (const auto& [morph, expression] : kVroid) {
    drivers[plain_name(morph)] = drivers.at(plain_name(expression));
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

bool opens_jaw(const Drivers& drivers) {
  return std::any_of(drivers.begin(), drivers.end(), [](const auto& named) {
    const std::string name = plain_name(named.first);
    return name == "jawopen" || name == "jawdrop";
  });
}

}  // namespace

Drivers morph_drivers(const std::vector<std::string>& names) {
  Drivers face = found(names, face_table());
  if (opens_jaw(face)) {
    return face;
  }
  Drivers mouth;
  for (const Drivers& table : {viseme_table(), table(MIEN_VOCABULARY_VRM1), vrm0_table()}) {
    if (Drivers matching = found(names, table); matching.size() > mouth.size()) {
      mouth = std::move(matching);
    }
  }
  if (mouth.size() >= kMinMouthNames) {
    face.merge(mouth);
  }
  return face;
}

Drivers expression_drivers(const std::vector<std::string>& names) {
  Drivers drivers = found(names, table(MIEN_VOCABULARY_ARKIT));
  if (drivers.size() > kMinArkitNames) {
    return drivers;
  }
  Drivers presets = table(MIEN_VOCABULARY_VRM1);
  presets.merge(vrm0_table());
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
