// Computes SHA-1.
#include "apps/protocols/sha1.h"

#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>

#include "apps/protocols/bytes.h"

namespace mien::protocols {
namespace {

constexpr std::size_t kBlockBytes = 64, kLengthBytes = 8;
constexpr std::size_t kRounds = 80;
using State = std::array<std::uint32_t, 5>;

// The sum modulo 2^32.
std::uint32_t sum(std::initializer_list<std::uint32_t> numbers) {
  std::uint64_t total = 0;
  for (const std::uint32_t number : numbers) {
    total += number;
  }
  return static_cast<std::uint32_t>(total & 0xffffffffU);
}

std::uint32_t mixed(std::size_t round, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return round < 20   ? sum({(b & c) | (~b & d), 0x5a827999U})
         : round < 40 ? sum({b ^ c ^ d, 0x6ed9eba1U})
         : round < 60 ? sum({(b & c) | (b & d) | (c & d), 0x8f1bbcdcU})
                      : sum({b ^ c ^ d, 0xca62c1d6U});
}

void add_block(std::string_view block, State& state) {
  std::array<std::uint32_t, kRounds> words{};
  for (std::size_t i = 0; i < kBlockBytes; ++i) {
    words[i / 4] = words[i / 4] << 8 | static_cast<std::uint8_t>(block[i]);
  }
  for (std::size_t i = 16; i < kRounds; ++i) {
    words[i] = std::rotl(words[i - 3] ^ words[i - 8] ^ words[i - 14] ^ words[i - 16], 1);
  }
  auto [a, b, c, d, e] = state;
  for (std::size_t i = 0; i < kRounds; ++i) {
    const std::uint32_t next = sum({std::rotl(a, 5), mixed(i, b, c, d), e, words[i]});
    e = d;
    d = c;
    c = std::rotl(b, 30);
    b = a;
    a = next;
  }
  state = {sum({state[0], a}), sum({state[1], b}), sum({state[2], c}), sum({state[3], d}),
           sum({state[4], e})};
}

}  // namespace

std::string sha1(std::string_view bytes) {
  std::string padded = std::string(bytes) + '\x80';
  while (padded.size() % kBlockBytes != kBlockBytes - kLengthBytes) {
    padded += '\0';
  }
  append_big(padded, std::uint64_t{bytes.size()} * 8);
  State state = {0x67452301U, 0xefcdab89U, 0x98badcfeU, 0x10325476U, 0xc3d2e1f0U};
  for (std::size_t at = 0; at < padded.size(); at += kBlockBytes) {
    add_block(std::string_view(padded).substr(at, kBlockBytes), state);
  }
  std::string digest;
  for (const std::uint32_t word : state) {
    append_big(digest, word);
  }
  return digest;
}

}  // namespace mien::protocols
