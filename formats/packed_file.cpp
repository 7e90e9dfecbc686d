// rANS decoder (Duda 2013) with static tables for the low and the high bytes of 16-bit numbers.
#include "formats/packed_file.h"

#include <algorithm>
#include <cstring>

#include "formats/little_endian.h"
#include "formats/mien_format.h"

namespace mien::formats {
namespace {

constexpr std::uint16_t kPackedMajor = 1;
constexpr std::uint16_t kPackedMinor = 0;
constexpr std::size_t kMajorAt = 8;
constexpr std::size_t kMinorAt = 10;
constexpr std::size_t kReservedAt = 12;
constexpr std::size_t kUnpackedBytesAt = 24;

constexpr std::size_t kSymbols = 256;
constexpr std::uint32_t kSlots = 4096;        // slots of a table
constexpr std::uint32_t kMinState = 0x10000;  // initial state of a coder
constexpr std::size_t kMaxBlockBytes = 65536;
constexpr std::size_t kMinPackedBlockBytes = 80;  // size field, minimal tables, and states

struct Table {
  std::uint8_t symbol[kSlots];
  std::uint16_t slots[kSymbols];
  std::uint16_t first[kSymbols];
};

class Unpacker {
 public:
  explicit Unpacker(std::span<const std::byte> blocks) : left_(blocks) {}

  [[nodiscard]] std::size_t left() const { return left_.size(); }  // unread bytes

  mien_status run(std::span<std::byte> file) {
    while (!file.empty()) {
      const auto bytes = take<std::uint32_t>();
      if (missing_) {
        return MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED;
      }
      if (bytes == 0 || bytes % kFileAlignment != 0 || bytes > kMaxBlockBytes ||
          bytes > file.size()) {
        return MIEN_ERROR_WEIGHTS_PACKED_BLOCK;
      }
      const mien_status status = block(file.first(bytes));
      if (status != MIEN_OK) {
        return status;
      }
      file = file.subspan(bytes);
    }
    return left_.empty() ? MIEN_OK : MIEN_ERROR_WEIGHTS_PACKED_TRAILING;
  }

 private:
  // Returns 0 and sets missing_ if no bytes are left.
  template <class Number>
  Number take() {
    if (left_.size() < sizeof(Number)) {
      missing_ = true;
      return 0;
    }
    const auto number = load_little<Number>(left_.data());
    left_ = left_.subspan(sizeof(Number));
    return number;
  }

  bool read(Table& table) {
    std::uint8_t present[kSymbols / 8];
    for (std::uint8_t& byte : present) {
      byte = take<std::uint8_t>();
    }
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < kSymbols; ++i) {
      if ((present[i / 8] >> i % 8 & 1) == 0) {
        continue;
      }
      const auto slots = take<std::uint16_t>();
      if (slots == 0 || slots > kSlots - next) {
        return false;
      }
      table.slots[i] = slots;
      table.first[i] = static_cast<std::uint16_t>(next);
      std::memset(table.symbol + next, static_cast<int>(i), slots);
      next += slots;
    }
    return next == kSlots;
  }

  // A state stays below 2^32, and between symbols in [kMinState, 2^32).
  std::byte next(const Table& table, std::uint32_t& state) {
    const std::uint32_t slot = state % kSlots;
    const std::uint8_t symbol = table.symbol[slot];
    state = table.slots[symbol] * (state / kSlots) + slot - table.first[symbol];
    if (state < kMinState) {
      state = state << 16 | take<std::uint16_t>();
    }
    return std::byte{symbol};
  }

  mien_status block(std::span<std::byte> out) {
    if (!read(low_) || !read(high_)) {
      return missing_ ? MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED : MIEN_ERROR_WEIGHTS_PACKED_TABLE;
    }
    auto low = take<std::uint32_t>();
    auto high = take<std::uint32_t>();
    if (missing_) {
      return MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED;
    }
    if (low < kMinState || high < kMinState) {
      return MIEN_ERROR_WEIGHTS_PACKED_STATE;
    }
    for (std::size_t i = 0; i < out.size(); i += 2) {
      out[i] = next(low_, low);
      out[i + 1] = next(high_, high);
    }
    if (missing_) {
      return MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED;
    }
    return low == kMinState && high == kMinState ? MIEN_OK : MIEN_ERROR_WEIGHTS_PACKED_STATE;
  }

  std::span<const std::byte> left_;  // unread bytes
  bool missing_ = false;             // a read exceeded the data
  Table low_, high_;
};

}  // namespace

mien_status unpacked_bytes(std::span<const std::byte> packed, std::size_t& bytes,
                           mien_error_detail& error) {
  const std::byte* header = packed.data();
  const auto fail = [&](mien_status status, const char* field, std::size_t at) {
    describe(error, status, field);
    set_offset(error, at);
    return status;
  };
  if (packed.size() < kPackedHeaderBytes) {
    return fail(MIEN_ERROR_WEIGHTS_TRUNCATED, "file", packed.size());
  }
  if (std::memcmp(header, kPackedMagic, sizeof kPackedMagic) != 0) {
    return fail(MIEN_ERROR_WEIGHTS_NOT_MIEN, "magic", 0);
  }
  if (load_little<std::uint16_t>(header + kMajorAt) != kPackedMajor ||
      load_little<std::uint16_t>(header + kMinorAt) != kPackedMinor) {
    return fail(MIEN_ERROR_WEIGHTS_VERSION, "major_version", kMajorAt);
  }
  if (load_little<std::uint32_t>(header + kReservedAt) != 0) {
    return fail(MIEN_ERROR_WEIGHTS_RESERVED, "reserved", kReservedAt);
  }
  const auto size = load_little<std::uint64_t>(header + kPackedBytesAt);
  if (size != packed.size()) {
    const bool truncated = size > packed.size();
    const auto end = static_cast<std::size_t>(truncated ? packed.size() : size);
    const auto got = static_cast<double>(packed.size()), expected = static_cast<double>(size);
    (void)fail(truncated ? MIEN_ERROR_WEIGHTS_TRUNCATED : MIEN_ERROR_WEIGHTS_TRAILING_BYTES, "file",
               end);
    set_got(error, got);
    set_expected(error, expected, expected);
    return static_cast<mien_status>(error.status);
  }
  const auto unpacked = load_little<std::uint64_t>(header + kUnpackedBytesAt);
  // Limits the memory of the caller to the maximum content of the file's blocks.
  const std::uint64_t blocks = (size - kPackedHeaderBytes) / kMinPackedBlockBytes;
  const std::uint64_t max_unpacked = std::min(kMaxFileBytes, blocks * kMaxBlockBytes);
  if (unpacked == 0 || unpacked % kFileAlignment != 0 || unpacked > max_unpacked) {
    (void)fail(MIEN_ERROR_WEIGHTS_PACKED_SIZE, "unpacked_bytes", kUnpackedBytesAt);
    set_got(error, static_cast<double>(unpacked));
    set_expected(error, kFileAlignment, static_cast<double>(max_unpacked));
    return MIEN_ERROR_WEIGHTS_PACKED_SIZE;
  }
  bytes = static_cast<std::size_t>(unpacked);
  return MIEN_OK;
}

mien_status unpack(std::span<const std::byte> packed, std::span<std::byte> file,
                   mien_error_detail& error) {
  std::size_t bytes = 0;
  mien_status status = unpacked_bytes(packed, bytes, error);
  if (status != MIEN_OK) {
    return status;
  }
  if (bytes != file.size()) {
    return describe(error, MIEN_ERROR_MEMORY_TOO_SMALL);
  }
  Unpacker unpacker(packed.subspan(kPackedHeaderBytes));
  status = unpacker.run(file);
  if (status != MIEN_OK) {
    std::fill(file.begin(), file.end(), std::byte{0});
    describe(error, status, "block");
    set_offset(error, packed.size() - unpacker.left());
  }
  return status;
}

}  // namespace mien::formats
