// Writes any cells into buffers of any size: nothing is written beyond the buffer, and a row is
// complete or empty.
#include "apps/animation/csv_row.h"

#include <string_view>
#include <vector>

#include "fuzz/bytes.h"
#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mien::fuzz::Bytes choices(data, size);
  std::vector<char> buffer(static_cast<std::size_t>(choices.between(0, 300)));
  mien::animation::CsvRow row(buffer);
  while (!choices.empty()) {
    switch (choices.between(0, 5)) {
      case 0:
        row.add(choices.take<std::int64_t>());
        break;
      case 1:
        row.add(choices.take<float>());
        break;
      case 2:
        row.add(choices.take<double>());
        break;
      case 3:
        row.add(choices.text(choices.between(0, 20)));
        break;
      case 4:
        row.add_empty();
        break;
      default: {
        const std::string_view line = row.finish();
        mien::fuzz::require(line.size() <= buffer.size() && (line.empty() || line.back() == '\n'));
      }
    }
  }
  return 0;
}
