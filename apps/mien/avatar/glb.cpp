// Reads avatars, and appends numbers to them.
#include "apps/mien/avatar/glb.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "apps/animation/glb.h"
#include "apps/mien/system/failure.h"
#include "apps/protocols/bytes.h"

namespace mien::app {
namespace {

constexpr int kFloat = 5126;
constexpr int kMaxDepth = 100;

Json parsed(std::string_view text, const std::string& name) {
  const auto limited = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > kMaxDepth) {
      throw Failure(kExitNoInput, name + ": JSON is nested too deeply");
    }
    return true;
  };
  return Json::parse(text, limited);
}

// Data in other files would be lost when the avatar is written elsewhere.
void require_own_data(const Glb& glb, const std::string& name) {
  for (const char* list : {"buffers", "images"}) {
    for (const Json& item : glb.document.value(list, Json::array())) {
      const std::string uri = item.value("uri", "");
      if (!uri.empty() && !uri.starts_with("data:")) {
        throw Failure(kExitNoInput, std::string(name)
                                        .append(": ")
                                        .append(list)
                                        .append(" in other files are not supported (got ")
                                        .append(uri)
                                        .append(", expected data in the .glb)"));
      }
    }
  }
}

// Buffer 0 is the binary chunk, which may be longer by its padding.
void load_buffer(Glb& glb, std::string_view data, const std::string& name) {
  Json& buffers = glb.document["buffers"];
  if (buffers.empty()) {
    buffers = Json::array({{{"byteLength", 0}}});
  }
  const auto size = buffers.at(0).at("byteLength").get<std::size_t>();
  if (buffers.at(0).contains("uri") || size > data.size()) {
    throw Failure(kExitNoInput, name + ": buffer 0 is not in the file (expected a .glb)");
  }
  glb.data = data.substr(0, size);
}

}  // namespace

Glb read_glb(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(animation::kGlbMagic)) {
    throw Failure(kExitNoInput, name + ": not a .glb or .vrm (glTF 2.0)");
  }
  animation::GlbChunks chunks;
  animation::Fault fault;
  if (!animation::split_glb(bytes, chunks, fault)) {
    throw Failure(kExitNoInput, name + ": " + describe(fault));
  }
  Glb glb;
  try {
    glb.document = parsed(chunks.json, name);
    require_own_data(glb, name);
    load_buffer(glb, chunks.data.value_or(std::string_view()), name);
  } catch (const Json::exception& error) {
    throw Failure(kExitNoInput, name + ": invalid glTF: " + error.what());
  }
  return glb;
}

std::string glb_bytes(const Glb& glb) {
  std::string json = glb.document.dump(-1, ' ', false, Json::error_handler_t::replace);
  constexpr std::size_t kPadding = 6;  // of both chunks
  if (animation::kGlbHeaders + json.size() + glb.data.size() + kPadding >
      std::numeric_limits<std::uint32_t>::max()) {
    throw Failure(kExitOutput, "avatar: exceeds the 4 GiB of a .glb with the animation");
  }
  return animation::glb_file(std::move(json), glb.data);
}

std::size_t add_floats(Glb& glb, const std::vector<float>& values, std::size_t width) {
  glb.data.resize((glb.data.size() + 3) / 4 * 4);
  Json view = {{"buffer", 0},
               {"byteOffset", glb.data.size()},
               {"byteLength", values.size() * sizeof(float)}};
  for (const float value : values) {
    protocols::append_little_float(glb.data, double{value});
  }
  glb.document["buffers"][0]["byteLength"] = glb.data.size();
  Json& views = glb.document["bufferViews"];
  views.push_back(std::move(view));
  Json accessor = {{"bufferView", views.size() - 1},
                   {"componentType", kFloat},
                   {"count", values.size() / width},
                   {"type", width == 4 ? "VEC4" : "SCALAR"}};
  if (width == 1) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    accessor["min"] = {*low};
    accessor["max"] = {*high};
  }
  Json& accessors = glb.document["accessors"];
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

}  // namespace mien::app
