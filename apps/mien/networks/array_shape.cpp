// Matches the axes of an array with the shape of a network's input.
#include "apps/mien/networks/array_shape.h"

#include <algorithm>
#include <limits>

namespace mien::app {
namespace {

std::uint64_t u64(std::int32_t n) { return static_cast<std::uint64_t>(n); }

std::string text(const std::vector<std::uint64_t>& dims) {
  std::string all = "(";
  for (const std::uint64_t dim : dims) {
    all.append(all.size() > 1 ? ", " : "").append(std::to_string(dim));
  }
  return all + ")";
}

}  // namespace

ArrayShape::ArrayShape(std::span<const std::uint64_t> dims, const NetworkInfo& network,
                       MapLayout layout)
    : dims_(dims.begin(), dims.end()), map_(network.input), layout_(layout) {
  const TensorShape in = network.input;
  const bool vector = in.height == 1 && in.width == 1;
  expected_ = text(vector ? std::vector{u64(in.channels)} : axes(in)) +
              (network.any_size != 0 ? " or larger" : "");
  fits_ = take(axes(in)) || (network.any_size != 0 && take_larger(in)) ||
          (vector && take({u64(in.channels)}));
  if (!fits_ && in.height == 1 && !vector) {
    const std::uint64_t c = u64(in.channels), w = u64(in.width);
    single_row_ = layout == MapLayout::kChannelsFirst ? take({c, w}) : take({w, c});
    fits_ = single_row_;
  }
}

std::vector<std::uint64_t> ArrayShape::axes(const TensorShape& map) const {
  const std::uint64_t h = u64(map.height), w = u64(map.width), c = u64(map.channels);
  return layout_ == MapLayout::kChannelsFirst ? std::vector{c, h, w} : std::vector{h, w, c};
}

// Whether the last axes equal `item`; the axes before them become front_.
bool ArrayShape::take(const std::vector<std::uint64_t>& item) {
  if (dims_.size() < item.size() || !std::equal(item.rbegin(), item.rend(), dims_.rbegin())) {
    return false;
  }
  front_.assign(dims_.begin(), dims_.end() - static_cast<std::ptrdiff_t>(item.size()));
  return true;
}

bool ArrayShape::take_larger(const TensorShape& declared) {
  if (dims_.size() < 3) {
    return false;
  }
  const std::uint64_t* last = &dims_[dims_.size() - 3];
  const bool first = layout_ == MapLayout::kChannelsFirst;
  const std::uint64_t h = last[first ? 1 : 0], w = last[first ? 2 : 1];
  constexpr std::uint64_t kMax = std::numeric_limits<std::int32_t>::max();
  if (h < u64(declared.height) || w < u64(declared.width) || h > kMax || w > kMax) {
    return false;
  }
  map_ = {static_cast<std::int32_t>(h), static_cast<std::int32_t>(w), declared.channels};
  return take(axes(map_));
}

std::string ArrayShape::mismatch() const {
  return "wrong shape (got " + text(dims_) + ", expected as last axes " + expected_ + ")";
}

std::uint64_t ArrayShape::steps() const {
  std::uint64_t all = 1;
  for (const std::uint64_t dim : front_) {
    all *= dim;
  }
  return all;
}

std::uint64_t ArrayShape::steps_per_stream() const { return front_.empty() ? 1 : front_.back(); }

std::vector<std::uint64_t> ArrayShape::output(const TensorShape& map) const {
  std::vector<std::uint64_t> item = axes(map);
  if (map.height == 1 && map.width == 1) {
    item = {u64(map.channels)};
  } else if (single_row_ && map.height == 1) {
    item.erase(item.begin() + (layout_ == MapLayout::kChannelsFirst ? 1 : 0));
  }
  item.insert(item.begin(), front_.begin(), front_.end());
  return item;
}

}  // namespace mien::app
