// Parses .npy headers and writes one.
#include "formats/npy.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

#include "formats/checked.h"

namespace mien::formats {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kPreambleBytes = 8;  // magic and version

// Parses the header: a Python dictionary with three keys in any order.
class Dictionary {
 public:
  explicit Dictionary(std::string_view text) : left_(text) {}

  NpyStatus read(NpyArray* array) {
    if (!take('{')) {
      return NpyStatus::kBadHeader;
    }
    while (!take('}')) {
      const NpyStatus status = entry(array);
      if (status != NpyStatus::kOk) {
        return status;
      }
      if (!take(',') && !next_is('}')) {
        return NpyStatus::kBadHeader;
      }
    }
    skip_space();
    return left_.empty() && descr_ && order_ && shape_ ? NpyStatus::kOk : NpyStatus::kBadHeader;
  }

 private:
  NpyStatus entry(NpyArray* array) {
    const std::string_view key = quoted();
    if (!take(':')) {
      return NpyStatus::kBadHeader;
    }
    if (key == "descr" && !descr_) {
      descr_ = true;
      return type(array);
    }
    if (key == "fortran_order" && !order_) {
      order_ = true;
      return order();
    }
    if (key == "shape" && !shape_) {
      shape_ = true;
      return shape(array);
    }
    return NpyStatus::kBadHeader;
  }

  NpyStatus type(NpyArray* array) {
    const std::string_view name = quoted();
    array->type = name == "<f8" ? NpyType::kFloat64 : NpyType::kFloat32;
    return name == "<f4" || name == "<f8" ? NpyStatus::kOk : NpyStatus::kUnsupportedType;
  }

  NpyStatus order() {
    if (take_word("True")) {
      return NpyStatus::kFortranOrder;
    }
    return take_word("False") ? NpyStatus::kOk : NpyStatus::kBadHeader;
  }

  NpyStatus shape(NpyArray* array) {
    if (!take('(')) {
      return NpyStatus::kBadHeader;
    }
    while (!take(')')) {
      if (array->rank == kMaxNpyRank) {
        return NpyStatus::kBadShape;
      }
      if (!number(&array->dims[array->rank++])) {
        return NpyStatus::kBadHeader;
      }
      // Python writes a tuple of one element with a comma.
      if (!take(',') && (!next_is(')') || array->rank == 1)) {
        return NpyStatus::kBadHeader;
      }
    }
    return NpyStatus::kOk;
  }

  bool number(std::uint64_t* value) {
    skip_space();
    const auto [end, error] = std::from_chars(left_.data(), left_.data() + left_.size(), *value);
    left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
    return error == std::errc();
  }

  // The text between quotes; empty without quotes.
  std::string_view quoted() {
    skip_space();
    if (left_.empty() || (left_[0] != '\'' && left_[0] != '"')) {
      return {};
    }
    const std::size_t end = left_.find(left_[0], 1);
    if (end == std::string_view::npos) {
      return {};
    }
    const std::string_view text = left_.substr(1, end - 1);
    left_.remove_prefix(end + 1);
    return text;
  }

  bool take_word(std::string_view word) {
    skip_space();
    const bool found = left_.starts_with(word);
    left_.remove_prefix(found ? word.size() : 0);
    return found;
  }
  bool take(char c) { return take_word({&c, 1}); }
  bool next_is(char c) {
    skip_space();
    return !left_.empty() && left_[0] == c;
  }
  void skip_space() {
    while (!left_.empty() && (left_[0] == ' ' || left_[0] == '\n')) {
      left_.remove_prefix(1);
    }
  }

  std::string_view left_;
  bool descr_ = false, order_ = false, shape_ = false;
};

// Splits the file after its preamble: version 1 has a length of 2 bytes, later versions of 4.
NpyStatus split(std::span<const std::byte> file, std::string_view* header,
                std::span<const std::byte>* data) {
  const std::size_t length_bytes = std::to_integer<int>(file[6]) == 1 ? 2 : 4;
  if (file.size() < kPreambleBytes + length_bytes) {
    return NpyStatus::kTruncated;
  }
  std::uint64_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i) {
    length |= std::to_integer<std::uint64_t>(file[kPreambleBytes + i]) << (8 * i);
  }
  const std::span<const std::byte> rest = file.subspan(kPreambleBytes + length_bytes);
  if (rest.size() < length) {
    return NpyStatus::kTruncated;
  }
  const auto header_bytes = static_cast<std::size_t>(length);
  *header = {reinterpret_cast<const char*>(rest.data()), header_bytes};
  *data = rest.subspan(header_bytes);
  return NpyStatus::kOk;
}

std::size_t element_bytes(NpyType type) { return type == NpyType::kFloat64 ? 8 : 4; }

NpyStatus fit(std::span<const std::byte> data, NpyArray* array) {
  Checked elems = 1;
  for (const std::uint64_t dim : array->shape()) {
    elems = elems * dim;
  }
  if (elems.value() > kMaxNpyElems) {
    return NpyStatus::kBadShape;
  }
  const std::uint64_t bytes = elems.value() * element_bytes(array->type);
  if (data.size() != bytes) {
    return data.size() < bytes ? NpyStatus::kTruncated : NpyStatus::kTrailingBytes;
  }
  array->data = data;
  return NpyStatus::kOk;
}

NpyStatus read(std::span<const std::byte> file, NpyArray* array) {
  if (file.size() < kPreambleBytes || std::memcmp(file.data(), kMagic.data(), kMagic.size()) != 0) {
    return NpyStatus::kBadSignature;
  }
  const auto major = std::to_integer<int>(file[6]), minor = std::to_integer<int>(file[7]);
  if (major < 1 || major > 3 || minor != 0) {
    return NpyStatus::kUnsupportedVersion;
  }
  std::string_view header;
  std::span<const std::byte> data;
  NpyStatus status = split(file, &header, &data);
  if (status == NpyStatus::kOk) {
    status = Dictionary(header).read(array);
  }
  return status == NpyStatus::kOk ? fit(data, array) : status;
}

template <class Number>
float number_at(const std::byte* at) {
  Number number;
  std::memcpy(&number, at, sizeof number);
  return static_cast<float>(number);
}

}  // namespace

const char* message(NpyStatus status) {
  switch (status) {
    case NpyStatus::kOk:
      return "ok";
    case NpyStatus::kBadSignature:
      return "not a .npy file";
    case NpyStatus::kUnsupportedVersion:
      return "version: unsupported (expected 1.0, 2.0 or 3.0)";
    case NpyStatus::kBadHeader:
      return "header: malformed";
    case NpyStatus::kUnsupportedType:
      return "descr: unsupported element type (expected little-endian float32 or float64)";
    case NpyStatus::kFortranOrder:
      return "fortran_order: unsupported (expected C order, see numpy.ascontiguousarray)";
    case NpyStatus::kBadShape:
      return "shape: more than 8 dimensions or 2^32 elements";
    case NpyStatus::kTruncated:
      return "truncated inside the array";
    case NpyStatus::kTrailingBytes:
      return "trailing bytes after the array";
  }
  return "unknown status";
}

std::uint64_t NpyArray::elems() const { return data.size() / element_bytes(type); }

float NpyArray::value(std::uint64_t i) const {
  const std::byte* at = data.data() + static_cast<std::size_t>(i) * element_bytes(type);
  return type == NpyType::kFloat64 ? number_at<double>(at) : number_at<float>(at);
}

NpyStatus read_npy(std::span<const std::byte> file, NpyArray* array) {
  *array = {};
  const NpyStatus status = read(file, array);
  if (status != NpyStatus::kOk) {
    *array = {};
  }
  return status;
}

NpyHeader npy_header(std::span<const std::uint64_t> shape) {
  NpyHeader header;
  std::memset(header.bytes, ' ', sizeof header.bytes);
  header.bytes[sizeof header.bytes - 1] = '\n';
  char* at = header.bytes;
  const auto put = [&at](std::string_view text) { at = std::copy(text.begin(), text.end(), at); };
  put(kMagic);
  constexpr std::size_t kLength = kNpyHeaderBytes - kPreambleBytes - 2;
  const char rest[] = {1, 0, static_cast<char>(kLength & 0xFF), static_cast<char>(kLength >> 8)};
  put({rest, sizeof rest});
  put("{'descr': '<f4', 'fortran_order': False, 'shape': (");
  for (const std::uint64_t dim : shape) {
    at = std::to_chars(at, at + 20, dim).ptr;
    put(", ");
  }
  put(")}");
  return header;
}

}  // namespace mien::formats
