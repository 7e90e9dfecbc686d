// The bytes are a .npy file. An accepted array is unchanged after it is written and read again.
#include "formats/npy.h"

#include <bit>
#include <cstdlib>
#include <vector>

#include "fuzz/target.h"

namespace {

using mien::formats::NpyArray;
using mien::formats::NpyStatus;

void expect(bool truth) {
  if (!truth) {
    std::abort();
  }
}

std::vector<std::byte> written(const NpyArray& array) {
  const mien::formats::NpyHeader header = mien::formats::npy_header(array.shape());
  const auto head = std::as_bytes(std::span(header.bytes));
  std::vector<std::byte> file(head.begin(), head.end());
  for (std::uint64_t i = 0; i < array.elems(); ++i) {
    const float value = array.value(i);
    const auto bytes = std::as_bytes(std::span(&value, 1));
    file.insert(file.end(), bytes.begin(), bytes.end());
  }
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  NpyArray array;
  const NpyStatus status = mien::formats::read_npy(std::as_bytes(std::span(data, size)), &array);
  expect(array.data.size() <= size && array.rank <= mien::formats::kMaxNpyRank);
  if (status != NpyStatus::kOk) {
    expect(array.rank == 0 && array.data.empty());
    return 0;
  }
  const std::vector<std::byte> file = written(array);
  NpyArray again;
  expect(mien::formats::read_npy(file, &again) == NpyStatus::kOk && again.elems() == array.elems());
  for (std::uint64_t i = 0; i < array.elems(); ++i) {
    expect(std::bit_cast<std::uint32_t>(again.value(i)) ==
           std::bit_cast<std::uint32_t>(array.value(i)));
  }
  return 0;
}
