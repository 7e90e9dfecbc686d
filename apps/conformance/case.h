// A test case of a kernel: its buffers, how they become arguments, and the expected results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "apps/conformance/approx.h"
#include "apps/conformance/random_values.h"
#include "kernels/families.h"
#include "kernels/registry.h"

namespace mien::conformance {

enum class Element : std::uint8_t { kByte, kInt8, kHalf, kInt16, kFloat, kInt64 };
[[nodiscard]] std::size_t element_bytes(Element element);

enum class Role : std::uint8_t {
  kRead,     // must not change
  kWritten,  // initially NaN: the kernel must write every element and read none
  kUpdated,  // read and written: state, or an in-place kernel
  kScratch,  // initially NaN; any content afterwards
};

struct Buffer {
  Element element;
  Role role;
  std::vector<std::byte> content;  // initial content
  std::vector<Approx> expected;    // for kWritten and kUpdated, one per element
};

[[nodiscard]] Buffer reads(const std::vector<float>& values);
[[nodiscard]] Buffer reads(const std::vector<std::uint16_t>& halves);
[[nodiscard]] Buffer reads(const std::vector<std::uint8_t>& bytes);
[[nodiscard]] Buffer writes(Element element, std::vector<Approx> expected);
[[nodiscard]] Buffer updates(const std::vector<float>& values, std::vector<Approx> expected);
[[nodiscard]] Buffer scratch(std::size_t floats);

// An argument struct of any family.
struct Arguments {
  alignas(16) std::byte bytes[384];
};

template <class Args>
[[nodiscard]] Arguments arguments(const Args& args) {
  static_assert(sizeof args <= sizeof Arguments::bytes && std::is_trivially_copyable_v<Args>);
  Arguments packed{};
  std::memcpy(packed.bytes, &args, sizeof args);
  return packed;
}

template <class Args>
void call(kernels::AnyKernel kernel, const Arguments& packed) {
  reinterpret_cast<kernels::Kernel<Args>>(kernel)(*reinterpret_cast<const Args*>(packed.bytes));
}

// The addresses of a case's buffers during a call.
class Addresses {
 public:
  void add(std::byte* at) { addresses_.push_back(at); }
  [[nodiscard]] float* floats(std::size_t i) const {
    return reinterpret_cast<float*>(addresses_[i]);
  }
  [[nodiscard]] std::uint16_t* halves(std::size_t i) const {
    return reinterpret_cast<std::uint16_t*>(addresses_[i]);
  }
  [[nodiscard]] std::uint8_t* bytes(std::size_t i) const {
    return reinterpret_cast<std::uint8_t*>(addresses_[i]);
  }
  [[nodiscard]] std::int8_t* int8s(std::size_t i) const {
    return reinterpret_cast<std::int8_t*>(addresses_[i]);
  }
  [[nodiscard]] std::int16_t* int16s(std::size_t i) const {
    return reinterpret_cast<std::int16_t*>(addresses_[i]);
  }
  [[nodiscard]] std::int64_t* int64s(std::size_t i) const {
    return reinterpret_cast<std::int64_t*>(addresses_[i]);
  }

 private:
  std::vector<std::byte*> addresses_;
};

struct Case {
  std::string shape;  // description: "5x7x24 to 40, relu6"
  std::vector<Buffer> buffers;
  std::function<Arguments(const Addresses&)> bind;
  void (*call)(kernels::AnyKernel, const Arguments&);
  std::uint64_t macs = 0;  // multiply-accumulates; 0 if the kernel has none
};

// A random case of the family with these arguments, and one of the size that is most frequent in
// networks, which is timed. families/ defines both for every family; a family of
// kernels/kernels.inc without them does not link.
template <class Args>
[[nodiscard]] Case random_case(RandomValues& random);
template <class Args>
[[nodiscard]] Case typical_case(RandomValues& random);

#define MIEN_KERNEL(family, Args, tier)                         \
  template <>                                                   \
  [[nodiscard]] Case random_case<kernels::Args>(RandomValues&); \
  template <>                                                   \
  [[nodiscard]] Case typical_case<kernels::Args>(RandomValues&);
#include "kernels/kernels.inc"
#undef MIEN_KERNEL

struct Family {
  std::string_view name;
  Case (*random_case)(RandomValues&);
  Case (*typical_case)(RandomValues&);
};

// nullptr if kernels/kernels.inc has no reference kernel with that name.
[[nodiscard]] const Family* find_family(std::string_view name);

}  // namespace mien::conformance
