// Deflates and encodes data for pages.
#include "apps/mien/pages/packed_text.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

#include "apps/animation/base64.h"

namespace mien::app {

struct PackedText::Stream {
  z_stream z = {};

  Stream() {
    if (deflateInit(&z, Z_DEFAULT_COMPRESSION) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~Stream() { deflateEnd(&z); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};

PackedText::PackedText() : stream_(std::make_unique<Stream>()) {}
PackedText::~PackedText() = default;
PackedText::PackedText(PackedText&&) noexcept = default;
PackedText& PackedText::operator=(PackedText&&) noexcept = default;

void PackedText::deflate_all(int flush) {
  std::array<char, 1 << 14> buffer = {};
  z_stream& z = stream_->z;
  do {
    z.next_out = reinterpret_cast<Bytef*>(buffer.data());
    z.avail_out = static_cast<uInt>(buffer.size());
    deflate(&z, flush);
    packed_.append(buffer.data(), buffer.size() - z.avail_out);
  } while (z.avail_out == 0);
}

void PackedText::write(std::string_view bytes) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;  // limit of one zlib call
  bytes_ += bytes.size();
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, std::min(bytes.size(), kMaxBytes));
    stream_->z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
    stream_->z.avail_in = static_cast<uInt>(part.size());
    deflate_all(Z_NO_FLUSH);
    bytes.remove_prefix(part.size());
  }
}

std::string PackedText::finish() {
  stream_->z.avail_in = 0;
  deflate_all(Z_FINISH);
  return animation::base64(packed_);
}

}  // namespace mien::app
