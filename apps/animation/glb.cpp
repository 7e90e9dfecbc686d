// Reads and writes the container of binary glTF.
#include "apps/animation/glb.h"

namespace mien::animation {
namespace {

constexpr std::uint32_t kVersion = 2, kJson = 0x4E4F534A, kBinary = 0x004E4942;

bool fail_at_byte(std::size_t byte, const char* what, Fault& fault) {
  return fail(fault, 0, byte, what);
}

void pad(std::string& text, char with) { text.append((4 - text.size() % 4) % 4, with); }

void append_chunk(std::string& file, std::uint32_t type, const std::string& content) {
  put_u32(file, static_cast<std::uint32_t>(content.size()));
  put_u32(file, type);
  file += content;
}

}  // namespace

bool split_glb(std::string_view bytes, GlbChunks& chunks, Fault& fault) {
  if (bytes.size() < 20) {
    return fail_at_byte(bytes.size(), "the file ends within its header", fault);
  }
  if (little_endian(bytes, 4) != kVersion) {
    return fail_at_byte(4, "expected glTF version 2", fault);
  }
  if (little_endian(bytes, 8) != bytes.size()) {
    return fail_at_byte(8, "wrong file length", fault);
  }
  if (little_endian(bytes, 16) != kJson) {
    return fail_at_byte(16, "the first chunk is not JSON", fault);
  }
  const std::size_t json_bytes = little_endian(bytes, 12);
  if (json_bytes > bytes.size() - 20) {
    return fail_at_byte(12, "the chunk exceeds the file", fault);
  }
  chunks = {bytes.substr(20, json_bytes), std::nullopt};
  const std::size_t next = 20 + json_bytes;
  if (bytes.size() - next < 8 || little_endian(bytes, next + 4) != kBinary) {
    return true;
  }
  if (little_endian(bytes, next) > bytes.size() - next - 8) {
    return fail_at_byte(next, "the chunk exceeds the file", fault);
  }
  chunks.data = bytes.substr(next + 8, little_endian(bytes, next));
  return true;
}

std::string glb_file(std::string json, std::string data) {
  pad(json, ' ');
  pad(data, '\0');
  std::string file(kGlbMagic);
  put_u32(file, kVersion);
  put_u32(file, static_cast<std::uint32_t>(kGlbHeaders + json.size() + data.size()));
  append_chunk(file, kJson, json);
  append_chunk(file, kBinary, data);
  return file;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return value;
}

void put_u32(std::string& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) {
    bytes += static_cast<char>(value >> (8 * i) & 255);
  }
}

}  // namespace mien::animation
