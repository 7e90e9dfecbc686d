// A glTF file: its document and the numbers in its buffers. cgltf reports no line and column of an
// error, and its memory is not bounded by the size of the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/animation/fault.h"
#include "apps/animation/json.h"
#include "apps/animation/read_options.h"

namespace mien::animation {

// The numbers of an accessor, read one by one: floats, or integers that represent -1..1 or 0..1.
class GltfNumbers {
 public:
  [[nodiscard]] std::size_t size() const { return elements_ * width_; }
  // A float with the fewest digits that identify it, as in text files.
  [[nodiscard]] float operator[](std::size_t i) const;

 private:
  friend class GltfFile;

  std::string_view bytes_;  // from the first element on
  std::size_t elements_ = 0, width_ = 1, stride_ = 0, component_bytes_ = 4;
  std::int64_t type_ = 0;
};

class GltfFile {
 public:
  // Both arguments and `bytes` must outlive this object.
  GltfFile(const ReadOptions& options, Fault& fault) : options_(options), fault_(fault) {}

  // Reads a .glb, or the JSON of a .gltf.
  [[nodiscard]] bool read(std::string_view bytes);

  [[nodiscard]] JsonValue root() const { return document_.root(); }

  // The index in the document's list `of` that the member `key` of `from` contains.
  [[nodiscard]] std::optional<std::size_t> index(const JsonValue& from, std::string_view key,
                                                 std::string_view of);
  [[nodiscard]] const JsonValue& item(std::string_view of, std::size_t i) const {
    return list(of)[i];
  }

  // The numbers of an accessor with `width` components per element.
  [[nodiscard]] bool numbers(const JsonValue& accessor, std::size_t width, GltfNumbers& numbers);

 private:
  using Items = std::vector<JsonValue>;

  void find_lists();
  [[nodiscard]] const Items& list(std::string_view of) const;
  [[nodiscard]] bool count(const JsonValue& from, std::string_view key, std::size_t& value);
  [[nodiscard]] bool component_type(const JsonValue& accessor, GltfNumbers& numbers);
  [[nodiscard]] bool view_bytes(const JsonValue& view, std::string_view& bytes);
  [[nodiscard]] bool buffer_bytes(std::size_t buffer, std::string_view& bytes);
  [[nodiscard]] bool load(const JsonValue& buffer, const JsonValue& uri, std::string& data);

  const ReadOptions& options_;
  Fault& fault_;
  JsonDocument document_;
  std::optional<std::string_view> chunk_;  // of a .glb
  std::map<std::string, Items, std::less<>> lists_;
  // Loaded on demand; unused buffers are never loaded.
  std::map<std::size_t, std::string> loaded_;
};

}  // namespace mien::animation
