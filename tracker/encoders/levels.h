// Levels of detail (Navarro et al. 2023, table 2): which encoders run on a frame, and which level
// fits a time budget.
#pragma once

#include <array>
#include <cstdint>

namespace mien::tracker {

inline constexpr std::int32_t kMinLevel = 1;  // BaseNet only
inline constexpr std::int32_t kMaxLevel = 4;  // HiFiNet and BaseNet on every frame

struct EncoderWork {
  bool basenet;
  bool hifinet;  // only together with BaseNet, which places the crop
};

// `alternate`: true on every second frame.
[[nodiscard]] constexpr EncoderWork encoder_work(std::int32_t level, bool alternate) {
  switch (level) {
    case 1:
      return {!alternate, false};
    case 2:
      return {!alternate, !alternate};
    case 3:
      return {true, !alternate};
    default:
      return {true, true};
  }
}

// Chooses the highest level whose average frame fits the budget. Changes the level at most once in
// two seconds, and raises it only if the next level is expected to fit with headroom.
class LevelGovernor {
 public:
  LevelGovernor(float budget_ms, std::int32_t max_level)
      : budget_ms_(budget_ms), level_(max_level), max_level_(max_level) {}

  [[nodiscard]] std::int32_t level() const { return level_; }

  // Continues at this level, whose cost is unknown.
  void begin_at(std::int32_t level) {
    level_ = level;
    since_change_ = 0.0f;
    frames_ = 0;
  }

  // Accounts for a frame with a tracked face: it took `spent_ns`, `seconds` after the previous
  // frame.
  void account(std::uint64_t spent_ns, float seconds) {
    const float spent_ms = static_cast<float>(spent_ns) * 1e-6f;
    mean_ms_ = frames_ == 0 ? spent_ms : mean_ms_ + kWeight * (spent_ms - mean_ms_);
    ++frames_;
    since_change_ += seconds;
    if (since_change_ < kSettleSeconds || frames_ < kMinFrames) {
      return;
    }
    if (mean_ms_ > budget_ms_ && level_ > kMinLevel) {
      begin_at(level_ - 1);
    } else if (level_ < max_level_ && mean_ms_ * growth(level_) < kHeadroom * budget_ms_) {
      begin_at(level_ + 1);
    }
  }

 private:
  static constexpr float kSettleSeconds = 2.0f;
  static constexpr float kWeight = 0.1f;  // of the newest frame in the mean
  static constexpr std::int32_t kMinFrames = 20;
  static constexpr float kHeadroom = 0.85f;  // of the budget

  // Cost of the next level relative to this one, from the multiply-accumulates of the encoders.
  [[nodiscard]] static constexpr float growth(std::int32_t level) {
    constexpr std::array<float, 3> kGrowth = {5.9f, 1.2f, 1.7f};
    return kGrowth[static_cast<std::size_t>(level - kMinLevel)];
  }

  float budget_ms_;
  std::int32_t level_;
  std::int32_t max_level_;
  float mean_ms_ = 0.0f;
  float since_change_ = 0.0f;
  std::int32_t frames_ = 0;  // since the last change
};

}  // namespace mien::tracker
