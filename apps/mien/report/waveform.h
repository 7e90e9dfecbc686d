// A waveform for display: the minimum and maximum sample of each interval.
#pragma once

#include <cstdint>
#include <mien/mien.hpp>
#include <vector>

namespace mien::app {

class Waveform {
 public:
  static constexpr std::int64_t kBinNs = 10'000'000;

  // Takes blocks of an AudioSource and uses their first channel. Gaps are silent.
  void push_audio(const Audio& block, std::int64_t pts_ns);

  [[nodiscard]] bool empty() const { return low_.empty(); }
  [[nodiscard]] std::int64_t start_ns() const { return start_ns_; }        // of the first bin
  [[nodiscard]] const std::vector<double>& low() const { return low_; }    // -1..1
  [[nodiscard]] const std::vector<double>& high() const { return high_; }  // -1..1

 private:
  std::int64_t start_ns_ = 0;
  std::vector<double> low_, high_;
};

}  // namespace mien::app
