// Buffers that end or begin at a page nobody may touch: a kernel that strays by one byte dies.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace mien::tests {

enum class Edge { kEnd, kStart };  // which end of the buffer lies at the guard page

// The bytes between the buffer and the far guard page hold this; `intact` checks that they still
// do.
inline constexpr unsigned char kCanary = 0xAA;

class GuardedBytes {
 public:
  GuardedBytes(std::size_t bytes, Edge edge) : bytes_(bytes) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    inner_bytes_ = (bytes + page - 1) / page * page + page;
    mapped_bytes_ = inner_bytes_ + 2 * page;
    mapping_ = static_cast<unsigned char*>(
        mmap(nullptr, mapped_bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    inner_ = mapping_ + page;
    mprotect(inner_, inner_bytes_, PROT_READ | PROT_WRITE);
    std::memset(inner_, kCanary, inner_bytes_);
    data_ = edge == Edge::kEnd ? inner_ + inner_bytes_ - bytes : inner_;
  }
  ~GuardedBytes() { munmap(mapping_, mapped_bytes_); }
  GuardedBytes(const GuardedBytes&) = delete;
  GuardedBytes& operator=(const GuardedBytes&) = delete;

  unsigned char* data() const { return data_; }
  bool intact() const {
    for (const unsigned char* at = inner_; at != inner_ + inner_bytes_; ++at) {
      if ((at < data_ || at >= data_ + bytes_) && *at != kCanary) {
        return false;
      }
    }
    return true;
  }

 private:
  std::size_t bytes_, inner_bytes_, mapped_bytes_;
  unsigned char *mapping_, *inner_, *data_;
};

template <class T>
class Guarded {
 public:
  Guarded(const std::vector<T>& values, Edge edge)
      : bytes_(values.size() * sizeof(T), edge), count_(values.size()) {
    if (!values.empty()) {
      std::memcpy(bytes_.data(), values.data(), values.size() * sizeof(T));
    }
  }
  T* data() const { return reinterpret_cast<T*>(bytes_.data()); }
  std::span<T> span() const { return {data(), count_}; }
  bool intact() const { return bytes_.intact(); }

 private:
  GuardedBytes bytes_;
  std::size_t count_;
};

}  // namespace mien::tests
