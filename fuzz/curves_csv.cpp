// The bytes are a CSV file of curves. Accepted curves have finite, ordered times and valid values.
#include <cmath>
#include <string_view>

#include "apps/mien/compare/curves_file.h"
#include "apps/mien/system/failure.h"
#include "fuzz/bytes.h"
#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using mien::fuzz::require;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const mien::app::Curves curves = mien::app::parse_curves(text, "input");
    require(!curves.empty());
    double before = curves.front().t_ms;
    for (const mien::app::CurvesFrame& frame : curves) {
      require(std::isfinite(frame.t_ms) && frame.t_ms >= before);
      before = frame.t_ms;
      for (const double control : frame.controls) {
        require(std::isnan(control) || (control >= 0.0 && control <= 1.0));
      }
      require(!frame.head || (std::isfinite(frame.head->pitch) && std::isfinite(frame.head->yaw) &&
                              std::isfinite(frame.head->roll)));
    }
  } catch (const mien::app::Failure& failure) {
    require(failure.code() == mien::app::kExitNoInput);
    require(std::string_view(failure.what()).starts_with("input: "));
  }
  return 0;
}
