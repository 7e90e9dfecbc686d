// Encodes frames as differences to the previous one.
#include "apps/animation/frame_sequence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "apps/animation/facs_map.h"
#include "formats/vocabulary/visemes.h"

namespace mien::animation {
namespace {

// Per frame: three 64-bit varints and 18 groups.
constexpr std::size_t kMaxBytes = 3 * 10 + 18 * (2 + 8 * 8);
constexpr std::size_t kFirstBlock = 256, kMaxBlock = std::size_t{1} << 16;

// Indices of slots.
constexpr std::size_t kKindAt = 0, kFaceAt = 1, kLodAt = 2, kProbabilityAt = 3, kVoiceAt = 4,
                      kBoxAt = 5, kHeadAt = 9, kPositionAt = 12, kEyesAt = 15, kControlsAt = 21,
                      kFacsAt = kControlsAt + formats::kControlCount,
                      kVisemesAt = kFacsAt + formats::kFacsCount;

// Bits of the first slot; mouth shape and state use the bits above.
constexpr std::uint64_t kHasBox = 1, kHasHead = 2, kHasPosition = 4, kHasEyes = 8, kHasFacs = 16,
                        kHasVisemes = 32, kDerived = 64, kStep = 128;
constexpr unsigned kShapeShift = 8, kStateShift = 16;

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

// Controls derived from a vocabulary; all 0 without one.
std::array<double, formats::kControlCount> derived(const Frame& frame) {
  if (frame.mouth_shape != 0) {
    return formats::controls_of_visemes(formats::visemes_of_mouth_shape(frame.mouth_shape));
  }
  if (frame.visemes.size() == formats::kVisemeCount) {
    return formats::controls_of_visemes(
        std::span<const double, formats::kVisemeCount>(frame.visemes));
  }
  if (frame.facs.size() == formats::kFacsCount) {
    return controls_of_facs(std::span<const double, formats::kFacsCount>(frame.facs));
  }
  return {};
}

bool is_derived(const Frame& frame) {
  if (frame.mouth_shape == 0 && frame.visemes.empty() && frame.facs.empty()) {
    return false;
  }
  const auto same_bits = [](double a, double b) {  // unlike ==, also for NaN and -0
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  };
  return std::ranges::equal(derived(frame), frame.controls, same_bits);
}

// Numbers with at most nine decimals, which are typical for files, take 4 bytes.
constexpr double kBillion = 1e9;
bool has_nine_decimals(std::uint64_t slot, std::int32_t& billionths) {
  const auto value = std::bit_cast<double>(slot);
  if (!(std::abs(value) < 2.147)) {
    return false;
  }
  billionths = static_cast<std::int32_t>(std::lround(value * kBillion));
  return bits(billionths / kBillion) == slot;
}

std::uint64_t zigzag(std::int64_t value) {
  return static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63);
}

std::int64_t unzigzag(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1 ^ (~(value & 1) + 1));
}

// Frame numbers may be any 64-bit value, so arithmetic is modulo 2^64.
std::int64_t difference(std::int64_t a, std::int64_t b) {
  return std::bit_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

std::int64_t sum(std::int64_t a, std::int64_t b) {
  return std::bit_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

void put_varint(std::string& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) {
    bytes += static_cast<char>(value | 0x80);
  }
  bytes += static_cast<char>(value);
}

void put_bytes(std::string& bytes, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    bytes += static_cast<char>(value >> (8 * i) & 0xFF);
  }
}

template <class Values>
void put_all(const Values& values, std::uint64_t* slots) {
  for (const double value : values) {
    *slots++ = bits(value);
  }
}

template <class Values>
void take_all(const std::uint64_t* slots, Values& values) {
  for (double& value : values) {
    value = std::bit_cast<double>(*slots++);
  }
}

void put_group(const std::uint64_t* before, const std::uint64_t* slots, std::string& bytes) {
  const std::size_t head = bytes.size();
  bytes.append(2, '\0');
  unsigned changed = 0, decimal = 0;
  for (unsigned i = 0; i < 8; ++i) {
    std::int32_t billionths = 0;
    if (slots[i] == before[i]) {
      continue;
    }
    changed |= 1u << i;
    if (has_nine_decimals(slots[i], billionths)) {
      decimal |= 1u << i;
      put_bytes(bytes, static_cast<std::uint32_t>(billionths), 4);
    } else {
      put_bytes(bytes, slots[i], 8);
    }
  }
  bytes[head] = static_cast<char>(changed);
  bytes[head + 1] = static_cast<char>(decimal);
}

std::array<double, 3> parts(const Angles& angles) {
  return {angles.pitch, angles.yaw, angles.roll};
}

Angles angles_at(const std::uint64_t* slots) {
  std::array<double, 3> values;
  take_all(slots, values);
  return {values[0], values[1], values[2]};
}

}  // namespace

FrameSequence::FrameSequence(const std::vector<Frame>& frames) {
  for (const Frame& frame : frames) {
    push_back(frame);
  }
}

// Absent data keep the slots of the previous frame.
void FrameSequence::put(const Frame& frame, State& state) {
  auto& slots = state.slots;
  state.number = frame.number;
  state.time_ns = frame.time_ns;
  const bool is_made = is_derived(frame);
  slots[kKindAt] = (frame.box ? kHasBox : 0) | (frame.head ? kHasHead : 0) |
                   (frame.position_m ? kHasPosition : 0) | (frame.eyes ? kHasEyes : 0) |
                   (frame.facs.empty() ? 0 : kHasFacs) | (frame.visemes.empty() ? 0 : kHasVisemes) |
                   (is_made ? kDerived : 0) | (frame.step ? kStep : 0) |
                   static_cast<std::uint64_t>(static_cast<unsigned char>(frame.mouth_shape))
                       << kShapeShift |
                   static_cast<std::uint64_t>(frame.state) << kStateShift;
  slots[kFaceAt] = std::bit_cast<std::uint64_t>(frame.face_id);
  slots[kLodAt] = std::bit_cast<std::uint64_t>(frame.lod);
  slots[kProbabilityAt] = bits(frame.face_probability);
  slots[kVoiceAt] = bits(frame.voice_activity);
  if (frame.box) {
    put_all(*frame.box, &slots[kBoxAt]);
  }
  if (frame.head) {
    put_all(parts(*frame.head), &slots[kHeadAt]);
  }
  if (frame.position_m) {
    put_all(*frame.position_m, &slots[kPositionAt]);
  }
  if (frame.eyes) {
    put_all(parts((*frame.eyes)[0]), &slots[kEyesAt]);
    put_all(parts((*frame.eyes)[1]), &slots[kEyesAt + 3]);
  }
  if (!is_made) {
    put_all(frame.controls, &slots[kControlsAt]);
  }
  put_all(frame.facs, &slots[kFacsAt]);
  put_all(frame.visemes, &slots[kVisemesAt]);
}

void FrameSequence::take(const State& state, Frame& frame) {
  const auto& slots = state.slots;
  const std::uint64_t kind = slots[kKindAt];
  frame.number = state.number;
  frame.time_ns = state.time_ns;
  frame.state = static_cast<FaceState>(kind >> kStateShift);
  frame.mouth_shape = static_cast<char>(kind >> kShapeShift & 0xFF);
  frame.face_id = std::bit_cast<std::int64_t>(slots[kFaceAt]);
  frame.lod = std::bit_cast<std::int64_t>(slots[kLodAt]);
  frame.face_probability = std::bit_cast<double>(slots[kProbabilityAt]);
  frame.voice_activity = std::bit_cast<double>(slots[kVoiceAt]);
  frame.step = (kind & kStep) != 0;
  frame.box.reset();
  frame.position_m.reset();
  if ((kind & kHasBox) != 0) {
    take_all(&slots[kBoxAt], frame.box.emplace());
  }
  if ((kind & kHasPosition) != 0) {
    take_all(&slots[kPositionAt], frame.position_m.emplace());
  }
  frame.head = (kind & kHasHead) != 0 ? std::optional(angles_at(&slots[kHeadAt])) : std::nullopt;
  frame.eyes =
      (kind & kHasEyes) != 0
          ? std::optional(std::array{angles_at(&slots[kEyesAt]), angles_at(&slots[kEyesAt + 3])})
          : std::nullopt;
  frame.facs.resize((kind & kHasFacs) != 0 ? formats::kFacsCount : 0);
  take_all(&slots[kFacsAt], frame.facs);
  frame.visemes.resize((kind & kHasVisemes) != 0 ? formats::kVisemeCount : 0);
  take_all(&slots[kVisemesAt], frame.visemes);
  if ((kind & kDerived) != 0) {
    frame.controls = derived(frame);
  } else {
    take_all(&slots[kControlsAt], frame.controls);
  }
}

// Encodes number and time, the groups that differ, in each group the slots that differ, those of
// them with 4 bytes, and their values.
std::string FrameSequence::packed(const State& before, const State& state) {
  std::string bytes;
  bytes.reserve(kMaxBytes);
  put_varint(bytes, zigzag(difference(difference(state.number, before.number), 1)));
  put_varint(bytes, zigzag(difference(state.time_ns, before.time_ns)));
  std::uint64_t groups = 0;
  for (std::size_t group = 0; group < kGroups; ++group) {
    const auto begin = static_cast<std::ptrdiff_t>(8 * group);
    if (!std::equal(state.slots.begin() + begin, state.slots.begin() + begin + 8,
                    before.slots.begin() + begin)) {
      groups |= std::uint64_t{1} << group;
    }
  }
  put_varint(bytes, groups);
  for (std::size_t group = 0; group < kGroups; ++group) {
    if ((groups >> group & 1) != 0) {
      put_group(&before.slots[8 * group], &state.slots[8 * group], bytes);
    }
  }
  return bytes;
}

bool FrameSequence::add(const Frame& frame) {
  State state = last_;
  put(frame, state);
  const std::string bytes = packed(last_, state);
  if (bytes.size() > max_bytes_ - std::min(bytes_, max_bytes_)) {
    return false;
  }
  if (blocks_.empty() || blocks_.back().capacity() - blocks_.back().size() < bytes.size()) {
    const std::size_t next = blocks_.empty() ? kFirstBlock : 2 * blocks_.back().capacity();
    blocks_.emplace_back().reserve(std::max(std::min(next, kMaxBlock), bytes.size()));
  }
  blocks_.back() += bytes;
  bytes_ += bytes.size();
  first_time_ns_ = size_ == 0 ? frame.time_ns : first_time_ns_;
  last_ = state;
  ++size_;
  return true;
}

std::vector<Frame> FrameSequence::unpacked() const {
  std::vector<Frame> frames;
  frames.reserve(size_);
  for (const Frame& frame : *this) {
    frames.push_back(frame);
  }
  return frames;
}

std::uint64_t FrameSequence::Iterator::bytes(std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = static_cast<unsigned char>(frames_->blocks_[block_][at_++]);
    value |= static_cast<std::uint64_t>(byte) << (8 * i);
  }
  return value;
}

std::uint64_t FrameSequence::Iterator::varint() {
  std::uint64_t value = 0;
  for (unsigned shift = 0;; shift += 7) {
    const std::uint64_t byte = bytes(1);
    value |= (byte & 0x7F) << shift;
    if (byte < 0x80) {
      return value;
    }
  }
}

void FrameSequence::Iterator::read() {
  if (left_ == 0) {
    return;
  }
  if (at_ == frames_->blocks_[block_].size()) {
    ++block_;
    at_ = 0;
  }
  state_.number = sum(sum(state_.number, unzigzag(varint())), 1);
  state_.time_ns = sum(state_.time_ns, unzigzag(varint()));
  const std::uint64_t groups = varint();
  for (std::size_t group = 0; group < kGroups; ++group) {
    if ((groups >> group & 1) == 0) {
      continue;
    }
    const std::uint64_t changed = bytes(1), decimal = bytes(1);
    for (unsigned i = 0; i < 8; ++i) {
      if ((changed >> i & 1) != 0) {
        std::uint64_t& slot = state_.slots[8 * group + i];
        slot = (decimal >> i & 1) != 0 ? bits(static_cast<std::int32_t>(bytes(4)) / kBillion)
                                       : bytes(8);
      }
    }
  }
  take(state_, frame_);
}

}  // namespace mien::animation
