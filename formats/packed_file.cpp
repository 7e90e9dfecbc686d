// rANS decoder (Duda 2013) with static tables for the low and the high bytes of 16-bit numbers.
#include "formats/packed_file.h"

#include <algorithm>
#include <cstring>

#include "formats/little_endian.h"
#include "formats/mien_format.h"

namespace mien::formats {
namespace {

constexpr std::uint8_t kPackedMagic[8] = {0x89, 'M', 'I', 'E', 'P', 0x0D, 0x0A, 0x1A};
constexpr std::uint16_t kPackedMajor = 1;
constexpr std::uint16_t kPackedMinor = 0;
constexpr std::size_t kMajorAt = 8;
constexpr std::size_t kMinorAt = 10;
constexpr std::size_t kReservedAt = 12;
constexpr std::size_t kPackedBytesAt = 16;
constexpr std::size_t kUnpackedBytesAt = 24;
constexpr std::size_t kHeaderBytes = 32;

constexpr std::size_t kSymbols = 256;
constexpr std::uint32_t kSlots = 4096;      // slots of a table
constexpr std::uint32_t kLowest = 0x10000;  // initial state of a coder
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

  PackedStatus run(std::span<std::byte> file) {
    while (!file.empty()) {
      const auto bytes = take<std::uint32_t>();
      if (missing_) {
        return PackedStatus::kBytesMissing;
      }
      if (bytes == 0 || bytes % kFileAlignment != 0 || bytes > kMaxBlockBytes ||
          bytes > file.size()) {
        return PackedStatus::kBadBlock;
      }
      const PackedStatus status = block(file.first(bytes));
      if (status != PackedStatus::kOk) {
        return status;
      }
      file = file.subspan(bytes);
    }
    return left_.empty() ? PackedStatus::kOk : PackedStatus::kBytesLeft;
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

  // A state stays below 2^32, and between symbols in [kLowest, 2^32).
  std::byte next(const Table& table, std::uint32_t& state) {
    const std::uint32_t slot = state % kSlots;
    const std::uint8_t symbol = table.symbol[slot];
    state = table.slots[symbol] * (state / kSlots) + slot - table.first[symbol];
    if (state < kLowest) {
      state = state << 16 | take<std::uint16_t>();
    }
    return std::byte{symbol};
  }

  PackedStatus block(std::span<std::byte> out) {
    if (!read(low_) || !read(high_)) {
      return missing_ ? PackedStatus::kBytesMissing : PackedStatus::kBadTable;
    }
    auto low = take<std::uint32_t>();
    auto high = take<std::uint32_t>();
    if (missing_) {
      return PackedStatus::kBytesMissing;
    }
    if (low < kLowest || high < kLowest) {
      return PackedStatus::kBadState;
    }
    for (std::size_t i = 0; i < out.size(); i += 2) {
      out[i] = next(low_, low);
      out[i + 1] = next(high_, high);
    }
    if (missing_) {
      return PackedStatus::kBytesMissing;
    }
    return low == kLowest && high == kLowest ? PackedStatus::kOk : PackedStatus::kBadState;
  }

  std::span<const std::byte> left_;  // unread bytes
  bool missing_ = false;             // a read exceeded the data
  Table low_, high_;
};

}  // namespace

PackedStatus unpacked_bytes(std::span<const std::byte> packed, std::size_t& bytes) {
  if (packed.size() < kHeaderBytes) {
    return PackedStatus::kTruncated;
  }
  if (std::memcmp(packed.data(), kPackedMagic, sizeof kPackedMagic) != 0) {
    return PackedStatus::kNotPacked;
  }
  if (load_little<std::uint16_t>(packed.data() + kMajorAt) != kPackedMajor ||
      load_little<std::uint16_t>(packed.data() + kMinorAt) != kPackedMinor) {
    return PackedStatus::kUnsupportedVersion;
  }
  if (load_little<std::uint32_t>(packed.data() + kReservedAt) != 0) {
    return PackedStatus::kReservedNotZero;
  }
  const auto size = load_little<std::uint64_t>(packed.data() + kPackedBytesAt);
  if (size != packed.size()) {
    return size > packed.size() ? PackedStatus::kTruncated : PackedStatus::kTrailingBytes;
  }
  const auto unpacked = load_little<std::uint64_t>(packed.data() + kUnpackedBytesAt);
  // Bounds the memory of the caller by what the file's blocks can fill.
  const std::uint64_t blocks = (size - kHeaderBytes) / kMinPackedBlockBytes;
  if (unpacked == 0 || unpacked % kFileAlignment != 0 || unpacked > kMaxFileBytes ||
      unpacked > blocks * kMaxBlockBytes) {
    return PackedStatus::kBadSize;
  }
  bytes = static_cast<std::size_t>(unpacked);
  return PackedStatus::kOk;
}

PackedStatus unpack(std::span<const std::byte> packed, std::span<std::byte> file) {
  std::size_t bytes = 0;
  PackedStatus status = unpacked_bytes(packed, bytes);
  if (status != PackedStatus::kOk) {
    return status;
  }
  if (bytes != file.size()) {
    return PackedStatus::kWrongSize;
  }
  status = Unpacker(packed.subspan(kHeaderBytes)).run(file);
  if (status != PackedStatus::kOk) {
    std::fill(file.begin(), file.end(), std::byte{0});
  }
  return status;
}

}  // namespace mien::formats
