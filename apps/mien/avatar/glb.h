// An avatar in memory: the JSON document of a .glb, and the bytes of buffer 0.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace mien::app {

using Json = nlohmann::ordered_json;

// NOLINTNEXTLINE(bugprone-exception-escape): the checker believes that Json's destructor throws
struct Glb {
  Json document;
  std::string data;  // as long as buffer 0
};

// Reads a .glb or .vrm. Messages refer to it as `name`. Throws Failure(kExitNoInput), also for
// files whose geometry is in other files.
[[nodiscard]] Glb read_glb(std::string_view bytes, const std::string& name);

// Throws Failure(kExitOutput) if the file would exceed the format's 4 GiB.
[[nodiscard]] std::string glb_bytes(const Glb& glb);

// Appends an accessor of floats with `width` components per element, with the bounds of scalars.
// Returns its index.
std::size_t add_floats(Glb& glb, const std::vector<float>& values, std::size_t width);

}  // namespace mien::app
