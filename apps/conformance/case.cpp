// Buffers of cases and the table of families.
#include "apps/conformance/case.h"

#include <algorithm>
#include <utility>

namespace mien::conformance {
namespace {

constexpr std::byte kPartOfNan{0xFF};

template <class T>
std::vector<std::byte> bytes_of(const std::vector<T>& values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) {
    std::memcpy(bytes.data(), values.data(), bytes.size());
  }
  return bytes;
}

constexpr Family kFamilies[] = {
#define MIEN_KERNEL(family, Args, tier) \
  {kernels::Args::kFamily, random_case<kernels::Args>, typical_case<kernels::Args>},
#include "kernels/kernels.inc"
#undef MIEN_KERNEL
};

}  // namespace

std::size_t element_bytes(Element element) {
  switch (element) {
    case Element::kByte:
    case Element::kInt8:
      return 1;
    case Element::kHalf:
    case Element::kInt16:
      return 2;
    case Element::kFloat:
      return 4;
    case Element::kInt64:
      return 8;
  }
  return 1;
}

Buffer reads(const std::vector<float>& values) {
  return {Element::kFloat, Role::kRead, bytes_of(values), {}};
}

Buffer reads(const std::vector<std::uint16_t>& halves) {
  return {Element::kHalf, Role::kRead, bytes_of(halves), {}};
}

Buffer reads(const std::vector<std::uint8_t>& bytes) {
  return {Element::kByte, Role::kRead, bytes_of(bytes), {}};
}

Buffer writes(Element element, std::vector<Approx> expected) {
  std::vector<std::byte> nans(expected.size() * element_bytes(element), kPartOfNan);
  return {element, Role::kWritten, std::move(nans), std::move(expected)};
}

Buffer updates(const std::vector<float>& values, std::vector<Approx> expected) {
  return {Element::kFloat, Role::kUpdated, bytes_of(values), std::move(expected)};
}

Buffer scratch(std::size_t floats) {
  return {Element::kFloat,
          Role::kScratch,
          std::vector<std::byte>(floats * sizeof(float), kPartOfNan),
          {}};
}

const Family* find_family(std::string_view name) {
  const auto* found = std::find_if(std::begin(kFamilies), std::end(kFamilies),
                                   [&](const Family& one) { return one.name == name; });
  return found == std::end(kFamilies) ? nullptr : found;
}

}  // namespace mien::conformance
