// XXH64 in one pass.
#include "formats/xxhash64.h"

#include <bit>
#include <cstring>

namespace mien::formats {
namespace {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87u;
constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4Fu;
constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9u;
constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63u;
constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5u;

template <class Word>
Word load(const std::byte* at) {
  Word word;
  std::memcpy(&word, at, sizeof word);
  return word;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t input) {
  return std::rotl(lane + input * kPrime2, 31) * kPrime1;
}

std::uint64_t merge(std::uint64_t hash, std::uint64_t lane) {
  return (hash ^ round(0, lane)) * kPrime1 + kPrime4;
}

struct Lanes {
  std::uint64_t lane[4] = {kPrime1 + kPrime2, kPrime2, 0, 0 - kPrime1};

  void stripe(const std::byte* at) {
    for (std::size_t i = 0; i < 4; ++i) {
      lane[i] = round(lane[i], load<std::uint64_t>(at + 8 * i));
    }
  }
  [[nodiscard]] std::uint64_t converged() const {
    std::uint64_t hash = std::rotl(lane[0], 1) + std::rotl(lane[1], 7) + std::rotl(lane[2], 12) +
                         std::rotl(lane[3], 18);
    for (const std::uint64_t one : lane) {
      hash = merge(hash, one);
    }
    return hash;
  }
};

std::uint64_t avalanche(std::uint64_t hash) {
  hash = (hash ^ (hash >> 33)) * kPrime2;
  hash = (hash ^ (hash >> 29)) * kPrime3;
  return hash ^ (hash >> 32);
}

std::uint64_t tail(std::uint64_t hash, std::span<const std::byte> rest) {
  for (; rest.size() >= 8; rest = rest.subspan(8)) {
    hash = std::rotl(hash ^ round(0, load<std::uint64_t>(rest.data())), 27) * kPrime1 + kPrime4;
  }
  if (rest.size() >= 4) {
    hash = std::rotl(hash ^ (load<std::uint32_t>(rest.data()) * kPrime1), 23) * kPrime2 + kPrime3;
    rest = rest.subspan(4);
  }
  for (const std::byte one : rest) {
    hash = std::rotl(hash ^ (std::to_integer<std::uint64_t>(one) * kPrime5), 11) * kPrime1;
  }
  return avalanche(hash);
}

}  // namespace

std::uint64_t xxhash64_with_hole(std::span<const std::byte> bytes, std::size_t hole) {
  constexpr std::size_t kStripe = 32;
  Lanes lanes;
  std::size_t at = 0;
  for (; at + kStripe <= bytes.size(); at += kStripe) {
    if (hole >= at && hole < at + kStripe) {
      std::byte copy[kStripe];
      std::memcpy(copy, bytes.data() + at, kStripe);
      std::memset(copy + (hole - at), 0, 8);
      lanes.stripe(copy);
    } else {
      lanes.stripe(bytes.data() + at);
    }
  }
  const std::uint64_t hash = bytes.size() >= kStripe ? lanes.converged() : kPrime5;
  return tail(hash + bytes.size(), bytes.subspan(at));
}

}  // namespace mien::formats
