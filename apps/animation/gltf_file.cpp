// Reads documents, buffers and accessors of glTF.
#include "apps/animation/gltf_file.h"

#include <bit>
#include <cmath>

#include "apps/animation/base64.h"
#include "apps/animation/glb.h"
#include "apps/animation/numbers.h"

namespace mien::animation {
namespace {

constexpr std::int64_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                       kFloat = 5126;

// Decodes a URI: %20 is a space.
std::string percent_decoded(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t high = i + 2 < text.size() && text[i] == '%'
                                 ? kDigits.find(formats::to_lower(text[i + 1]))
                                 : kDigits.npos;
    const std::size_t low =
        high != kDigits.npos ? kDigits.find(formats::to_lower(text[i + 2])) : high;
    if (low == kDigits.npos) {
      decoded += text[i];
    } else {
      decoded += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return decoded;
}

// Extensions that compress buffer views. Other extensions do not affect the data read here.
constexpr std::string_view kCompressions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

}  // namespace

float GltfNumbers::operator[](std::size_t i) const {
  const std::size_t at = i / width_ * stride_ + i % width_ * component_bytes_;
  const std::uint32_t raw = little_endian(bytes_, at, component_bytes_);
  switch (type_) {
    case kByte:
      return std::max(static_cast<float>(static_cast<std::int8_t>(raw)) / 127.0f, -1.0f);
    case kUnsignedByte:
      return static_cast<float>(raw) / 255.0f;
    case kShort:
      return std::max(static_cast<float>(static_cast<std::int16_t>(raw)) / 32767.0f, -1.0f);
    case kUnsignedShort:
      return static_cast<float>(raw) / 65535.0f;
    default:
      return std::bit_cast<float>(raw);
  }
}

bool GltfFile::read(std::string_view bytes) {
  GlbChunks chunks = {bytes, std::nullopt};
  if (bytes.starts_with(kGlbMagic) && !split_glb(bytes, chunks, fault_)) {
    return false;
  }
  chunk_ = chunks.data;
  if (!document_.parse(chunks.json, fault_)) {
    return false;
  }
  find_lists();
  return true;
}

// Lists whose items are referenced by index, collected once so that lookups take constant time.
void GltfFile::find_lists() {
  for (const char* name : {"accessors", "bufferViews", "buffers", "meshes", "nodes"}) {
    Items& items = lists_[name];
    const std::optional<JsonValue> found = root().find(name);
    if (found && found->is(JsonValue::Kind::kArray)) {
      for (const JsonValue item : found->items()) {
        items.push_back(item);
      }
    }
  }
}

const GltfFile::Items& GltfFile::list(std::string_view of) const { return lists_.find(of)->second; }

std::optional<std::size_t> GltfFile::index(const JsonValue& from, std::string_view key,
                                           std::string_view of) {
  const std::optional<JsonValue> found = from.find(key);
  std::int64_t i = -1;
  if (!found || !found->integer(i)) {
    static_cast<void>(from.fail_here(std::string(key) + ": missing", fault_));
    return std::nullopt;
  }
  if (i < 0 || static_cast<std::uint64_t>(i) >= list(of).size()) {
    static_cast<void>(found->fail_here(std::string(key) + ": invalid index", fault_));
    return std::nullopt;
  }
  return static_cast<std::size_t>(i);
}

// 0 if absent. Returns false if it is not a number of bytes or elements.
bool GltfFile::count(const JsonValue& from, std::string_view key, std::size_t& value) {
  value = 0;
  const std::optional<JsonValue> found = from.find(key);
  std::int64_t read = 0;
  constexpr std::int64_t kMax = 0xFFFFFFFF;
  if (!found) {
    return true;
  }
  if (!found->integer(read) || read < 0 || read > kMax) {
    return found->fail_here(std::string(key) + ": out of range", fault_);
  }
  value = static_cast<std::size_t>(read);
  return true;
}

bool GltfFile::component_type(const JsonValue& accessor, GltfNumbers& numbers) {
  const std::optional<JsonValue> type = accessor.find("componentType");
  const std::optional<JsonValue> normalized = accessor.find("normalized");
  numbers.type_ = 0;
  const bool stated = type && type->integer(numbers.type_);
  const bool whole = normalized && normalized->truth();
  switch (stated ? numbers.type_ : 0) {
    case kFloat:
      numbers.component_bytes_ = 4;
      return true;
    case kByte:
    case kUnsignedByte:
      numbers.component_bytes_ = 1;
      break;
    case kShort:
    case kUnsignedShort:
      numbers.component_bytes_ = 2;
      break;
    default:
      return accessor.fail_here("componentType: expected 5126 (float) or normalized 5120 to 5123",
                                fault_);
  }
  return whole || accessor.fail_here("componentType: integers must be normalized", fault_);
}

bool GltfFile::numbers(const JsonValue& accessor, std::size_t width, GltfNumbers& numbers) {
  if (accessor.find("sparse")) {
    return accessor.fail_here("sparse accessors are not supported", fault_);
  }
  const std::optional<std::size_t> view = index(accessor, "bufferView", "bufferViews");
  std::size_t offset = 0, stride = 0;
  std::string_view bytes;
  if (!view || !count(accessor, "count", numbers.elements_) ||
      !count(accessor, "byteOffset", offset) || !component_type(accessor, numbers) ||
      !count(item("bufferViews", *view), "byteStride", stride) ||
      !view_bytes(item("bufferViews", *view), bytes)) {
    return false;
  }
  numbers.width_ = width;
  // Elements are aligned to the component size; only matrices have padding.
  const std::size_t element_bytes = numbers.component_bytes_ * width;
  numbers.stride_ = stride == 0 ? element_bytes : stride;
  const std::uint64_t needed =
      numbers.elements_ == 0
          ? 0
          : std::uint64_t{numbers.elements_ - 1} * numbers.stride_ + element_bytes;
  if (numbers.stride_ < element_bytes || offset + needed > bytes.size()) {
    return accessor.fail_here("accessor: exceeds its buffer", fault_);
  }
  numbers.bytes_ = bytes.substr(std::min(offset, bytes.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i])) {
      return accessor.fail_here("accessor: a value is not a finite number", fault_);
    }
  }
  return true;
}

bool GltfFile::view_bytes(const JsonValue& view, std::string_view& bytes) {
  const std::optional<JsonValue> extensions = view.find("extensions");
  for (const std::string_view name : kCompressions) {
    if (extensions && extensions->find(name)) {
      return view.fail_here("bufferView: compressed with " + std::string(name) +
                                ", which is not supported; export the animation without it",
                            fault_);
    }
  }
  const std::optional<std::size_t> buffer = index(view, "buffer", "buffers");
  std::size_t offset = 0, size = 0;
  if (!buffer || !count(view, "byteOffset", offset) || !count(view, "byteLength", size) ||
      !buffer_bytes(*buffer, bytes)) {
    return false;
  }
  if (std::uint64_t{offset} + size > bytes.size()) {
    return view.fail_here("accessor: exceeds its buffer", fault_);
  }
  bytes = bytes.substr(offset, size);
  return true;
}

bool GltfFile::buffer_bytes(std::size_t buffer, std::string_view& bytes) {
  const JsonValue& stated = item("buffers", buffer);
  const std::optional<JsonValue> uri = stated.find("uri");
  if (!uri) {
    bytes = buffer == 0 && chunk_ ? *chunk_ : std::string_view();
    return (buffer == 0 && chunk_) ||
           stated.fail_here("the buffer has no data in this file", fault_);
  }
  const auto [entry, is_new] = loaded_.try_emplace(buffer);
  if (is_new && !load(stated, *uri, entry->second)) {
    return false;
  }
  bytes = entry->second;
  return true;
}

bool GltfFile::load(const JsonValue& buffer, const JsonValue& uri, std::string& data) {
  constexpr std::string_view kBase64 = ";base64,";
  const std::string escaped = uri.plain_text() ? std::string() : uri.text();
  const std::string_view text = uri.plain_text().value_or(escaped);
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(kBase64);
    return (comma != text.npos && parse_base64(text.substr(comma + kBase64.size()), data)) ||
           uri.fail_here("uri: invalid base64", fault_);
  }
  std::size_t bytes = 0;
  if (!count(buffer, "byteLength", bytes)) {
    return false;
  }
  const std::string name = percent_decoded(text);
  std::string why = "no folder to search";
  return (options_.load_beside && options_.load_beside(name, bytes, data, why)) ||
         uri.fail_here("uri: " + quoted(name) + ": " + why, fault_);
}

}  // namespace mien::animation
