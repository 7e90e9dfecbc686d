// Reads and writes the container of binary glTF (Khronos, glTF 2.0, section 4).
#include "apps/mien/avatar/glb.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "apps/mien/system/failure.h"
#include "apps/protocols/bytes.h"

namespace mien::app {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr int kFloat = 5126;
constexpr int kMaxDepth = 100;

std::uint32_t little(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return value;
}

// The chunk that begins at `at`, or an empty view if the file ends there.
std::string_view chunk(std::string_view bytes, std::size_t at, std::uint32_t type,
                       const std::string& name) {
  if (bytes.size() < at + kChunkHeader || little(bytes, at + 4) != type) {
    return {};
  }
  const std::size_t size = little(bytes, at);
  if (size > bytes.size() - at - kChunkHeader) {
    throw Failure(kExitNoInput,
                  name + ": byte " + std::to_string(at) + ": the chunk exceeds the file");
  }
  return bytes.substr(at + kChunkHeader, size);
}

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
        throw Failure(kExitNoInput, name + ": " + list + " in other files are not supported (got " +
                                        uri + ", expected data in the .glb)");
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

void pad(std::string& text, char with) { text.append((4 - text.size() % 4) % 4, with); }

void append_chunk(std::string& file, std::uint32_t type, const std::string& content) {
  protocols::append_little(file, static_cast<std::uint32_t>(content.size()));
  protocols::append_little(file, type);
  file += content;
}

}  // namespace

Glb read_glb(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeader || little(bytes, 0) != kMagic || little(bytes, 4) != kVersion) {
    throw Failure(kExitNoInput, name + ": not a .glb or .vrm (glTF 2.0)");
  }
  if (little(bytes, 8) != bytes.size()) {
    throw Failure(kExitNoInput, name + ": byte 8: wrong file length (got " +
                                    std::to_string(bytes.size()) + ", expected " +
                                    std::to_string(little(bytes, 8)) + ")");
  }
  const std::string_view json = chunk(bytes, kHeader, kJson, name);
  Glb glb;
  try {
    glb.document = parsed(json, name);
    require_own_data(glb, name);
    load_buffer(glb, chunk(bytes, kHeader + kChunkHeader + json.size(), kBinary, name), name);
  } catch (const Json::exception& error) {
    throw Failure(kExitNoInput, name + ": invalid glTF: " + error.what());
  }
  return glb;
}

std::string glb_bytes(const Glb& glb) {
  std::string json = glb.document.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string data = glb.data;
  pad(json, ' ');
  pad(data, '\0');
  const std::size_t size = kHeader + 2 * kChunkHeader + json.size() + data.size();
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    throw Failure(kExitOutput, "the animated avatar exceeds the 4 GiB of a .glb");
  }
  std::string file;
  protocols::append_little(file, kMagic);
  protocols::append_little(file, kVersion);
  protocols::append_little(file, static_cast<std::uint32_t>(size));
  append_chunk(file, kJson, json);
  append_chunk(file, kBinary, data);
  return file;
}

std::size_t add_floats(Glb& glb, const std::vector<float>& values, std::size_t width) {
  pad(glb.data, '\0');
  Json view = {{"buffer", 0},
               {"byteOffset", glb.data.size()},
               {"byteLength", values.size() * sizeof(float)}};
  for (const float value : values) {
    protocols::append_little(glb.data, std::bit_cast<std::uint32_t>(value));
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
